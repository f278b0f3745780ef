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
    """Nominal strength of notched prisms of several widths."""
    found = {}
    for row in lines:
        if row["test"] == "size":
            found.setdefault(row["set"], {}).setdefault(int(row["quantity"]), []).append(float(row["value"]))
    return bazant(found)


def beams(lines):
    """Nominal strength of notched beams of several depths."""
    found = {}
    for row in lines:
        if row["test"].startswith("beams ") and row["quantity"] == "strength":
            found.setdefault(row["set"], {}).setdefault(int(row["test"][6:]), []).append(float(row["value"]))
    return bazant(found)


def bazant(found):
    """The law of Bazant through the means: 1 / s^2 is linear in the width."""
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


def public_beams(lines):
    """The public notched beams at the published speed."""
    found = {}
    for row in lines:
        if row["test"] == "public" and row["set"].startswith("beam_"):
            found.setdefault(row["set"], {})[row["quantity"]] = float(row["value"])
    openings = ("0.01", "0.02", "0.05", "0.1", "0.2", "0.3", "0.5")
    out = ["| run | peak [N] | displacement there [mm] | opening there [mm] | " + " | ".join(f"load at {w} mm [N]" for w in openings) + " |", "|---" * (len(openings) + 4) + "|"]
    for run, of in found.items():
        loads = [f"{of[f'load_{w}']:,.0f}" if f"load_{w}" in of else "" for w in openings]
        out.append(f"| `{run}` | {of['peak']:,.0f} | {of['displacement']:.3f} | {of['opening']:.3f} | " + " | ".join(loads) + " |")
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


def platens(lines):
    """Prisms and cubes of 100 mm between ends of several frictions."""
    strengths = {}
    for row in lines:
        if row["test"].startswith("platens ") and row["quantity"] == "strength":
            _, shape, friction = row["test"].split(" ")
            strengths.setdefault((row["set"], friction), {}).setdefault(shape, []).append(float(row["value"]))
    out = ["| set | friction | prism [MPa] | cube [MPa] | n | cube over prism (1.15 to 1.30 where platens are rough) | prism over smooth (1.0 to 1.05) | cube over smooth |", "|---" * 8 + "|"]
    for (of, friction), found in sorted(strengths.items()):
        smooth = strengths.get((of, "0"), {})
        prism, cube = found.get("prism", []), found.get("cube", [])
        over = [c / statistics.mean(prism) for c in cube] if prism else []
        prisms = [v / statistics.mean(smooth["prism"]) for v in prism] if smooth.get("prism") else []
        cubes = [v / statistics.mean(smooth["cube"]) for v in cube] if smooth.get("cube") else []
        out.append(f"| {of} | {friction} | {spread(prism, 1)} | {spread(cube, 1)} | {max(len(prism), len(cube))} | {spread(over, 2)} | {spread(prisms, 2)} | {spread(cubes, 2)} |")
    return "\n".join(out)


def ends(lines):
    """Prisms and cubes of `breccia test` between ends that are smooth, rub or hold; other frictions than 0.577 stand in sets of their own."""
    out = ["| set | ends | prism [MPa] | cube [MPa] | n | cube over prism (rough: 1.15 to 1.30) | misfit | prism over smooth (1.0 to 1.05) | misfit | cube over smooth cube |", "|---" * 10 + "|"]
    for of in ("B", "II-3", "II-4"):
        found = numbers(lines, of)
        smooth, smooth_cube = found["compression_prism", "strength"], found["compression_cube", "strength"]
        for words, where, test in (("smooth", found, "compression"), ("friction 0.13", numbers(lines, f"{of}, friction 0.13"), "platens"), ("friction 0.577", found, "platens"), ("held", found, "held")):
            prism, cube = where.get((f"{test}_prism", "strength")), where.get((f"{test}_cube", "strength"))
            if not prism or not cube:
                continue
            over = [value / statistics.mean(prism) for value in cube]
            gain = [value / statistics.mean(smooth) for value in prism]
            cells = [spread(over, 2), "" if words == "smooth" else misfit(over, 1.15, 1.30), spread(gain, 2), "" if words == "smooth" else misfit(gain, 1.0, 1.05), spread([value / statistics.mean(smooth_cube) for value in cube], 2)]
            out.append(f"| {of} | {words} | {spread(prism, 1)} | {spread(cube, 1)} | {len(prism)} | " + " | ".join(cells) + " |")
    return "\n".join(out)


def bands(lines):
    """Where prisms of 100 mm break after the peak."""
    found = {}
    for row in lines:
        if row["test"].startswith("platens ") and row["quantity"] in ("late", "cracked", "band", "ratio", "chance", "slope", "left"):
            found.setdefault((row["set"], row["test"][8:]), {}).setdefault(row["quantity"], []).append(float(row["value"]))
    out = ["| set | specimen, friction | left at the end, of the peak | facets cracked | after the peak | of these in the best layer, % | as many of all cracked ones at random, % | best layer's slope, degrees |", "|---" * 8 + "|"]
    for (of, name), of_one in sorted(found.items()):
        if "band" in of_one:
            percent = {key: [100 * v for v in of_one[key]] for key in ("band", "chance")}
            out.append(f"| {of} | {name} | {spread(of_one['left'], 2)} | {spread(of_one['cracked'], 0)} | {spread(of_one['late'], 0)} | {spread(percent['band'], 0)} | {spread(percent['chance'], 0)} | {spread(of_one['slope'], 0)} |")
    return "\n".join(out)


def layers(lines):
    """Share of the energy spent that lies in one layer, a tenth of a prism's length thick."""
    found = {}
    for row in lines:
        if row["test"].startswith("bands "):
            found.setdefault((row["test"][6:], row["set"]), {}).setdefault(row["quantity"], []).append(float(row["value"]))
    out = ["| prism | set | strength [MPa] | left of it at the end | energy spent [J] | in the best layer across the load, % | by chance, % | in the best of any slope, % | by chance, % | its slope, degrees | "
           "facets opened by 0.05 mm | of these in the best layer across the load, % | n |", "|---" * 13 + "|"]
    for (load, of), q in sorted(found.items(), reverse=True):
        shares = [spread([100 * v for v in q[key]], 0) for key in ("share_across", "chance_across", "share_any", "chance_any")]
        wide = spread([100 * v for v in q["wide_across"]], 0) if all(q["wide"]) else ""
        out.append(f"| {'pulled' if load == 'tension' else 'pressed'} | {of} | {spread(q['strength'], 1)} | {spread(q['left'], 2)} | {spread([1e-3 * v for v in q['energy']], 2)} | "
                   + " | ".join(shares) + f" | {spread(q['slope_any'], 0)} | {spread(q['wide'], 0)} of {spread(q['facets'][:1], 0)} | {wide} | {len(q['energy'])} |")
    return "\n".join(out)


def cycles(lines):
    """Strain that is left by unloading beside the formula of Karsan and Jirsa."""
    found = {}
    for row in lines:
        if row["test"] == "cycles":
            found.setdefault(row["set"], {}).setdefault(row["quantity"], []).append(float(row["value"]))
    out = ["| set | unloaded at [1e-3] | stress there [MPa] | left, here [1e-3] | left, formula [1e-3] | misfit | secant of unloading [GPa] |", "|---" * 7 + "|"]
    for of, q in sorted(found.items()):
        peak = statistics.mean(q["peak_strain"])
        for k in range(5):
            if f"turn_{k}" in q:
                u = statistics.mean(q[f"turn_{k}"]) / peak
                formula = peak * (0.145 * u * u + 0.13 * u)
                left = q[f"left_{k}"]
                out.append(f"| {of} | {spread(q[f'turn_{k}'], 2)} | {spread(q[f'stress_{k}'], 1)} | {spread(left, 2)} | {formula:.2f} | "
                           f"{100 * (statistics.mean(left) / formula - 1):+.0f} % | {spread(q[f'secant_{k}'], 1)} |")
    return "\n".join(out)


def curves(lines):
    """Plates and a prism beside published curves (ldpm_experiments.py): peaks, and how far curves lie from each other."""
    import ldpm_experiments
    published = {f"biaxial {ratio:g}": (f"plate, side {ratio:g} of the stress along z", curve) for ratio, curve in ldpm_experiments.KUPFER.items()}
    published["cycles"] = ("prism, loaded again and again: envelope", ldpm_experiments.KARSAN)
    out = ["| test | peak [MPa] | experiment | misfit | at [1e-3] | experiment | misfit | curves apart up to the peak, % of it | beyond |", "|---" * 9 + "|"]
    for test, (words, (strains, stresses)) in published.items():
        found = {}
        for row in lines:
            if row["test"] == test and row["set"] == "II-4":
                found.setdefault(row["quantity"], []).append(float(row["value"]))
        if not found:
            continue
        peak = max(stresses)
        where = statistics.mean(e for e, s in zip(strains, stresses) if s == peak)
        apart = [spread([100 * v for v in found[f"misfit_{part}"]], 1) for part in ("rising", "falling")]
        out.append(f"| {words} | {spread(found['strength'], 1)} | {peak:.1f} | {misfit(found['strength'], peak, peak)} | {spread(found['peak_strain'], 2)} | {where:.2f} | {misfit(found['peak_strain'], where, where)} | "
                   f"{apart[0]} | {apart[1]} |")
    return "\n".join(out)


def confined(lines):
    """Prisms under side pressure beside Attard and Setunge 1996 and Richart 1928, by what the prisms of 60 mm show without it."""
    found = {}
    for row in lines:
        if row["test"].startswith("confined ") and row["quantity"] in ("strength", "peak_strain", "side"):
            found.setdefault((row["set"], int(row["test"][9:])), {}).setdefault(row["quantity"], []).append(float(row["value"]))
    out = ["| set | pressure [MPa] | strength [MPa] | Attard and Setunge | misfit | f_c + 4.1 p | misfit | strain at the peak [1e-3] | Attard and Setunge | misfit |", "|---" * 10 + "|"]
    for (of, pressure), q in sorted(found.items()):
        base = numbers(lines, of)
        f_c, f_t = (statistics.mean(base[test, "strength"]) for test in ("compression_prism", "tension"))
        e_c = statistics.mean(base["compression_prism", "peak_strain"])
        attard = f_c * (1 + pressure / f_t) ** (1.25 * (1 + 0.062 * pressure / f_c) * f_c ** -0.21)
        richart = f_c + 4.1 * pressure
        strain = e_c * (1 + (17 - 0.06 * f_c) * pressure / f_c)
        s, e = statistics.mean(q["strength"]), statistics.mean(q["peak_strain"])
        out.append(f"| {of} | {pressure} | {spread(q['strength'], 1)} | {attard:.0f} | {100 * (s / attard - 1):+.0f} % | {richart:.0f} | {100 * (s / richart - 1):+.0f} % | "
                   f"{spread(q['peak_strain'], 1)} | {strain:.1f} | {100 * (e / strain - 1):+.0f} % |")
    return "\n".join(out)


def markdown(lines, what):
    kind, _, name = what.partition(" ")
    return {"calibration": lambda: calibration(lines), "bending": lambda: bending(lines), "notched": lambda: public_beams(lines), "size": lambda: size_effect(lines), "beams": lambda: beams(lines), "platens": lambda: platens(lines),
            "ends": lambda: ends(lines), "bands": lambda: bands(lines), "layers": lambda: layers(lines), "cycles": lambda: cycles(lines), "curves": lambda: curves(lines), "confined": lambda: confined(lines), "public": lambda: public(lines, name), "experiments": lambda: experiments(lines, name)}[kind]()


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
