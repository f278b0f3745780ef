#!/usr/bin/env python3
"""Concretes of `breccia materials` in specimens of `breccia test` and in two tests that it does not have, for docs/validation-concrete.md and docs/laboratory.md.

    scripts/library_runs.py [--concretes C40,C60] [--packings 5,6,7] [--elements 1200,2400] [--binary build/release/breccia] [--device cpu] [--jobs 1] [--record FILE] [--plot FILE] [NAME...]
    NAME: a test of `breccia test`, prism_long, oedometer_unload; elements: of a prism of 0.1 x 0.1 x 0.2 m, half as many in the oedometer's cube of 0.1 m

prism_long        the prism of `breccia test` with smooth ends, 0.6/s, to at least 3.1 times the strain of its peak
oedometer_unload  the oedometer of `breccia test`, 4/s, which lengthens again by 5 % from 8.7 % of strain (of C30: 1 GPa) and is then pressed to 15 %

The library's concretes run without local damping. The concrete "slab" is that of scripts/reinforced_tests.py, with 0.3, in the two tests alone. Cases and results are in out/library_runs/; called again,
only what is missing is run. --record FILE replaces lines of concretes of the library in that file (docs/results/library.csv). --plot FILE draws stress over strain of finished long prisms
(needs python3-matplotlib; docs/library_prisms.png).
"""
import argparse
import csv
import math
import pathlib
import subprocess

import keyed_specimens
import published_runs
import reinforced_tests

ROOT = pathlib.Path(__file__).resolve().parent.parent
OUT = ROOT / "out" / "library_runs"
AREA = 0.01  # of both specimens  [m2]
SLAB = "slab"
END = {SLAB: 9e-3, "C20": 10.5e-3, "C30": 12e-3, "C40": 14e-3, "C60": 16e-3, "C100": 20e-3}  # of the long prism  [s]
RECORD = ["material", "elements", "test", "specimen", "commit", "hash", "quantity", "unit", "value"]


def material(concrete):
    """One of `breccia materials`, or the slab's concrete, its friction bounded."""
    if concrete == SLAB:
        return reinforced_tests.MATERIALS[1:reinforced_tests.MATERIALS.index("[material.b500]")]
    return f'[material.c30]\nuse = "{concrete}"\nrate = "none"\n\n'


def head(title, seed, end, step, concrete, size, count):
    return (f'breccia = 1\nmethod = "dem3d"\ntitle = "{title}"\nseed = {seed}\nlocal_damping = {0.3 if concrete == SLAB else 0.0}\n\n[time]\nend = {end}\n\n[output]\nframes = 0\nhistory = {step}\n'
            f'fields = false\npictures = false\n\n[energy]\nstop = 0.1\n\n[search]\nmargin = 0.5\n\n[links]\nrange = 1.443\n\n[contact]\nlaw = "linear"\n\n'
            + material(concrete) + f'[[body]]\nname = "specimen"\nshape = "box"\nmaterial = "c30"\nsize = {size}\n'
            f'pack = {{ count = {count}, size_ratio = 2.0, compactness = 0.56 }}\n')


def probes(*more):
    ends = [one for end in ("top", "bottom") for one in ((f"force_{end}", end, "force_z", "sum"), (end, end, "position_z", "mean"))]
    return "".join(f'\n[[probe]]\nname = "{name}"\non = "{on}"\nquantity = "{quantity}"\nreduce = "{reduce}"\n' for name, on, quantity, reduce in (*ends, *more))


def prism(concrete, elements, seed):
    layer = 0.1 - 2 * (0.75 * AREA * 0.2 * 0.56 / (math.pi * elements)) ** (1 / 3)  # a mean diameter below the ends
    text = head("prism to three times the strain of its peak", seed, END[concrete], 5e-3 / 0.6 / 1000, concrete, [0.1, 0.1, 0.2], elements)
    for name, low, high, velocity in (("top", layer, 1.0, -0.06), ("bottom", -1.0, -layer, 0.06)):
        text += (f'\n[[support]]\nname = "{name}"\nmin = [-1.0, -1.0, {low}]\nmax = [1.0, 1.0, {high}]\nfix = ["z"]\nvelocity = [0.0, 0.0, {velocity}]\n'
                 f'ramp = {0.1 * 5e-3 / 0.6}\n')
    return text + probes()


def oedometer(concrete, elements, seed):
    turn, back, half = 8.7e-2 / 4, 5e-2 / 4, 1e-4  # speeds turn within 0.2 ms  [s]
    end = turn + 2 * back + (0.15 - 8.7e-2) / 4
    text = head("oedometer that unloads", seed, end, 3.5e-5, concrete, [0.1, 0.1, 0.1], elements // 2)
    for name, point, normal, v in (("top", (0, 0, 0.05), (0, 0, -1), -0.2), ("bottom", (0, 0, -0.05), (0, 0, 1), 0.2), ("right", (0.05, 0, 0), (-1, 0, 0), 0),
                                   ("left", (-0.05, 0, 0), (1, 0, 0), 0), ("back", (0, 0.05, 0), (0, -1, 0), 0), ("front", (0, -0.05, 0), (0, 1, 0), 0)):
        over_time = ((0.0, v), (turn - half, v), (turn + half, -v), (turn + back - half, -v), (turn + back + half, v), (1.0, v))
        velocity = [[time, 0.0, 0.0, speed] for time, speed in over_time] if v else [0.0, 0.0, 0.0]
        text += (f'\n[[wall]]\nname = "{name}"\nshape = "plane"\npoint = {list(map(float, point))}\nnormal = {list(map(float, normal))}\n'
                 f'velocity = {velocity}\nfriction = 0.0\n')
    return text + probes(("force_side", "right", "force_x", "sum"))


TESTS = {"prism_long": prism, "oedometer_unload": oedometer}


def curve(folder):
    """Rows of the history, strain, stress [Pa] of what is pressed along z."""
    with open(folder / "history.csv", newline="") as file:
        rows = [{key: float(value) for key, value in row.items()} for row in list(csv.DictReader(file))[1:]]
    length = rows[0]["top"] - rows[0]["bottom"]
    strain = [1 - (row["top"] - row["bottom"]) / length for row in rows]
    stress = [0.5 * (row["force_top"] - row["force_bottom"]) / AREA for row in rows]
    return rows, strain, [-s for s in stress] if abs(min(stress)) > max(stress) else stress


def first_at(values, of, wanted, start=0):
    """Of `of`, where `values` first comes to what is wanted from `start` on; between two rows by a line."""
    for k in range(start + 1, len(values)):
        if values[k] >= wanted > values[k - 1]:
            return of[k - 1] + (wanted - values[k - 1]) / (values[k] - values[k - 1]) * (of[k] - of[k - 1])
    return math.nan


def slope(x, y):
    """Of the line of least squares."""
    n, a, b = len(x), sum(x), sum(y)
    below = n * sum(v * v for v in x) - a * a
    return (n * sum(v * w for v, w in zip(x, y)) - a * b) / below if n > 2 and below else math.nan


def of_prism(folder):
    """{(quantity, unit): value}: what is left at 2, 2.5 and 3 times the strain of the peak, of the strength; energies at the end."""
    rows, strain, stress = curve(folder)
    k = max(range(len(stress)), key=stress.__getitem__)
    found = {("strength", "MPa"): stress[k] * 1e-6, ("peak_strain", "1e-3"): strain[k] * 1e3, ("last_strain", "1e-3"): strain[-1] * 1e3}
    for times, name in ((2.0, "left_2"), (2.5, "left_2.5"), (3.0, "residual")):
        near = [s for e, s in zip(strain[k:], stress[k:]) if abs(e - times * strain[k]) < 0.15 * strain[k]]
        found[name, "-"] = sum(near) / len(near) / stress[k] if strain[-1] >= (times + 0.1) * strain[k] else math.nan
    return found | {(name, "J"): rows[-1][name] for name in ("fracture", "friction", "plastic", "damping", "work")}


def of_oedometer(folder):
    """{(quantity, unit): value}: where it turned, secants of unloading and loading again between shares of the stress there; what comes beyond."""
    _, strain, stress = curve(folder)
    turn = next(k for k in range(5, len(strain) - 5) if strain[k] > 0.05 and strain[k + 3] < strain[k] and strain[k + 5] < strain[k + 2])
    low = min(range(turn, min(len(strain), turn + 600)), key=strain.__getitem__)
    top = stress[turn]

    def between(rows, a, b):
        part = [k for k in rows if a * top <= stress[k] <= b * top and strain[k] < strain[turn]]
        return 1e-9 * slope([strain[k] for k in part], [stress[k] for k in part])

    ends = [first_at(stress, strain, w * 1.2e9, low) for w in (0.9, 1.1)]
    most = max(range(low, len(stress)), key=stress.__getitem__)
    return {("turn_strain", "%"): 100 * strain[turn], ("turn_stress", "GPa"): top * 1e-9, ("low_strain", "%"): 100 * strain[low], ("low_stress", "GPa"): stress[low] * 1e-9,
            ("unload_90_50", "GPa"): between(range(turn + 1, low), 0.5, 0.9), ("unload_50_20", "GPa"): between(range(turn + 1, low), 0.2, 0.5),
            ("reload_20_80", "GPa"): between(range(low, len(strain)), 0.2, 0.8), ("tangent_1200", "GPa"): 0.24 / (ends[1] - ends[0]),
            ("largest", "GPa"): stress[most] * 1e-9, ("largest_strain", "%"): 100 * strain[most], ("last_strain", "%"): 100 * strain[-1], ("last_stress", "GPa"): stress[-1] * 1e-9}


MEASURES = {"prism_long": of_prism, "oedometer_unload": of_oedometer}


def run(name, concrete, elements, packing, given):
    stem = f"{name}-{concrete}-{elements}-{packing}"
    if name not in TESTS:
        keyed_specimens.make(OUT / stem, concrete, [], name, elements, packing, given)
        return
    case, folder, made = OUT / f"{stem}.toml", OUT / stem, TESTS[name](concrete, elements, packing)
    if not (folder / "summary.json").exists() or not case.exists() or case.read_text() != made:
        case.write_text(made)
        done = subprocess.run([given.binary, "run", case, "-o", folder, "--threads", "1", "--device", given.device, "--force", "--no-progress"], stdout=subprocess.DEVNULL)
        if done.returncode not in (0, 9):
            raise SystemExit(f"{case} ended with {done.returncode}")


def collected():
    """A line for each quantity of each finished run in out/library_runs."""
    for folder in sorted(path for path in OUT.iterdir() if path.is_dir()):
        name, concrete, elements, packing = folder.name.split("-")
        summary = keyed_specimens.summary_of(folder)
        if not summary:
            continue
        found = MEASURES[name](folder) if name in TESTS else keyed_specimens.shown(folder)
        made = max(int(elements), 2400) if name == "brazilian" else elements  # a disc has at least so many
        for (quantity, unit), value in found.items():
            yield dict(zip(RECORD, (concrete, str(made), name, packing, summary["breccia"]["commit"], summary["state_hash"], quantity, unit, f"{value:.9g}")))


def by_code(f_c, strain):
    """Stress [MPa] by EN 1992-1-1, 3.14, of a mean strength f_c [MPa], up to its last strain; strain [1e-3]."""
    peak = min(0.7 * f_c**0.31, 2.8)
    last = 3.5 if f_c < 58 else 2.8 + 27 * ((98 - f_c) / 100) ** 4
    k, eta = 1.05 * 22 * (f_c / 10) ** 0.3 * peak / f_c, strain / peak
    return f_c * (k * eta - eta**2) / (1 + (k - 2) * eta) if strain <= last else math.nan


def plot(path):
    """Long prisms of 1,200 elements that are there, beside the code's curves."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, axis = plt.subplots(figsize=(8, 4.2))
    for color, (concrete, f_c) in zip(("tab:blue", "tab:green", "tab:olive", "tab:orange", "tab:red"), (("C20", 28), ("C30", 38), ("C40", 48), ("C60", 68), ("C100", 108))):
        for k, folder in enumerate(sorted(OUT.glob(f"prism_long-{concrete}-1200-*/"))):
            _, strain, stress = curve(folder)
            axis.plot([1e3 * e for e in strain], [1e-6 * s for s in stress], color=color, lw=0.8, label=f"{concrete}, a packing each" if not k else None)
        strains = [0.01 * k for k in range(351)]
        axis.plot(strains, [by_code(f_c, e) for e in strains], "--", color=color, lw=1.4, label="EN 1992-1-1" if concrete == "C20" else None)
    axis.set(xlabel="strain, 1e-3", ylabel="stress, MPa", xlim=(0, 10), ylim=(0, 125))
    published_runs.save_plot(figure, (axis,), path, columns=3)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("names", nargs="*", default=list(TESTS))
    p.add_argument("--concretes", default="C30")
    p.add_argument("--packings", default="5,6,7")
    p.add_argument("--elements", default="1200")
    p.add_argument("--plot", type=pathlib.Path)
    published_runs.add_options(p)
    given = p.parse_args()
    if given.plot:
        return plot(given.plot)
    OUT.mkdir(parents=True, exist_ok=True)
    published_runs.run_all(given.jobs, run, [(name, concrete, int(elements), int(packing), given) for name in given.names for concrete in given.concretes.split(",")
                                             for elements in given.elements.split(",") for packing in given.packings.split(",")])
    records = list(collected())
    for one in records:
        print(",".join(one.values()))
    if given.record:
        published_runs.merge_record(given.record, RECORD, [one for one in records if one["material"] != SLAB], RECORD[:4])


if __name__ == "__main__":
    main()
