#!/usr/bin/env python3
"""Numbers of LDPM specimens for docs/results/ldpm.csv, and the tables that are made from it.

    scripts/ldpm_tables.py record DIR --name NAME     # appends DIR/specimens.csv of `breccia test` under a name
"""
import argparse
import csv
import pathlib
import statistics

FIELDS = ["set", "test", "specimen", "quantity", "unit", "value"]
PRESSURES = (5, 20, 50, 100, 200)


def record(folder, name, out):
    new = not out.exists()
    with open(out, "a", newline="") as file, open(folder / "specimens.csv", newline="") as source:
        writer = csv.DictWriter(file, FIELDS, lineterminator="\n")
        if new:
            writer.writeheader()
        for row in csv.DictReader(source):
            writer.writerow({"set": name, **{key: row[key] for key in FIELDS[1:]}})


def numbers(lines, name):
    found = {}
    for row in lines:
        if row["set"] == name:
            found.setdefault((row["test"], row["quantity"]), []).append(float(row["value"]))
    return found


def spread(values, digits):
    if not values:
        return ""
    text = f"{statistics.mean(values):.{digits}f}"
    return text + (f" +- {statistics.stdev(values):.{digits}f}" if len(values) > 1 else "")


def ratio(found, over, under):
    if not found.get(over) or not found.get(under):
        return []
    base = statistics.mean(found[under])
    return [value / base for value in found[over]]


def misfit(values, low, high):
    """Of the mean to a range, in per cent."""
    if not values:
        return ""
    mean = statistics.mean(values)
    percent = 100 * (mean / min(max(mean, low), high) - 1)
    return f"**{percent:+.0f} %**" if abs(percent) >= 0.5 else "0"


def experiments(lines, name):
    """Tests of one set of parameters beside published rules."""
    found = numbers(lines, name)
    f_c = ("compression_prism", "strength")
    mean = statistics.mean(found[f_c])
    rows = [("E [GPa]", found.get(("compression_prism", "young"), []), 1, "", None),
            ("nu", found.get(("compression_prism", "poisson"), []), 3, "", None),
            ("compression, prism, smooth ends, f_c [MPa]", found[f_c], 1, "", None),
            ("strain at the peak [1e-3]", found.get(("compression_prism", "peak_strain"), []), 2, "1.9 to 2.6 (Model Code 2010, C20 to C60)", (1.9, 2.6)),
            ("cube over prism, smooth ends", ratio(found, ("compression_cube", "strength"), f_c), 2, "1.0", (0.95, 1.05)),
            ("prism, held ends, over smooth ends", ratio(found, ("held_prism", "strength"), f_c), 2, "1.0 to 1.05", (1.0, 1.05)),
            ("cube, held ends, over the prism's", ratio(found, ("held_cube", "strength"), ("held_prism", "strength")), 2, "1.15 to 1.30", (1.15, 1.30)),
            ("direct tension, f_t [MPa]", found.get(("tension", "strength"), []), 2, "", None),
            ("f_c over f_t", [mean / value for value in found.get(("tension", "strength"), [])], 1, "10 to 12", (10.0, 12.0)),
            ("notched prism: fracture energy [J/m2]", found.get(("tension_notched", "fracture_energy"), []), 0, "", None),
            ("equal biaxial compression over f_c", ratio(found, ("biaxial", "strength"), f_c), 2, "1.16 (Kupfer 1969)", (1.16, 1.16))]
    for pressure in PRESSURES:
        values = found.get((f"triaxial_{pressure}", "strength"), [])
        richart = mean + 4.1 * pressure
        rows.append((f"triaxial at {pressure} MPa [MPa]", values, 0,
                     f"{richart:.0f} (f_c + 4.1 p, Richart 1928)" if pressure <= mean else "", (richart, richart) if pressure <= mean else None))
    rows += [("oedometer: strain at 100 MPa [%]", found.get(("oedometer", "strain_100"), []), 2, "", None),
             ("hydrostatic pressure at 1 % of linear strain [MPa]", found.get(("hydrostatic", "pressure_1"), []), 0, "", None),
             ("at 2 %", found.get(("hydrostatic", "pressure_2"), []), 0, "", None)]
    out = ["| test | here | published | misfit |", "|---" * 4 + "|"]
    for words, values, digits, published, bounds in rows:
        if values:
            out.append(f"| {words} | {spread(values, digits)} | {published} | {misfit(values, *bounds) if bounds else ''} |")
    return "\n".join(out)


def calibration(lines):
    """Targets and what calibrated materials show on seeds that they were not calibrated on."""
    targets = {"young": ("compression_prism", "young", 1, "E [GPa]"), "poisson": ("compression_prism", "poisson", 3, "nu"),
               "compression": ("compression_prism", "strength", 1, "f_c [MPa]"), "tension": ("tension", "strength", 2, "f_t [MPa]"),
               "fracture_energy": ("tension_notched", "fracture_energy", 0, "G_F [J/m2]")}
    names = sorted({row["set"] for row in lines if row["test"] == "target"})
    out = ["| | " + " | ".join(words for *_, words in targets.values()) + " | n |", "|---" * (len(targets) + 2) + "|"]
    for name in names:
        asked = {row["quantity"]: float(row["value"]) for row in lines if row["set"] == name and row["test"] == "target"}
        found, cells, count = numbers(lines, name), [], 0
        for target, (test, quantity, digits, _) in targets.items():
            values = found.get((test, quantity), [])
            count = max(count, len(values))
            cells.append(f"{spread(values, digits)}, {100 * (statistics.mean(values) / asked[target] - 1):+.1f} %" if values and target in asked else "")
        out.append(f"| {name} | " + " | ".join(cells) + f" | {count} |")
    return "\n".join(out)


def size_effect(lines):
    """Nominal strength of notched prisms of several widths, and the law of Bazant through the means: 1 / s^2 is linear in the width."""
    found = {}
    for row in lines:
        if row["test"] == "size":
            found.setdefault(row["set"], {}).setdefault(int(row["quantity"]), []).append(float(row["value"]))
    widths = sorted({width for of in found.values() for width in of})
    out = ["| set | " + " | ".join(f"{width} mm" for width in widths) + " | B f_t [MPa] | D_0 [mm] | largest misfit of the law |", "|---" * (len(widths) + 4) + "|"]
    for name, of in sorted(found.items()):
        points = [(width, statistics.mean(of[width]) ** -2) for width in sorted(of)]
        mean_x, mean_y = (statistics.mean(axis) for axis in zip(*points))
        slope = sum((x - mean_x) * (y - mean_y) for x, y in points) / sum((x - mean_x) ** 2 for x, _ in points)
        start = mean_y - slope * mean_x
        worst = max(abs((start + slope * x) ** -0.5 * y ** 0.5 - 1) for x, y in points)
        out.append(f"| {name} | " + " | ".join(spread(of.get(width, []), 2) for width in widths)
                   + f" | {start ** -0.5:.2f} | {start / slope:.0f} | {100 * worst:.0f} % |")
    return "\n".join(out)


def bending(lines):
    """The notched beam beside the curves of two codes."""
    values = {(row["set"], row["quantity"]): float(row["value"]) for row in lines if row["test"] == "bending"}
    out = ["| | here | Project Chrono | Abaqus |", "|---" * 4 + "|"]
    for words, quantity, digits in [("peak [N]", "peak", 0), ("displacement there [mm]", "displacement", 3), ("opening of the notch there [mm]", "opening", 3),
                                    *((f"load at an opening of {w} mm [N]", f"load_{w}", 0) for w in ("0.01", "0.02", "0.05", "0.1"))]:
        out.append(f"| {words} | " + " | ".join(f"{values[name, quantity]:,.{digits}f}" for name in ("here", "Chrono", "Abaqus")) + " |")
    return "\n".join(out)


def public(lines, name):
    """Runs of public bodies (ldpm_benchmarks.py) whose names begin alike: largest stress, and stress at strains."""
    found = {}
    for row in lines:
        if row["test"] == "public" and row["set"].startswith(name):
            found.setdefault(row["set"], {})[row["quantity"]] = float(row["value"])
    strains = sorted({float(key[7:]) for of in found.values() for key in of if key.startswith("stress_")})
    out = ["| run | peak [MPa] | at [1e-3] | side then [MPa] | " + " | ".join(f"at {strain:g}e-3" for strain in strains) + " |", "|---" * (len(strains) + 4) + "|"]
    for run, of in found.items():
        cells = [f"{of[f'stress_{strain:g}']:.1f}" if f"stress_{strain:g}" in of else "" for strain in strains]
        side = f"{of['side_stress']:.1f}" if "side_stress" in of else ""
        out.append(f"| `{run}` | {of['peak']:.1f} | {of['peak_strain']:.2f} | {side} | " + " | ".join(cells) + " |")
    return "\n".join(out)


def markdown(lines, what):
    kind, _, name = what.partition(" ")
    return {"calibration": lambda: calibration(lines), "bending": lambda: bending(lines), "size": lambda: size_effect(lines), "public": lambda: public(lines, name), "experiments": lambda: experiments(lines, name)}[kind]()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    add = commands.add_parser("record", help="append specimens.csv of a folder of `breccia test`")
    add.add_argument("folder", type=pathlib.Path)
    add.add_argument("--name", required=True)
    add.add_argument("--out", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent / "docs/results/ldpm.csv")
    options = parser.parse_args()
    record(options.folder, options.name, options.out)


if __name__ == "__main__":
    main()
