#!/usr/bin/env python3
"""Tables of calibrations, and of what materials of triangles of `breccia materials` show on meshes that they were not calibrated on, for docs/laboratory.md.

    breccia calibrate CASE --material m -o DIR/MATERIAL..ELEMENTS                                   # the library's
    breccia calibrate CASE --material m --method METHOD --steps 60 -o DIR/MATERIAL.METHOD.ELEMENTS  # a comparison of methods; C30 is that of links
    breccia test CASE --material m --first-seed 3 --elements ELEMENTS -o DIR/MATERIAL.ELEMENTS
    scripts/rock_library.py calibrations DIR > docs/results/calibrations.csv
    scripts/rock_library.py specimens DIR > docs/results/rocks.csv

CASE is any plane case whose material m has `use = "MATERIAL"`; `specimen` is the seed of its mesh.
"""
import csv
import json
import math
import pathlib
import re
import statistics
import sys
import tomllib

import library_tables

NAMES = {"granite-lac-du-bonnet": "Lac du Bonnet granite", "granite-pikes-peak": "Pikes Peak granite", "limestone-bedford": "limestone", "marble-cherokee": "marble",
         "sandstone-berea": "sandstone", "shale-micaceous": "shale"}
CONCRETES = ["C20", "C30", "C40", "C60", "C100"]
ALLOWED = {"young": 3, "poisson": 10, "brazilian": 5, "tension": 5, "compression": 5, "friction_angle": 5, "fracture_energy": 10}
# of targets: over the unit in calibrations.csv, digits
SHOWN = {"young": (1e9, 2), "poisson": (1, 4), "brazilian": (1e6, 2), "tension": (1e6, 3), "friction_angle": (math.pi / 180, 1), "compression": (1e6, 1)}
CASES = [("C30", "1200", "C30 of links, 1,200 elements, 2 packings"), ("C30", "600", "the same, 600 elements"), ("marble-cherokee", "300", "marble, 300 triangles, 2 meshes"),
         ("granite-lac-du-bonnet", "300", "Lac du Bonnet granite, 300 triangles, 2 meshes")]
CALIBRATION = ["material", "method", "elements", "step", "target", "key", "shown", "deviation", "misfit"]
SPECIMEN = ["material", "elements", "test", "specimen", "quantity", "unit", "value", "hash", "seconds"]


def calibrations(root):
    """Lines of calibrations.csv, from calibration.md of each folder."""
    for page in sorted(root.glob("*/calibration.md")):
        material, method, elements = page.parent.name.split(".")
        rows = [[cell.strip() for cell in line.strip("| \n").split("|")] for line in page.read_text().splitlines() if re.match(r"\| (step|\d)", line)]
        for row in rows[1:]:
            for key, shown, head in zip(row[1::2], row[2::2], rows[0][2::2]):
                found = re.match(r"(\S+)(?: \+- (\S+))?.*, ([+-][\d.]+) %$", shown)
                yield dict(zip(CALIBRATION, [material, method, elements, row[0].split(",")[0], head.split(",")[0], key, found[1], found[2] or "", found[3]]))


def specimens(root):
    """Lines of rocks.csv, from specimens.csv of each folder."""
    for table in sorted(root.glob("*/specimens.csv")):
        material, elements = table.parent.name.split(".")
        runs = {}
        for file in table.parent.glob("runs/*/summary.json"):
            test, mesh, _ = file.parent.name.rsplit("-", 2)
            runs[test, int(mesh)] = json.loads(file.read_text())
        first = min(mesh for _, mesh in runs) - 1
        for line in csv.DictReader(table.open()):
            line["specimen"] = int(line["specimen"]) + first
            run = runs[line["test"], line["specimen"]]
            yield {"material": material, "elements": elements, **line, "hash": run["state_hash"], "seconds": f"{sum(run['stages_s'].values()):.4g}"}


def marked(misfit, target):
    bold = "**" if abs(misfit) > ALLOWED[target] else ""
    return f"{bold}{misfit:+.1f} %{bold}"


def steps(lines, materials):
    """Misfits of each step."""
    out = ["| | step | E (3 %) | nu (10 %) | Brazilian, of concretes direct tension (5 %) | friction angle (5 %) | compression (5 %) |", "|---" * 7 + "|"]
    for material in materials:
        of = [one for one in lines if one["material"] == material and one["method"] == "" and one["elements"] == "1200"]
        for step in sorted({int(one["step"]) for one in of}):
            at = {one["target"]: float(one["misfit"]) for one in of if int(one["step"]) == step}
            cells = [next((marked(at[name], name) for name in names if name in at), "") for names in (["young"], ["poisson"], ["brazilian", "tension"], ["friction_angle"], ["compression"])]
            out.append(f"| {NAMES.get(material, material) if step == 1 else ''} | {step} | " + " | ".join(cells) + " |")
    return "\n".join(out)


def last_steps(lines, materials):
    """What the last step of each rock shows, and the keys that the library has."""
    library = tomllib.loads(library_tables.MATERIALS.read_text())
    out = ["| rock | E, GPa | nu | Brazilian, MPa | friction angle, degrees | compression, MPa | young; poisson; joint.tension, .friction_angle, .cohesion |", "|---" * 7 + "|"]
    for material in materials:
        of = [one for one in lines if one["material"] == material and one["method"] == "" and one["elements"] == "1200"]
        last = {one["target"]: one for one in of if one["step"] == max(of, key=lambda o: int(o["step"]))["step"]}
        cells = []
        for target in ("young", "poisson", "brazilian", "friction_angle", "compression"):
            unit, digits = SHOWN[target]
            one = last[target]
            cells.append(f"{float(one['shown']) / unit:.{digits}f} +- {float(one['deviation'] or 0) / unit:.{digits}f}, {marked(float(one['misfit']), target)}")
        block = library[material]["fdem2d"]
        joint = block["joint"]
        cells.append(f"{block['young']}; {block['poisson']}; {joint['tension']}, {joint['friction_angle']}, {joint['cohesion']}")
        out.append(f"| {NAMES[material]} | " + " | ".join(cells) + " |")
    return "\n".join(out)


def methods(lines):
    """How many evaluations each method needs."""
    out = ["| | method | evaluations | all targets met | largest misfit over what is allowed: least, in evaluation |", "|---" * 5 + "|"]
    for material, elements, words in CASES:
        for method in ("secant", "cobyla", "sbplx", "bobyqa"):
            of = [one for one in lines if (one["material"], one["elements"], one["method"]) == (material, elements, method)]
            if not of:
                continue
            worst = {}
            for one in of:
                worst[int(one["step"])] = max(worst.get(int(one["step"]), 0.0), abs(float(one["misfit"])) / ALLOWED[one["target"]])
            best = min(worst, key=worst.get)
            out.append(f"| {words if method == 'secant' else ''} | {method} | {len(worst)} | {'yes' if worst[best] <= 1 else 'no'} | {worst[best]:.2f}, {best} |")
    return "\n".join(out)


def recovery(lines, materials):
    """What is asked beside what is shown on meshes from 3 on."""
    found = {}
    for one in lines:
        if int(one["specimen"]) >= 3 and math.isfinite(float(one["value"])):
            found.setdefault((one["material"], int(one["elements"])), {}).setdefault((one["test"], one["quantity"]), {})[one["specimen"]] = float(one["value"])
    out = ["| | triangles | E (3 %), GPa | nu (10 %) | Brazilian, of concretes direct tension (5 %), MPa | compression (5 %), MPa | friction angle (5 %), degrees | n |", "|---" * 8 + "|"]
    for material in materials:
        target = library_tables.targets_of(material)
        for size in sorted(size for name, size in found if name == material):
            of = found[material, size]
            free, pressed = of.get(("plate", "strength"), {}), of.get(("plate_10", "strength"), {})
            if not free:
                continue
            angles = []
            for mesh in sorted(free.keys() & pressed.keys()):
                gain = (pressed[mesh] - free[mesh]) / 10
                angles.append(math.degrees(math.asin((gain - 1) / (gain + 1))))
            cells = []
            for values, name, digits in ((of.get(("plate", "young"), {}).values(), "young", 2), (of.get(("plate", "poisson"), {}).values(), "poisson", 4),
                                         ((of.get(("disc", "strength")) or of.get(("tension", "strength"), {})).values(), "brazilian" if "brazilian" in target else "tension", 3),
                                         (free.values(), "compression", 1), (angles, "friction_angle", 1)):
                values = list(values)
                if not values or name not in target:
                    cells.append("")
                    continue
                mean = statistics.mean(values)
                spread = f" +- {statistics.stdev(values):.{digits}f}" if len(values) > 1 else ""
                cells.append(f"{mean:.{digits}f}{spread}, {marked(100 * (mean / target[name] - 1), name)}"
                             + ("" if len(values) == len(free) else f" (n = {len(values)})"))
            out.append(f"| {NAMES.get(material, material)} | {size:,} | " + " | ".join(cells) + f" | {len(free)} |")
    return "\n".join(out)


def calibration_table(lines, which):
    if which == "methods":
        return methods(lines)
    if which == "rocks":
        return last_steps(lines, list(NAMES))
    return steps(lines, CONCRETES if which == "concretes" else [name for name in NAMES if name.startswith("granite")])


def recovery_table(lines, which):
    return recovery(lines, CONCRETES if which == "concretes" else list(NAMES))


def main():
    kinds = {"calibrations": (calibrations, CALIBRATION), "specimens": (specimens, SPECIMEN)}
    if len(sys.argv) != 3 or sys.argv[1] not in kinds:
        sys.exit(__doc__)
    lines, fields = kinds[sys.argv[1]]
    writer = csv.DictWriter(sys.stdout, fields, lineterminator="\n")
    writer.writeheader()
    writer.writerows(lines(pathlib.Path(sys.argv[2])))


if __name__ == "__main__":
    main()
