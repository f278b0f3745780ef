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
FITTED_CONCRETE, FITTED_ROCK = 2, 8  # meshes from 1 on that they were calibrated on
ALLOWED = {"young": 3, "poisson": 10, "brazilian": 5, "tension": 5, "compression": 5, "friction_angle": 5, "fracture_energy": 10}
# of targets: over the unit in calibrations.csv, digits
SHOWN = {"young": (1e9, 2), "poisson": (1, 4), "brazilian": (1e6, 2), "tension": (1e6, 3), "friction_angle": (math.pi / 180, 1), "compression": (1e6, 1)}
CASES = [("C30", "600", "C30 of links, 600 elements, 2 packings"), ("marble-cherokee", "300", "marble, 300 triangles, 2 meshes")]
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


def marked(misfit, target, allowed=None):
    bold = "**" if abs(misfit) > (allowed or ALLOWED[target]) else ""
    return f"{bold}{misfit:+.1f} %{bold}"


class Pressed:
    """A rock under the pressure that its angle is told by: half its strength, but no more than its source has; in MPa and degrees."""

    def __init__(self, target):
        self.free, self.angle = target["compression"], target["friction_angle"]
        self.pressure = min(self.free / 2, target.get("confinement", math.inf))
        self.gain = (1 + math.sin(math.radians(self.angle))) / (1 - math.sin(math.radians(self.angle)))
        self.strength = self.free + self.pressure * self.gain

    def of_gain(self, change):
        """What a change of the gain is of the angle, per cent."""
        return 100 * math.degrees(0.5 * math.cos(math.radians(self.angle)) * change / self.gain) / self.angle

    def allowed(self):
        """By `breccia calibrate`: 5 % of the angle, and no more than changes the strength under pressure by 5 %."""
        return min(ALLOWED["friction_angle"], self.of_gain(0.05 * self.strength / self.pressure))

    def left(self):
        """What 5 % of both strengths leave of the angle."""
        return self.of_gain(0.05 * (self.free + self.strength) / self.pressure)


def steps(lines, materials):
    """Misfits of each step."""
    out = ["| | step | E (3 %) | nu (10 %) | Brazilian, of concretes direct tension (5 %) | friction angle (5 %) | compression (5 %) |", "|---" * 7 + "|"]
    for material in materials:
        of = [one for one in lines if one["material"] == material and one["method"] == "" and one["elements"] == "1200"]
        for step in sorted({int(one["step"]) for one in of}):
            at = {one["target"]: float(one["misfit"]) for one in of if int(one["step"]) == step}
            asked = library_tables.targets_of(material)
            allowed = {"friction_angle": Pressed(asked).allowed()} if "friction_angle" in asked else {}
            cells = [next((marked(at[name], name, allowed.get(name)) for name in names if name in at), "") for names in (["young"], ["poisson"], ["brazilian", "tension"], ["friction_angle"], ["compression"])]
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
            allowed = Pressed(library_tables.targets_of(material)).allowed() if target == "friction_angle" else None
            cells.append(f"{float(one['shown']) / unit:.{digits}f} +- {float(one['deviation'] or 0) / unit:.{digits}f}, {marked(float(one['misfit']), target, allowed)}")
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
    """What is asked beside what is shown on meshes that were not fitted."""
    found = {}
    for one in lines:
        fitted = FITTED_CONCRETE if one["material"] in CONCRETES else FITTED_ROCK
        if int(one["specimen"]) > fitted and math.isfinite(float(one["value"])):
            found.setdefault((one["material"], int(one["elements"])), {}).setdefault((one["test"], one["quantity"]), {})[one["specimen"]] = float(one["value"])
    rocks = any("friction_angle" in library_tables.targets_of(material) for material in materials)
    head = ["", "triangles", "E (3 %), GPa", "nu (10 %)", "Brazilian (5 %), MPa" if rocks else "direct tension (5 %), MPa", "compression (5 %), MPa"]
    head += ["under pressure (5 %), MPa", "friction angle (what 5 % of both strengths leave), degrees", "n"] if rocks else ["n"]
    out = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|"]
    for material in materials:
        target = library_tables.targets_of(material)
        for size in sorted(size for name, size in found if name == material):
            of = found[material, size]
            free, pressed = of.get(("plate", "strength"), {}), of.get(("plate_pressed", "strength"), {})
            if not free:
                continue

            def cell(values, target, digits, allowed, before="", after=""):
                values = list(values)
                if not values:
                    return ""
                mean = statistics.mean(values)
                spread = f" +- {statistics.stdev(values):.{digits}f}" if len(values) > 1 else ""
                return f"{before}{mean:.{digits}f}{spread}, {marked(100 * (mean / target - 1), '', allowed)}{after}" + ("" if len(values) == len(free) else f" (n = {len(values)})")

            pull = of.get(("disc", "strength")) or of.get(("tension", "strength"), {})
            cells = [cell(of.get(("plate", "young"), {}).values(), target["young"], 2, 3), cell(of.get(("plate", "poisson"), {}).values(), target["poisson"], 4, 10),
                     cell(pull.values(), target["brazilian" if rocks else "tension"], 3, 5), cell(free.values(), target["compression"], 1, 5)]
            if rocks:
                rule = Pressed(target)
                gains = [(pressed[mesh] - free[mesh]) / rule.pressure for mesh in sorted(free.keys() & pressed.keys())]
                cells += [cell(pressed.values(), rule.strength, 1, 5, f"{rule.pressure:.3g}: "),
                          cell([math.degrees(math.asin((gain - 1) / (gain + 1))) for gain in gains], rule.angle, 1, rule.left(), after=f" ({rule.left():.0f} %)")]
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
