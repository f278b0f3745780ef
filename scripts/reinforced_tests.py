#!/usr/bin/env python3
"""Pull-out of a bar and beams of reinforced concrete against formulas, for docs/validation-concrete.md.

    scripts/reinforced_tests.py [--seeds 3] [--elements 0] [--binary build/release/breccia] [--device cpu] [--jobs 1] [NAME...]
    NAME: pull_out bending flow shear stirrups; elements: of the concrete; 0: 3,900 of a beam, 1,080 of a pull-out

Concrete: c30 of cases/rc_slab with friction bounded under pressure (f_c 33.5, f_t 3.3 MPa in prisms of `breccia test`); bars
of 500 MPa; bond by the Model Code 1990, tau_max 13.7 MPa = 2.5 sqrt(30). Cases and results are in out/reinforced/; called
again, only what is missing is run.

pull_out  a bar of 16 mm, bonded over 5 diameters in the middle of a cube of 10 (RILEM RC6), pulled at one end at 0.5 m/s
bending   beam of 1.0 x 0.1 x 0.15 m, span 0.9 m, 2 bars of 6 mm at d = 125 mm, pressed in the middle at 0.15 m/s by a bar across
          it, without local damping
flow      the same with bars that do not harden, as the formula has it
shear     the same with 2 bars of 16 mm: too strong in bending for its shear strength; pressed by a patch of 24 mm, damping 0.1
stirrups  the same with 10 stirrups of 6 mm
"""
import argparse
import concurrent.futures
import csv
import json
import math
import pathlib
import statistics
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
OUT = ROOT / "out" / "reinforced"
F_C, F_Y, SPAN, WIDTH, HEIGHT, DEPTH = 33.5, 500.0, 0.9, 0.1, 0.15, 0.125

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

[material.bond]
law = "interface"
bond = "mc90"
bond_strength = "13.7 MPa"
bond_residual = "5.5 MPa"
slip1 = "1 mm"
slip2 = "3 mm"
slip3 = "8 mm"
tensile_strength = "2.2 MPa"
softening = 10.0
"""


def head(title, seed, end, damping):
    return (f'breccia = 1\nmethod = "dem3d"\ntitle = "{title}"\nseed = {seed}\nlocal_damping = {damping}\n\n[time]\nend = {end}\n\n'
            f'[output]\nframes = 2\ncolor = "damage"\nview = "y"\n\n[search]\nmargin = 0.5\n\n[links]\nrange = 1.443\n' + MATERIALS)


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


def beam(seed, elements, diameter, stirrups=False, slender=False):
    """@param slender  a bending beam: a bar across it presses it and lets it turn, and nothing but bars and concrete takes energy"""
    line = [[-0.48, -0.03, HEIGHT / 2 - DEPTH], [0.48, -0.03, HEIGHT / 2 - DEPTH]]
    text = (head("Reinforced beam", seed, 40e-3, 0.0 if slender else 0.1) + box((1.0, WIDTH, HEIGHT), elements)
            + bars("bars", diameter, 0.02, [(line, 2, [0.0, 0.06, 0.0], False)]))
    if stirrups:  # around the bars, which they touch
        y, low, high = 0.041, HEIGHT / 2 - DEPTH - 0.011, 0.055
        ring = [[-0.405, -y, low], [-0.405, y, low], [-0.405, y, high], [-0.405, -y, high]]
        text += bars("stirrups", 0.006, 0.02, [(ring, 10, [0.09, 0.0, 0.0], True)])
    # Pins across the beam let its ends turn.
    pins = [([[x, -0.042, -0.02], [x, 0.042, -0.02]], 1, [0.0, 0.0, 0.0], False) for x in (-SPAN / 2, SPAN / 2)]
    text += bars("pins", 0.016, 0.02, pins)
    if slender:
        text += bars("roller", 0.016, 0.02, [([[0.0, -0.042, 0.055], [0.0, 0.042, 0.055]], 1, [0.0, 0.0, 0.0], False)])
    for name, x in (("left", -SPAN / 2), ("right", SPAN / 2)):
        text += support(name, "pins", (x - 0.01, -1, -1), (x + 0.01, 1, 1), '["z"]')
    if slender:
        text += support("load", "roller", (-0.01, -1, -1), (0.01, 1, 1), '["z"]', (0, 0, -0.15), 2e-3)
    else:
        text += support("load", "concrete", (-0.012, -1, HEIGHT / 2 - 0.016), (0.012, 1, 1), '["z"]', (0, 0, -0.15), 2e-3)
    return text + "".join(probe(n, n, "force_z", "sum") for n in ("load", "left", "right")) + probe("way", "load", "displacement_z", "mean")


USUAL = {"pull_out": 1080, "bending": 3900, "flow": 3900, "shear": 3900, "stirrups": 3900}  # elements
TESTS = {"pull_out": pull_out, "bending": lambda s, n: beam(s, n, 0.006, slender=True),
         "flow": lambda s, n: beam(s, n, 0.006, slender=True).replace('hardening = "1 GPa"', 'hardening = "1 MPa"'), "shear": lambda s, n: beam(s, n, 0.016),
         "stirrups": lambda s, n: beam(s, n, 0.016, True)}


def area(diameter):
    return 2 * math.pi / 4 * diameter**2


def flexure(diameter):
    """Load at which the bars yield: A_s f_y z, stress block of 0.8 x with f_c; N."""
    force = area(diameter) * F_Y * 1e6
    x = force / (0.8 * WIDTH * F_C * 1e6)
    return 4 * force * (DEPTH - 0.4 * x) / SPAN


def shear_eurocode(diameter):
    """Eurocode 2, 6.2.2, with 0.18 and f_c instead of design values: the load, N."""
    k = min(2.0, 1 + math.sqrt(0.2 / DEPTH))
    rho = min(0.02, area(diameter) / (WIDTH * DEPTH))
    return 2 * 0.18 * k * (100 * rho * F_C) ** (1 / 3) * 1e6 * WIDTH * DEPTH


def shear_model_code(diameter):
    """Model Code 2010, 7.3.3, level II with k_v = 0.4 / (1 + 1500 eps_x) 1300 / (1000 + k_dg z), aggregate of 16 mm; at mid
    depth eps_x = (M / z + V) / (2 E A_s) where V is sought, M = V (L / 2 - d)."""
    z = 0.9 * DEPTH
    v = 1e4
    for _ in range(200):
        strain = min(3e-3, (v * (SPAN / 2 - DEPTH) / z + v) / (2 * 200e9 * area(diameter)))
        k_v = 0.4 / (1 + 1500 * strain) * 1300 / (1000 + 1.0 * 1000 * z)
        v = 0.5 * (v + k_v * math.sqrt(F_C) * 1e6 * WIDTH * z)
    return 2 * v


def rows(folder):
    with open(folder / "history.csv", newline="") as file:
        return [{k: float(v) for k, v in row.items()} for row in list(csv.DictReader(file))[1:]]


def smooth(values, width=25):
    """Running mean, against oscillations of the beam."""
    return [statistics.mean(values[max(0, k - width):k + width + 1]) for k in range(len(values))]


def text(values, digits=1):
    return f"{statistics.mean(values):.{digits}f} +- {statistics.stdev(values) if len(values) > 1 else 0.0:.{digits}f}"


def measured(name, folder):
    """{quantity: value} of one run: the largest load (or bond stress), where it was, what is left at the end, and where that is."""
    table = rows(folder)
    if name == "pull_out":
        surface = math.pi * 0.016 * 0.08
        stress = smooth([abs(r["pull"]) / surface * 1e-6 for r in table], 5)
        k = max(range(len(table)), key=stress.__getitem__)
        return {"largest": stress[k], "way": 1e3 * abs(table[k]["end"]), "left": stress[-6], "end": 1e3 * abs(table[-1]["end"])}
    load = smooth([0.5 * (abs(r["load"]) + abs(r["left"] + r["right"])) * 1e-3 for r in table])
    k = max(range(len(table)), key=load.__getitem__)
    return {"largest": load[k], "way": 1e3 * abs(table[k]["way"]), "left": load[-30], "end": 1e3 * abs(table[-1]["way"])}


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
        of = {"test": name, "elements": (elements or [str(USUAL[name])])[0], "seed": seed,
              "commit": summary["breccia"]["commit"], "device": summary["machine"]["device"], "hash": summary["state_hash"]}
        for quantity, value in measured(name, OUT / case.stem).items():
            yield {**of, "quantity": quantity, "value": f"{value:.9g}"}


def markdown(records):
    found = {}
    for one in records:
        found.setdefault((one["test"], one["elements"]), {}).setdefault(one["quantity"], []).append(float(one["value"]))
    # Against the first number: bond stress, yield of the bars, Eurocode 2, yield of the bars.
    against = {"pull_out": 13.7, "bending": flexure(0.006) * 1e-3, "flow": flexure(0.006) * 1e-3, "shear": shear_eurocode(0.016) * 1e-3, "stirrups": flexure(0.016) * 1e-3}
    lines = ["| test | elements | n | here | formula | misfit |", "|---|---|---|---|---|---|"]
    for (name, elements), values in sorted(found.items(), key=lambda item: (list(TESTS).index(item[0][0]), int(item[0][1]))):
        lines.append(f"| {name.replace('_', '-')} | {int(elements):,} | {len(values['largest'])} | {shown(name, values)} | {asked(name)} | "
                     f"{100 * (statistics.mean(values['largest']) / against[name] - 1):+.0f} % |")
    return "\n".join(lines)


def asked(name):
    if name == "pull_out":
        return f"Model Code 1990 (confined, good bond): 13.7 MPa from 1 to 3 mm; Model Code 2010: 2.5 sqrt(f_cm) = {2.5 * math.sqrt(F_C):.1f} MPa"
    slender = name in ("bending", "flow")
    d = 0.006 if slender else 0.016
    result = f"{'' if slender else 'in bending '}A_s f_y z: {flexure(d) * 1e-3:.1f} kN"
    if slender:
        return result
    if name == "stirrups":
        z = 0.9 * DEPTH
        v = 2 * math.pi / 4 * 0.006**2 / 0.09 * z * F_Y * 1e6
        return result + f"; stirrups alone, struts at 45 and 21.8 degrees: {2 * v * 1e-3:.1f} and {5 * v * 1e-3:.1f} kN"
    return (f"Eurocode 2 (0.18, no safety): {shear_eurocode(d) * 1e-3:.1f} kN; Model Code 2010, level II: {shear_model_code(d) * 1e-3:.1f} kN; "
            + result)


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
    p.add_argument("names", nargs="*", default=list(TESTS))
    p.add_argument("--binary", type=pathlib.Path, default=ROOT / "build/release/breccia")
    p.add_argument("--seeds", type=int, default=3)
    p.add_argument("--elements", type=int, default=0)
    p.add_argument("--device", default="cpu")
    p.add_argument("--jobs", type=int, default=1)
    p.add_argument("--record", type=pathlib.Path, help="a file for the numbers of all finished runs, as docs/results/reinforced.csv")
    given = p.parse_args()
    OUT.mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        for one in [pool.submit(run, n, s, given) for n in given.names for s in range(1, given.seeds + 1)]:
            one.result()
    records = list(collected())
    print(markdown(records))
    if given.record:
        with open(given.record, "w", newline="") as file:
            writer = csv.DictWriter(file, RECORD, lineterminator="\n")
            writer.writeheader()
            writer.writerows(records)


if __name__ == "__main__":
    main()
