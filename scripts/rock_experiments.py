#!/usr/bin/env python3
"""Tests of granites computed blind, for docs/validation-rock.md.

    scripts/rock_experiments.py [--seeds 3] [--jobs 2] [--binary build/release/breccia] [--record docs/results/rock_experiments.csv] [NAME...]
    scripts/rock_experiments.py --plot docs/published_granite.png

granite     plate of 50 x 100 mm of granite-lac-du-bonnet of `breccia materials` under pressure on its sides; it was calibrated without pressure and with 10 MPa,
            on meshes 1 to 8: meshes from 9 on here
hwangdeung  plate and disc of `breccia test` with the joints that HOSS has for Hwangdeung granite
wings       cases/wing_crack on meshes of five edges: first broken joint and strength
guo         the disc of 40 mm of Guo 2014 between platens, concrete: stress at the first broken joint, and the largest

Cases and results are in out/rock_experiments/; called again, only what is missing is run.
"""
import argparse
import csv
import json
import math
import pathlib
import statistics
import subprocess

import published_runs

ROOT = pathlib.Path(__file__).resolve().parent.parent
OUT = ROOT / "out" / "rock_experiments"
WIDTH, HEIGHT, DISC = 50e-3, 100e-3, 25e-3
RATE, RAMP = 4.0, 1e-4  # of strain [1/s]; until pressure and speed are full [s]
SIGMA_CI, M_I, M_RANGE = 200.0, 32.0, (29.0, 35.0)  # Lac du Bonnet granite; granites in Hoek's table, 32 +- 3
GRANITE = [{"pressure": p} for p in (0, 20, 40)]
WINGS = [{"edge": edge} for edge in ("0.68", "0.70", "0.72", "0.85", "1.0")]  # mm
HWANGDEUNG = {"plate": 209.0, "disc": 9.2}  # measured, MPa
HOSS = {"plate": 212.1, "disc": 9.9}
GUO, GUO_DISC = 1.96, 20e-3  # computed by Guo, MPa; radius  [m]

LDB = 'use = "granite-lac-du-bonnet"'
# E, nu, density, angle, cohesion and tension as published; energies by K_Ic = f_t / 6.88 (Zhang 2002), as those of the granites of `breccia materials`
HD = """density = 2650.0
young = "55 GPa"
poisson = 0.15
friction = 0.6
joint = { tension = "9.2 MPa", cohesion = "55.4 MPa", friction_angle = "35 deg", energy_open = 32.0, energy_slide = 160.0 }"""

GUO_CONCRETE = """density = 2340.0
young = "26 GPa"
poisson = 0.2
joint = { tension = "3 MPa", cohesion = "15 MPa", friction_angle = "30 deg", energy_open = 50.0, energy_slide = 50.0 }"""
PLATENS = """
[material.platen]
density = 7850.0
young = "200 GPa"
poisson = 0.3
joints = "none"
friction = 0.1
"""

HEAD = """breccia = 1
method = "fdem2d"
plane = "stress"
seed = {seed}
energy = {{ stop = 0.1 }}

[time]
end = {end}
evaluate_every = 100

[output]
frames = 0
fields = false
pictures = false

[material.rock]
{rock}
damping = 0.5
"""
ENDS = """
[[support]]
name = "top"
on = "specimen"
min = [-1.0, {y}]
fix = ["y"]
velocity = [0.0, -{v}]
ramp = {ramp}

[[support]]
name = "bottom"
on = "specimen"
max = [1.0, -{y}]
fix = ["y"]
velocity = [0.0, {v}]
ramp = {ramp}
"""
PROBES = "".join(f'\n[[probe]]\nname = "{name}"\non = "{on}"\nquantity = "{quantity}"\nreduce = "{reduce}"\n'
                 for name, on, quantity, reduce in (("force_top", "top", "force_y", "sum"), ("force_bottom", "bottom", "force_y", "sum"),
                                                    ("top", "top", "position_y", "mean"), ("bottom", "bottom", "position_y", "mean")))


def edge(area, seed):
    """Of 1,200 triangles; another mesh of each seed, as `breccia test` has them."""
    return math.sqrt(4 / math.sqrt(3) * area / 1200) * (1 + 0.01 * ((seed + 2) % 5 - 2))


def hoek_brown(pressure, m=M_I):
    return pressure + SIGMA_CI * math.sqrt(m * pressure / SIGMA_CI + 1)


def plate(seed, rock, pressure, expected, young):
    text = HEAD.format(seed=seed, rock=rock, end=f"{RAMP + (1.3 * expected / young + 2e-4) / RATE:.4g}")
    text += f'\n[[body]]\nname = "specimen"\nshape = "plate"\nmaterial = "rock"\nsize = [{WIDTH}, {HEIGHT}]\nmesh_size = {edge(WIDTH * HEIGHT, seed):.6g}\njitter = 0.1\n'
    text += ENDS.format(y=HEIGHT / 2 - WIDTH * 1e-3, v=RATE * HEIGHT / 2, ramp=RAMP) + PROBES
    for name, side in (("left", f"max = [-{WIDTH / 2 * 0.998}, 1.0]"), ("right", f"min = [{WIDTH / 2 * 0.998}, -1.0]")):
        if pressure:
            text += f'\n[[load]]\nname = "{name}"\non = "specimen"\n{side}\npressure = "{pressure} MPa"\nramp = {RAMP}\n'
    return text


def disc(seed, rock, tension, young):
    depth = math.sqrt(1 - 0.01) * DISC  # to flats a tenth of the diameter wide
    caps = ", ".join(f"{{ center = [0.0, {s * 1.5 * depth:.9g}], corners = [[-{DISC}, -{depth / 2:.9g}], [{DISC}, -{depth / 2:.9g}], [{DISC}, {depth / 2:.9g}], [-{DISC}, {depth / 2:.9g}]] }}" for s in (-1, 1))
    text = HEAD.format(seed=seed, rock=rock, end=f"{5e-5 + 9 * tension / young / (RATE / 4):.4g}")
    text += f'\n[[body]]\nname = "specimen"\nshape = "disc"\nmaterial = "rock"\nradius = {DISC}\nmesh_size = {edge(math.pi * DISC**2, seed):.6g}\njitter = 0.1\nhole = [{caps}]\n'
    return text + ENDS.format(y=f"{depth - 1e-3 * DISC:.9g}", v=RATE / 4 * DISC, ramp=5e-5) + PROBES


def between_platens(seed, setting):
    """The disc of Guo: flat platens of steel approach at 50 mm/s."""
    text = HEAD.format(seed=seed, rock=GUO_CONCRETE, end="2.5e-3") + PLATENS
    text += f'\n[[body]]\nname = "disc"\nshape = "disc"\nmaterial = "rock"\nradius = {GUO_DISC}\nmesh_size = {setting["edge"] * 1e-3 * (1 + 0.01 * ((seed + 2) % 5 - 2)):.6g}\njitter = 0.1\n'
    for name, sense in (("top", 1), ("bottom", -1)):
        text += f'\n[[body]]\nname = "{name}"\nshape = "plate"\nmaterial = "platen"\ncenter = [0.0, {sense * (GUO_DISC + 1.551e-3)}]\nsize = [0.012, 0.0031]\nmesh_size = 0.001\nstructured = true\n'
        text += f'\n[[support]]\nname = "press_{name}"\non = "{name}"\nvelocity = [0.0, {-0.025 * sense}]\nramp = 5e-5\n'
    return text + "".join(f'\n[[probe]]\nname = "force_{name}"\non = "press_{name}"\nquantity = "force_y"\nreduce = "sum"\n' for name in ("top", "bottom"))


def case(test, setting, seed):
    if test == "guo":
        return between_platens(seed, setting)
    if test == "wings":
        text = (ROOT / "cases/wing_crack/case.toml").read_text()
        return text.replace('mesh_size = "0.7 mm"', f'mesh_size = "{setting["edge"]} mm"', 1).replace("frames = 34", "frames = 0")
    if test == "granite":
        p = setting["pressure"]
        return plate(seed, LDB, p, hoek_brown(p, M_RANGE[1]), 69e3)
    return plate(seed, HD, 0, 225.0, 52e3) if setting["specimen"] == "plate" else disc(seed, HD, 9.2, 55e3)


TESTS = {"granite": (GRANITE, 9), "hwangdeung": ([{"specimen": s} for s in HWANGDEUNG], 1), "wings": (WINGS, 1), "guo": ([{"edge": 0.7}], 1)}  # settings, first seed
RECORD = ["test", "setting", "seed", "commit", "device", "hash", "seconds", "quantity", "value"]


def rows_of(folder):
    with open(folder / "history.csv", newline="") as file:
        return [{k: float(v) for k, v in row.items() if k != "stage"} for row in list(csv.DictReader(file))[1:]]


def curve(folder):
    """Strain of the height [%] and mean axial stress [MPa] of a plate."""
    rows = rows_of(folder)
    first = rows[0]["top"] - rows[0]["bottom"]
    return [100 * (1 - (r["top"] - r["bottom"]) / first) for r in rows], [5e-7 * abs(r["force_top"] - r["force_bottom"]) / WIDTH for r in rows]


def measured(test, setting, folder):
    if setting.get("specimen") == "disc":
        force = max(0.5 * abs(r["force_top"] - r["force_bottom"]) for r in rows_of(folder))
        return {"strength": 1e-6 * force / (math.pi * DISC)}
    if test == "guo":
        rows, summary = rows_of(folder), json.loads((folder / "summary.json").read_text())
        stress = [(r["time"], 0.5e-6 * (abs(r["force_top"]) + abs(r["force_bottom"])) / (math.pi * GUO_DISC)) for r in rows]
        first = summary["fracture"].get("first_break")
        return {"first": min(stress, key=lambda s: abs(s[0] - first))[1] if first and first > 0 else math.nan, "strength": max(s for _, s in stress), "end": stress[-1][1],
                "broken": summary["fracture"].get("broken_joints", math.nan)}
    if test == "wings":
        first = json.loads((folder / "summary.json").read_text())["fracture"]["first_break"]
        stress = [(r["time"], 0.5e-6 * (abs(r["force_top"]) + abs(r["force_bottom"])) / WIDTH) for r in rows_of(folder)]
        return {"first": min(stress, key=lambda s: abs(s[0] - first))[1], "strength": max(s for _, s in stress)}
    strain, stress = curve(folder)
    # the slope past the confinement, where strains are of the axial load alone
    low, high = ((1 - s) * setting.get("pressure", 0) + s * max(stress) for s in (0.15, 0.4))
    part = [(e, s) for e, s in zip(strain[:stress.index(max(stress))], stress) if low < s < high]
    return {"strength": max(stress), "young": 0.1 * statistics.linear_regression(*zip(*part)).slope if len(part) > 2 else math.nan,
            "strain": strain[stress.index(max(stress))]}


def name_of(test, setting, seed):
    return "-".join([test, *(str(v) for v in setting.values()), str(seed)])


def run(test, setting, seed, binary):
    name, made = name_of(test, setting, seed), case(test, setting, seed)
    path, folder = OUT / f"{name}.toml", OUT / name
    if (folder / "summary.json").exists() and path.exists() and path.read_text() == made:
        return
    path.write_text(made)
    done = subprocess.run([binary, "run", path, "-o", folder, "--threads", "1", "--force", "--no-progress"], stdout=subprocess.DEVNULL)
    print(name, "exit code", done.returncode, flush=True)


def finished():
    for test, (settings, _) in TESTS.items():
        for setting in settings:
            for seed in range(1, 20):
                folder = OUT / name_of(test, setting, seed)
                if (folder / "summary.json").exists() and json.loads((folder / "summary.json").read_text()).get("status") != "running":
                    yield test, setting, seed, folder


def collected():
    for test, setting, seed, folder in finished():
        summary = json.loads((folder / "summary.json").read_text())
        of = {"test": test, "setting": json.dumps(setting), "seed": seed, "commit": summary["breccia"]["commit"], "device": summary["machine"]["device"],
              "hash": summary["state_hash"], "seconds": f"{sum(summary['stages_s'].values()):.4g}"}
        for quantity, value in measured(test, setting, folder).items():
            yield {**of, "quantity": quantity, "value": f"{value:.9g}"}


def spread(values, digits):
    return f"{statistics.mean(values):.{digits}f}" + (f" +- {statistics.stdev(values):.{digits}f}" if len(values) > 1 else "")


def markdown(records, test):
    found = {}
    for one in (one for one in records if one["test"] == test):
        found.setdefault(one["setting"], {}).setdefault(one["quantity"], []).append(float(one["value"]))
    if not found:
        return ""
    if test == "granite":
        lines = [f"| pressure, MPa | n | sigma_1 here, MPa | Hoek and Brown, m_i = {M_I:.0f} (29 to 35) | misfit | slope, GPa (69) | strain at the peak, % |", "|---" * 7 + "|"]
        for setting, values in found.items():
            p, mean = json.loads(setting)["pressure"], statistics.mean(values["strength"])
            lines.append(f"| {p} | {len(values['strength'])} | {spread(values['strength'], 0)} | {hoek_brown(p):.0f} ({hoek_brown(p, M_RANGE[0]):.0f} to {hoek_brown(p, M_RANGE[1]):.0f}) | "
                         f"{100 * mean / hoek_brown(p) - 100:+.0f} % | {spread(values['young'], 1)} | {spread(values['strain'], 3)} |")
    elif test == "wings":
        lines = ["| edges, mm | first broken joint, MPa (7.0; linear elastic fracture mechanics 5.1 to 14.6) | strength, MPa (32 to 33) |", "|---" * 3 + "|"]
        lines += [f"| {json.loads(setting)['edge']} | {values['first'][0]:.2f} | {values['strength'][0]:.1f} |" for setting, values in found.items()]
        first, strength = ([values[name][0] for values in found.values()] for name in ("first", "strength"))
        lines.append(f"| mean of {len(found)} | {spread(first, 1)}, **{100 * statistics.mean(first) / 7.0 - 100:+.0f} %** | "
                     f"{spread(strength, 1)}, **{100 * statistics.mean(strength) / 32.5 - 100:+.0f} %** |")
    elif test == "guo":
        lines = ["| edges, mm | n | first broken joint, MPa | largest 2P/(pi D t), MPa | over f_t | Guo, MPa | misfit |", "|---" * 7 + "|"]
        for setting, values in found.items():
            mean = statistics.mean(values["strength"])
            lines.append(f"| {json.loads(setting)['edge']} | {len(values['strength'])} | {spread(values['first'], 2)} | {spread(values['strength'], 2)} | {mean / 3:.2f} | {GUO} | **{100 * mean / GUO - 100:+.0f} %** |")
    else:
        lines = ["| specimen | n | here, MPa | measured, MPa | misfit | HOSS |", "|---" * 6 + "|"]
        for setting, values in found.items():
            specimen = json.loads(setting)["specimen"]
            lines.append(f"| {specimen} | {len(values['strength'])} | {spread(values['strength'], 1 if specimen == 'plate' else 2)} | {HWANGDEUNG[specimen]} | "
                         f"{100 * statistics.mean(values['strength']) / HWANGDEUNG[specimen] - 100:+.0f} % | {HOSS[specimen]} |")
    cost = {(one["setting"], one["seed"]): float(one["seconds"]) for one in records if one["test"] == test}
    return "\n".join([*lines, "", f"{len(cost)} runs, {sum(cost.values()):.0f} s in all, {max(cost.values()):.0f} s the longest, on a core shared with other work."])


def plot(path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.8))
    colors = {p: c for p, c in zip((0, 20, 40), ("tab:blue", "tab:orange", "tab:red"))}
    for test, setting, _, folder in finished():
        if test != "granite":
            continue
        p = setting["pressure"]
        strain, stress = curve(folder)
        known = left.get_legend_handles_labels()[1]
        left.plot(strain, stress, color=colors[p], lw=0.9, label=None if f"{p} MPa" in known else f"{p} MPa")
        right.plot([p], [max(stress)], "o", mfc="none", ms=6, color=colors[p])
    for p, color in colors.items():
        left.axhspan(hoek_brown(p, M_RANGE[0]), hoek_brown(p, M_RANGE[1]), color=color, alpha=0.15, lw=0)
        left.axhline(hoek_brown(p), color=color, lw=1, ls="--")
    left.plot([0, 0.35], [0, 0.35 * 690], "k:", lw=1, label="measured E, 69 GPa")
    left.axhspan(178, 222, xmax=0.12, color="k", alpha=0.15, lw=0, label="measured without pressure, 200 +- 22")
    left.set(xlabel="axial strain, %", ylabel="axial stress, MPa", xlim=(0, None), ylim=(0, None))
    pressures = [0.5 * k for k in range(91)]
    right.plot(pressures, [hoek_brown(p) for p in pressures], "k--", lw=1, label=f"Hoek and Brown, 200 MPa, m_i = {M_I:.0f}")
    right.fill_between(pressures, *([hoek_brown(p, m) for p in pressures] for m in M_RANGE), color="k", alpha=0.1, lw=0, label="m_i of granites, 29 to 35")
    right.errorbar([0], [200], yerr=[22], fmt="ks", ms=4, label="measured")
    right.plot([], [], "o", mfc="none", color="0.4", label="here, a mesh each")
    right.set(xlabel="pressure on the sides, MPa", ylabel="strength, MPa")
    published_runs.save_plot(figure, (left, right), path)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("names", nargs="*", default=list(TESTS))
    p.add_argument("--binary", type=pathlib.Path, default=ROOT / "build/release/breccia")
    p.add_argument("--seeds", type=int, default=3)
    p.add_argument("--jobs", type=int, default=1)
    p.add_argument("--record", type=pathlib.Path, help="a file for the numbers of all finished runs")
    p.add_argument("--plot", type=pathlib.Path, help="draw what finished runs show; nothing is run")
    given = p.parse_args()
    OUT.mkdir(parents=True, exist_ok=True)
    if given.plot:
        return plot(given.plot)
    published_runs.run_all(given.jobs, run, [(n, s, TESTS[n][1] + k, given.binary) for k in range(given.seeds) for n in given.names
                                          if k == 0 or n != "wings" for s in TESTS[n][0]])
    records = list(collected())
    for test in TESTS:
        print(markdown(records, test) + "\n")
    if given.record:
        published_runs.write_record(given.record, RECORD, records)


if __name__ == "__main__":
    main()
