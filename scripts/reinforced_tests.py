#!/usr/bin/env python3
"""Pull-out of a bar and beams of reinforced concrete against formulas, for docs/validation-concrete.md.

    scripts/reinforced_tests.py [--seeds 3] [--elements 0] [--binary build/release/breccia] [--device cpu] [--jobs 1] [NAME...]
    NAME: pull_out bending flow shear stirrups plate tied drop, or one of drop (drop_1 to drop_4, tied_, ductile_); bending_C30, likewise flow, shear,
    stirrups, plate: with C30 of `breccia materials`; elements: of the concrete; 0: 3,900 of a beam, 1,080 of a pull-out

Concrete: c30 of cases/rc_slab with friction bounded under pressure (f_c 33.5, f_t 3.3 MPa in prisms of `breccia test`); bars
of 500 MPa; bond by the Model Code 1990, tau_max 13.7 MPa = 2.5 sqrt(30). In shear and stirrups a crack along a bar takes 100 J/m2, and
ribs of 0.065 diameters (EN 10080: 0.03 to 0.15) keep their bond as long as they reach into the concrete. Cases and results are in out/reinforced/; called
again, only what is missing is run.

pull_out  a bar of 16 mm, bonded over 5 diameters in the middle of a cube of 10 (RILEM RC6), pulled at one end at 0.5 m/s
bending   beam of 1.0 x 0.1 x 0.15 m, span 0.9 m, 2 bars of 6 mm at d = 125 mm, pressed in the middle at 0.15 m/s by a bar across
          it, without local damping
flow      the same with bars that do not harden, as the formula has it
shear     the same with 2 bars of 16 mm with ends bent upwards, on pins below them: too strong in bending for its shear strength
stirrups  the same with 11 stirrups of 6 mm, whose elements touch the bars that they hold
plate     the same, pressed by three bars side by side, 76 mm in all
tied      the beam of bending with 10 stirrups of 6 mm, whose elements touch the bars that they hold, and two bars of 6 mm on top
drop      the beams of bending (drop_1 to drop_4) and tied (tied_1 to tied_4) under a hammer of 60 kg at 1 to 4 m/s: a rigid cylinder of 50 mm radius
          across the beam; no gravity, no damping. Bars break where a piece of 20 mm is 8 % longer; in ductile_1 to ductile_4, that of tied, 20 %
"""
import argparse
import csv
import json
import math
import pathlib
import statistics
import subprocess

import published_runs
from reinforced_formulas import DEPTH, F_Y, HEIGHT, SPAN, WIDTH, area, crushing, flexure, shear_crack_theory, shear_eurocode, shear_model_code, shear_niwa

ROOT = pathlib.Path(__file__).resolve().parent.parent
OUT = ROOT / "out" / "reinforced"
F_C, LIBRARY = 33.5, "_C30"  # of the slab's concrete  [MPa]; ending of names of tests with C30 of `breccia materials`

MATERIALS = """
[material.c30]
law = "concrete"
density = 2400.0
young = "30 GPa"
poisson = 0.2
tensile_strength = "1.8 MPa"
cohesion = "11 MPa"
softening = 10.0
friction_angle = "10 deg"
friction_cap = "3 MPa"
broken_friction = 0.6
rolling_limit = 2.0
broken_rolling_limit = 1.0
rolling_cap = "2 MPa"
slip_wear = 0.3
turn_wear = 0.1
compaction_strength = "60 MPa"
compaction_slope = 0.4
crushing_strength = "10 MPa"
crushing_slope = 0.4
fabric = "even"
stiffness = "measured"

[material.b500]
law = "steel"
density = 7850.0
young = "200 GPa"
poisson = 0.3
yield = "500 MPa"
hardening = "1 GPa"
failure_strain = 0.08
"""
BOND = """
[material.bond{0}]
law = "interface"
bond = "mc90"
bond_strength = "13.7 MPa"
bond_residual = "5.5 MPa"
slip1 = "1 mm"
slip2 = "3 mm"
slip3 = "8 mm"
tensile_strength = "2.2 MPa"
{1}
"""
ARM = 0.03  # distance of the outer bars of a wide load from its middle  [m]
PLAIN, TIE = BOND.format("", "softening = 10.0"), -0.05  # HEIGHT / 2 - DEPTH, height of the bars in tension


def ribbed(diameter, name=""):
    """Bond of bars with ribs."""
    return BOND.format(name, f'fracture_energy = 100.0\nrib_height = {0.065 * diameter:.4g}')


def head(title, seed, end, damping, bond=PLAIN):
    return (f'breccia = 1\nmethod = "dem3d"\ntitle = "{title}"\nseed = {seed}\nlocal_damping = {damping}\n\n[time]\nend = {end}\n\n'
            f'[output]\nframes = 2\ncolor = "damage"\nview = "y"\n\n[search]\nmargin = 0.5\n\n[links]\nrange = 1.443\n' + MATERIALS + bond)


def box(size, count):
    return (f'\n[[body]]\nname = "concrete"\nshape = "box"\nmaterial = "c30"\nsize = {list(size)}\n'
            f'pack = {{ count = {count}, size_ratio = 2.0, compactness = 0.56 }}\n')


def bars(name, diameter, spacing, lines):
    text = (f'\n[[body]]\nname = "{name}"\nshape = "rebar"\nmaterial = "b500"\n[body.rebar]\nin = "concrete"\ninterface = "bond"\n'
            f'diameter = {diameter}\nspacing = {spacing}\n')
    for points, copies, step, closed in lines:
        text += f"[[body.rebar.bar]]\npoints = {points}\ncopies = {copies}\nstep = {step}\n" + ("closed = true\n" if closed else "")
    return text


def support(name, on, low, high, fix, velocity=(0, 0, 0), ramp=0.0, more=""):
    return (f'\n[[support]]\nname = "{name}"\non = "{on}"\nmin = {list(low)}\nmax = {list(high)}\nfix = {fix}\n'
            f'velocity = {list(map(float, velocity))}\nramp = {ramp}\n{more}')


def probe(name, on, quantity, reduce):
    return f'\n[[probe]]\nname = "{name}"\non = "{on}"\nquantity = "{quantity}"\nreduce = "{reduce}"\n'


def pull_out(seed, elements):
    return (head("Pull-out of a bar", seed, 8e-3, 0.1) + box((0.16, 0.16, 0.16), elements)
            + bars("bar", 0.016, 0.016, [([[-0.04, 0.0, 0.0], [0.04, 0.0, 0.0]], 1, [0.0, 0.0, 0.0], False)])
            + support("grip", "bar", (-0.044, -1, -1), (-0.036, 1, 1), '["x"]', (-0.5, 0, 0), 5e-4)
            + support("plate", "concrete", (-1, -1, -1), (-0.064, 1, 1), '["x"]',
                      more='center = [0.0, 0.0, 0.0]\nradius = 0.03\naround = "x"\noutside = true\n')
            + probe("pull", "grip", "force_x", "sum") + probe("end", "grip", "displacement_x", "mean")
            + probe("bar_speed", "bar", "velocity_x", "mean"))


def beam(seed, elements):
    """A slender beam: bars across it bear it in mid height, and press it."""
    line = [[-0.48, -0.03, TIE], [0.48, -0.03, TIE]]
    return (head("Reinforced beam", seed, 40e-3, 0.0) + box((1.0, WIDTH, HEIGHT), elements)
            + bars("bars", 0.006, 0.02, [(line, 2, [0.0, 0.06, 0.0], False)]) + loads(-0.02, 0.016, 0.055))


HAMMER, NOSE = 60.0, 0.05  # mass  [kg]  and radius  [m]


def ties():
    """Stirrups of 6 mm around the bars at +-0.03 and two bars of 6 mm on top: where they cross elements touch."""
    y, side, low, high = 0.03, 0.042, TIE - 0.006, 0.055  # pieces of 12 mm: shorter ones shorten the step
    ring = [[-0.36, *point] for point in ((-side, low), (-y, low), (y, low), (side, low), (side, high), (y, high), (-y, high), (-side, high))]
    top = [[-0.48, -y, high - 0.006], [0.48, -y, high - 0.006]]
    return (bars("top", 0.006, 0.02, [(top, 2, [0.0, 2 * y, 0.0], False)])
            + bars("stirrups", 0.006, 0.02, [(ring, 10, [0.08, 0.0, 0.0], True)]))


def tied(seed, elements):
    """The slender beam with stirrups; the bar that presses it lies higher, beside bars on top."""
    line = [[-0.48, -0.03, TIE], [0.48, -0.03, TIE]]
    return (head("Reinforced beam", seed, 40e-3, 0.0) + box((1.0, WIDTH, HEIGHT), elements)
            + bars("bars", 0.006, 0.02, [(line, 2, [0.0, 0.06, 0.0], False)]) + ties() + loads(-0.02, 0.016, 0.066))


def drop(seed, elements, kind, speed):
    """The slender beam on its pins, struck in the middle by a hammer that flies freely."""
    line = [[-0.48, -0.03, TIE], [0.48, -0.03, TIE]]
    middle, ends = (-0.02, 0.02), [(side * SPAN / 2 - 0.01, side * SPAN / 2 + 0.01) for side in (-1, 1)]

    def motion(name, on, between):
        return probe(name, on, "displacement_z", "mean") + f"min = [{between[0]:.4g}, -1.0, -1.0]\nmax = [{between[1]:.4g}, 1.0, 1.0]\n"
    top = head("Reinforced beam under a hammer", seed, SPEEDS[speed], 0.0).replace("frames = 2", "frames = 2\nhistory = 2e-5")
    return ((top.replace("failure_strain = 0.08", "failure_strain = 0.2") if kind == "ductile" else top)
            + box((1.0, WIDTH, HEIGHT), elements) + bars("bars", 0.006, 0.02, [(line, 2, [0.0, 0.06, 0.0], False)]) + ("" if kind == "drop" else ties())
            + pins(-0.02, 0.016) + hold()
            + f'\n[[wall]]\nname = "hammer"\nshape = "cylinder"\npoint = [0.0, {WIDTH / 2 + 0.01}, {HEIGHT / 2 + NOSE + 0.0005:.4g}]\nnormal = [0.0, 1.0, 0.0]\n'
            f'radius = {NOSE}\nlength = {WIDTH + 0.02:.4g}\nmass = {HAMMER}\nfree = ["z"]\nvelocity = [0.0, 0.0, {-float(speed)}]\n'
            + probe("load", "hammer", "force_z", "sum") + probe("hammer_speed", "hammer", "velocity_z", "mean")
            + "".join(probe(n, n, "force_z", "sum") for n in ("left", "right"))
            + motion("way", "concrete", middle) + motion("bars_way", "bars", middle)
            + motion("left_way", "concrete", ends[0]) + motion("right_way", "concrete", ends[1])
            + probe("bonds", "bars", "broken", "sum"))


def strong_beam(seed, elements, stirrups, wide=False):
    """Bars of 16 mm, bent upwards behind the supports, which bear the beam below them."""
    y = 0.03
    line = [[-0.48, -y, 0.04], [-0.48, -y, TIE], [0.48, -y, TIE], [0.48, -y, 0.04]]
    text = head("Reinforced beam", seed, 40e-3 if stirrups else 24e-3, 0.0, ribbed(0.016))
    cage = bars("bars", 0.016, 0.02, [(line, 2, [0.0, 2 * y, 0.0], False)])
    if stirrups:
        # Elements of stirrups lie below and beside elements of bars, which lean on them.
        side, low, high = 0.041, -0.061, 0.055
        ring = [[-0.4, -side, low], [-0.4, -y, low], [-0.4, y, low], [-0.4, side, low], [-0.4, side, TIE], [-0.4, side, high],
                [-0.4, -side, high], [-0.4, -side, TIE]]
        text += ribbed(0.006, "_6")
        cage += bars("stirrups", 0.006, 0.02, [(ring, 11, [0.08, 0.0, 0.0], True)]).replace('"bond"', '"bond_6"')
    return text + box((1.0, WIDTH, HEIGHT), elements) + cage + loads(-0.0665, 0.014, 0.066, wide)


def pins(height, diameter):
    """Pins across the beam, which let its ends turn."""
    lines = [([[x, -0.042, height], [x, 0.042, height]], 1, [0.0, 0.0, 0.0], False) for x in (-SPAN / 2, SPAN / 2)]
    return bars("pins", diameter, 0.02, lines)


def hold():
    return "".join(support(name, "pins", (x - 0.01, -1, -1), (x + 0.01, 1, 1), '["z"]') for name, x in (("left", -SPAN / 2), ("right", SPAN / 2)))


def loads(height, diameter, roller, wide=False):
    """Pins, a bar across the beam, which presses it, and probes.
    @param height, roller  of the pins, of that bar  [m]
    @param wide  three bars side by side instead of one"""
    text = pins(height, diameter)
    first, copies, half = (-ARM, 3, 0.05) if wide else (0.0, 1, 0.01)
    text += bars("roller", 0.016, 0.02, [([[first, -0.042, roller], [first, 0.042, roller]], copies, [abs(first), 0.0, 0.0], False)])
    text += hold() + support("load", "roller", (-half, -1, -1), (half, 1, 1), '["z"]', (0, 0, -0.15), 2e-3)
    return text + "".join(probe(n, n, "force_z", "sum") for n in ("load", "left", "right")) + probe("way", "load", "displacement_z", "mean")


def with_library(text):
    """A case with C30 of `breccia materials` as its concrete."""
    return text.replace(text[text.index("[material.c30]"):text.index("[material.b500]")], '[material.c30]\nuse = "C30"\n\n')


USUAL = {"pull_out": 1080, "bending": 3900, "flow": 3900, "shear": 3900, "stirrups": 3900, "plate": 3900}  # elements
TESTS = {"pull_out": pull_out, "bending": beam, "flow": lambda s, n: beam(s, n).replace('hardening = "1 GPa"', 'hardening = "1 MPa"'),
         "shear": lambda s, n: strong_beam(s, n, False), "stirrups": lambda s, n: strong_beam(s, n, True),
         "plate": lambda s, n: strong_beam(s, n, True, True), "tied": tied}
SPEEDS = {1: 18e-3, 2: 26e-3, 3: 32e-3, 4: 40e-3}  # of the hammer  [m/s]: time of the run  [s]
STRUCK = {"drop": "no stirrups", "tied": "stirrups", "ductile": "stirrups, bars that break at 20 %"}
DROPS = [f"{name}_{speed}" for name in STRUCK for speed in SPEEDS]
BEAMS = ["bending", "flow", "shear", "stirrups", "plate"]
TESTS |= {name + LIBRARY: lambda s, n, name=name: with_library(TESTS[name](s, n)) for name in BEAMS}
USUAL |= {name + LIBRARY: 3900 for name in BEAMS}
TESTS |= {name: lambda s, n, name=name: drop(s, n, name[:-2], int(name[-1])) for name in DROPS}
USUAL |= {name: 3900 for name in ("tied", *DROPS)}


# Concretes of beams: E [GPa], the f_c that design rules ask for, and f_c of `breccia test` with elements of the beams' sizes (600, 1,200, 2,400 and
# 4,800 in the prism; of the slab's concrete the last by interpolation)  [MPa]
YOUNG = {"": 30e3, LIBRARY: 33.6e3}
USUAL_STRENGTH = {"": F_C, LIBRARY: 37.1}
STRENGTH = {"": {3900: 34.6, 15600: 31.6, 31200: 30.4}, LIBRARY: {3900: 39.6, 7800: 38.4, 15600: 37.1, 31200: 34.9}}


def parted(name):
    """bending_C30: bending, _C30; bending: bending, nothing."""
    return (name.removesuffix(LIBRARY), LIBRARY) if name.endswith(LIBRARY) else (name, "")


def rows(folder):
    with open(folder / "history.csv", newline="") as file:
        return [{k: float(v) for k, v in row.items()} for row in list(csv.DictReader(file))[1:]]


def smooth(values, width=25):
    """Running mean, against oscillations of the beam."""
    return [statistics.mean(values[max(0, k - width):k + width + 1]) for k in range(len(values))]


def text(values, digits=1):
    return f"{statistics.mean(values):.{digits}f}" + (f" +- {statistics.stdev(values):.{digits}f}" if len(values) > 1 else "")


def measured(name, folder):
    """{quantity: value} of one run: the largest load (or bond stress), where it was, what is left at the end, and where that is; the largest reaction of both supports."""
    table = rows(folder)
    if name == "pull_out":
        surface = math.pi * 0.016 * 0.08
        stress = smooth([abs(r["pull"]) / surface * 1e-6 for r in table], 5)
        k = max(range(len(table)), key=stress.__getitem__)
        return {"largest": stress[k], "way": 1e3 * abs(table[k]["end"]), "left": stress[-6], "end": 1e3 * abs(table[-1]["end"])}
    if name in DROPS:  # supports push up with less than nothing where inertia lifts the ends
        support = [-1e-3 * (r["left"] + r["right"]) for r in table]
        deflection = [1e3 * (0.5 * (r["left_way"] + r["right_way"]) - r["way"]) for r in table]
        return {"force": 1e-3 * max(abs(r["load"]) for r in table), "reaction": max(support), "lift": -min(support), "way": max(deflection),
                "left": statistics.mean(d for d, r in zip(deflection, table) if r["time"] > table[-1]["time"] - 6e-3),
                "speed": table[-1]["hammer_speed"], "bonds": table[-1]["bonds"]}
    load = smooth([0.5 * (abs(r["load"]) + abs(r["left"] + r["right"])) * 1e-3 for r in table])
    k = max(range(len(table)), key=load.__getitem__)
    return {"largest": load[k], "way": 1e3 * abs(table[k]["way"]), "left": load[-30], "end": 1e3 * abs(table[-1]["way"]),
            "reaction": max(smooth([1e-3 * abs(r["left"] + r["right"]) for r in table]))}


def shown(name, found):
    """@param found  {quantity: values}"""
    if name == "pull_out":
        return (f"tau_max {text(found['largest'])} MPa at a slip of {text(found['way'], 2)} mm; {text(found['left'])} MPa at "
                f"{statistics.mean(found['end']):.1f} mm")
    return (f"{text(found['largest'])} kN at {text(found['way'])} mm; {text(found['left'])} kN at "
            f"{statistics.mean(found['end']):.1f} mm")


RECORD = ["test", "elements", "seed", "commit", "device", "hash", "quantity", "value"]


def collected():
    """A line for each quantity of each finished run in out/reinforced."""
    for case in sorted(OUT.glob("*.toml")):
        name, seed, *elements = case.stem.split("-")
        if not (OUT / case.stem / "summary.json").exists():
            continue
        summary = json.loads((OUT / case.stem / "summary.json").read_text())
        if summary["status"] in ("interrupted", "running"):  # a limit of time ended it
            continue
        of = {"test": name, "elements": (elements or [str(USUAL[name])])[0], "seed": seed,
              "commit": summary["breccia"]["commit"], "device": summary["machine"]["device"], "hash": summary["state_hash"]}
        found = measured(name, OUT / case.stem)
        if name in DROPS:
            found["steel"] = summary["fracture"]["broken_by_kind"]["steel"]
        for quantity, value in found.items():
            yield {**of, "quantity": quantity, "value": f"{value:.9g}"}


def merged(path, records):
    """Lines of the file of other runs, then these."""
    if not path.exists():
        return records
    run = ("test", "elements", "seed")
    here = {tuple(one[k] for k in run) for one in records}
    with open(path, newline="") as file:
        return [one for one in csv.DictReader(file) if tuple(one[k] for k in run) not in here] + records


def gathered(records):
    """{(test, elements): {quantity: values}}"""
    found = {}
    for one in records:
        found.setdefault((one["test"], one["elements"]), {}).setdefault(one["quantity"], []).append(float(one["value"]))
    return found


def plastic_collision(speed, load):
    """Greatest deflection of a beam that bears no more than `load`, struck by the hammer, mm: both go on as one (17/35 of the mass between the supports moves
    as the middle does), and what energy is left bends the beam, elastically first, with cracked concrete (48 E I / L^3)."""
    struck = 17 / 35 * 2400 * WIDTH * HEIGHT * SPAN
    energy = HAMMER * speed**2 / 2 * HAMMER / (HAMMER + struck)
    n, rho = 200 / 30, area(0.006) / (WIDTH * DEPTH)
    x = DEPTH * (math.sqrt(2 * n * rho + (n * rho) ** 2) - n * rho)
    stiffness = 48 * 30e9 * (WIDTH * x**3 / 3 + n * area(0.006) * (DEPTH - x) ** 2) / SPAN**3
    elastic = math.sqrt(2 * energy / stiffness)
    return 1e3 * (elastic if elastic * stiffness < load else energy / load + load / (2 * stiffness))


def drops(records):
    """Table of the hammers: forces; deflections of beams that stop it, beside those of two formulas with the load that the beam bears pressed slowly; none where
    that is missing."""
    found = gathered(records)
    lines = ["| beam; hammer | stop it | pieces of bars that break | force of the hammer; of both supports; of their lift [kN] | greatest deflection [mm] | "
             "plastic collision | 0.63 E_k / P_s | left [mm] | 0.42 E_k / P_s | hammer leaves at [m/s] |", "|---" * 10 + "|"]
    for name in DROPS:
        for size, values in sorted((int(size), values) for (test, size), values in found.items() if test == name):
            kind, speed = name[:-2], int(name[-1])
            slowly = found.get(("bending" if kind == "drop" else "tied", str(size)))
            if not slowly:
                continue
            load = statistics.mean(slowly["largest"])
            slow = HAMMER * speed**2 / 2 / load
            stop = [i for i, v in enumerate(values["speed"]) if v > 0]

            def here(quantity, digits=1):
                return text([values[quantity][i] for i in stop], digits) if stop else "-"

            def over(quantity, formula):
                misfit = f", {100 * (statistics.mean(values[quantity][i] for i in stop) / formula - 1):+.0f} %" if stop else ""
                return f"{formula:.1f}{misfit}"
            kept = f"{here('left')} | {over('left', 0.42 * slow)}" if kind != "drop" else "- | -"
            lines.append(f"| {STRUCK[kind]}, {size:,}; {speed} m/s | {len(stop)} of {len(values['speed'])} | {', '.join(f'{v:.0f}' for v in values['steel'])} | "
                         f"{text(values['force'], 0)}; {text(values['reaction'], 0)}; {text(values['lift'], 0)} | {here('way')} | "
                         f"{over('way', plastic_collision(speed, 1e3 * load))} | {over('way', 0.63 * slow)} | {kept} | {here('speed', 2)} |")
    return "\n".join(lines)


def markdown(records, which="all"):
    """Tests of the slab's concrete, or of C30 of `breccia materials` ("C30")."""
    found = {key: values for key, values in gathered(records).items()
             if key[0] not in DROPS and parted(key[0])[1] == (LIBRARY if which == "C30" else "")}
    lines = ["| test | elements | n | here | formula | misfit |", "|---|---|---|---|---|---|"]
    for (name, elements), values in sorted(found.items(), key=lambda item: (list(TESTS).index(item[0][0]), int(item[0][1]))):
        off = 100 * (statistics.mean(values["largest"]) / against(name, int(elements)) - 1)
        misfit = f"**{off:+.0f} %**" if which == "C30" and abs(off) > 15 else f"{off:+.0f} %"
        lines.append(f"| {parted(name)[0].replace('_', '-')} | {int(elements):,} | {len(values['largest'])} | {shown(name, values)} | {asked(name, int(elements))} | {misfit} |")
    return "\n".join(lines)


def against(name, elements, strength=None):
    """Bond stress, load at which slender bars yield, mean of tests in shear, crushing beside bars that yield: from these misfits are counted.
    @param strength  f_c [MPa], of `breccia test` with elements as large where it is left out"""
    name, concrete = parted(name)
    if name == "pull_out":
        return 13.7
    if name in ("bending", "flow", "tied"):
        return flexure(0.006, USUAL_STRENGTH[concrete]) * 1e-3
    strength = strength or STRENGTH[concrete][elements]
    if name == "plate":
        return crushing(strength, arm=SPAN / 2 - ARM) * 1e-3
    return (shear_niwa if name == "shear" else crushing)(strength) * 1e-3


def asked(name, elements):
    load = against(name, elements)
    name, concrete = parted(name)
    usual = USUAL_STRENGTH[concrete]
    if name == "pull_out":
        return f"Model Code 1990 (confined, good bond): 13.7 MPa from 1 to 3 mm; Model Code 2010: 2.5 sqrt(f_cm) = {2.5 * math.sqrt(usual):.1f} MPa"
    if name in ("bending", "flow", "tied"):
        return f"A_s f_y z: {load:.1f} kN"
    strength = STRENGTH[concrete][elements]
    if name == "plate":
        return f"in bending beside the outer bars, f_c {strength} MPa: {load:.1f} kN"
    if name == "stirrups":
        v = 2 * math.pi / 4 * 0.006**2 / 0.08 * 0.9 * DEPTH * F_Y * 1e6
        return (f"in bending, f_c {strength} MPa: {load:.1f} kN; stirrups alone, struts at 45 and 21.8 degrees: "
                f"{2 * v * 1e-3:.1f} and {5 * v * 1e-3:.1f} kN")
    return (f"f_c {strength} MPa: Niwa et al. 1986 {load:.1f} kN, critical shear crack theory {shear_crack_theory(strength, YOUNG[concrete]) * 1e-3:.1f} kN "
            f"(means of tests); Eurocode 2 (0.18, no safety) and Model Code 2010, level II, for f_c {usual}: {shear_eurocode(0.016, usual) * 1e-3:.1f} and "
            f"{shear_model_code(0.016, usual) * 1e-3:.1f} kN; in bending {crushing(strength) * 1e-3:.1f} kN")


def run(name, seed, given):
    elements = given.elements or USUAL[name]
    end = "" if elements == USUAL[name] else f"-{elements}"
    case, folder = OUT / f"{name}-{seed}{end}.toml", OUT / f"{name}-{seed}{end}"
    made = TESTS[name](seed, elements)
    if not (folder / "summary.json").exists() or not case.exists() or case.read_text() != made:
        case.write_text(made)
        done = subprocess.run([given.binary, "run", case, "-o", folder, "--threads", "1", "--force", "--no-progress", "--device",
                               given.device], stdout=subprocess.DEVNULL)
        if done.returncode not in (0, 9):
            raise SystemExit(f"{case} ended with {done.returncode}")
    return folder


def main():
    p = argparse.ArgumentParser()
    p.add_argument("names", nargs="*", default=[name for name in TESTS if name not in DROPS and not parted(name)[1]] + ["drop"])
    p.add_argument("--binary", type=pathlib.Path, default=ROOT / "build/release/breccia")
    p.add_argument("--seeds", type=int, default=3)
    p.add_argument("--elements", type=int, default=0)
    p.add_argument("--device", default="cpu")
    p.add_argument("--jobs", type=int, default=1)
    p.add_argument("--record", type=pathlib.Path, help="a file for the numbers of all finished runs, as docs/results/reinforced.csv; what it has of others stays")
    given = p.parse_args()
    OUT.mkdir(parents=True, exist_ok=True)
    names = [one for n in given.names for one in (DROPS if n == "drop" else [n])]
    published_runs.run_all(given.jobs, run, [(n, s, given) for n in names for s in range(1, given.seeds + 1)])
    records = list(collected())
    print(markdown(records), markdown(records, "C30"), drops(records), sep="\n\n")
    if given.record:
        published_runs.write_record(given.record, RECORD, merged(given.record, records))


if __name__ == "__main__":
    main()
