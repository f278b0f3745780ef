#!/usr/bin/env python3
"""Published impact tests on concrete, computed blind, for docs/validation-impact.md.

    scripts/published_tests.py [--seeds 3] [--binary build/release/breccia] [--device cpu] [--jobs 1] [--record docs/results/published.csv] [NAME...]
    scripts/published_tests.py --plots docs         from finished runs; needs python3-matplotlib
    NAME: spall hopkinson punching perforation fall push

Concretes are those of `breccia materials`, calibrated on slow tests of prisms alone. Cases and results are in out/published/; called
again, only what is missing is run.

spall        a cylinder of 40 x 120 mm at the end of a Hopkinson bar (Klepaczko and Brara 2001): a triangular pulse of 24 us
hopkinson    a cylinder of 40 x 40 mm between the bars of Hopkinson's test in compression, ends free across
punching     a slab of 2.1 x 2.1 x 0.25 m under a hard missile of 47.4 kg, 168 mm, at 135 m/s (VTT, IRIS 2010, tests P1 to P3)
perforation  a slab of 0.61 x 0.61 x 0.178 m under an ogive of 0.5 kg, 25.4 mm, at 301 to 1,058 m/s (Hanchak et al. 1992)
fall         a slab of 2 x 2 x 0.18 m under five blows of 300 kg, 90 mm across, at 1 to 4.5 m/s (Kishi, Mikami and Kurihashi 2010)
push         the same slab, pressed slowly by a disc of 90 mm
"""
import argparse
import csv
import json
import math
import pathlib
import statistics
import subprocess

import impact_formulas
import published_runs
from published_cases import BARS, grouped, HEAD, probe, slab, smooth, spread
from published_falls import CODE_OF_THE_PAPER, fall, fall_table, FALLS, felt_by, FINE, plot_falls, push, push_table, pushed, struck

ROOT = pathlib.Path(__file__).resolve().parent.parent
OUT = ROOT / "out" / "published"

# ---------------------------------------------------------------- spalling

RADIUS, LENGTH, SLICE, RISE = 0.02, 0.12, 0.01, 12e-6  # m, m, m, s
STATIC = 3.55e6  # Pa, direct tension of C40 on packings it was not calibrated on: docs/laboratory.md
STRENGTH = 42e6  # Pa, f_c of the micro-concrete that was tested


def spall(seed, setting):
    keys = f'rate = "{setting["rate"]}"\nrate_strength = "{STRENGTH / 1e6:g} MPa"\n'
    text = HEAD.format(title="Spalling at the end of a Hopkinson bar", seed=seed, end="75 us", safety=0.4, history="0.25 us", concrete="C40", keys=keys)
    text += (f'\n[[body]]\nname = "bar"\nshape = "cylinder"\nmaterial = "concrete"\ncenter = [0.0, 0.0, {LENGTH / 2}]\nradius = {RADIUS}\n'
             f'length = {LENGTH}\npack = {{ count = {setting["elements"]}, size_ratio = 2.0, compactness = 0.56 }}\n'
             '\n[[wall]]\nname = "pulse"\npoint = [0.0, 0.0, 0.0]\nnormal = [0.0, 0.0, 1.0]\n'
             f'velocity = [[0, 0, 0, 0], [{RISE}, 0, 0, {setting["v"]}], [{2 * RISE}, 0, 0, 0], [1, 0, 0, 0]]\n')
    for k in range(round(LENGTH / SLICE)):
        box = ([-1.0, -1.0, k * SLICE if k else -1.0], [1.0, 1.0, (k + 1) * SLICE if (k + 1) * SLICE < LENGTH - 1e-9 else 1.0])
        text += probe(f"p{k}", "bar", "momentum_z", "sum", *box) + probe(f"v{k}", "bar", "velocity_z", "mean", *box)
    return text + probe("end", "bar", "velocity_z", "mean", [-1.0, -1.0, LENGTH - 0.004], [1.0, 1.0, 1.0])


def spalled(rows):
    """Largest tension on planes 10 mm apart, by the momentum of what lies beyond; the mean strain rate there while tension grew."""
    n, area = round(LENGTH / SLICE), math.pi * RADIUS**2
    time = [r["time"] for r in rows]
    best = None
    for k in range(2, n - 1):  # the plane between slices k - 1 and k
        beyond = smooth([sum(r[f"p{i}"] for i in range(k, n)) for r in rows], 2)
        tension = [0.0] + [-(beyond[j + 1] - beyond[j - 1]) / (time[j + 1] - time[j - 1]) / area for j in range(1, len(rows) - 1)]
        peak = max(range(len(tension)), key=tension.__getitem__)
        start = max((j for j in range(peak) if tension[j] <= 0.0), default=0)
        opened = sum((rows[j][f"v{k}"] - rows[j][f"v{k - 1}"]) / SLICE * (time[j] - time[j - 1]) for j in range(start + 1, peak + 1))
        if best is None or tension[peak] > best["strength"]:
            best = {"strength": tension[peak], "rate": opened / max(1e-12, time[peak] - time[start]), "place": LENGTH - k * SLICE,
                    "piece": statistics.mean(rows[-1][f"v{i}"] for i in range(k, n))}
    end = smooth([r["end"] for r in rows], 2)
    top = max(range(len(end)), key=end.__getitem__)
    low = next((j for j in range(top + 8, len(end) - 8) if end[j] <= min(end[j - 8:j + 9])), len(end) - 1)
    best["novikov"] = 0.5 * 2400.0 * math.sqrt(36.3e9 / 2400.0) * (end[top] - end[low])
    return best


def malvar_ross(rate, strength=STRENGTH):
    delta = 1 / (1 + 8 * strength / 10e6)
    return (rate / 1e-6) ** delta if rate <= 1 else 10 ** (6 * delta - 2) * (rate / 1e-6) ** (1 / 3)


def spall_table(records):
    lines = ["| rate law | pulse, m/s | n | strain rate, 1/s | strength, MPa | by the pull-back, MPa | over f_t | Malvar and Ross | misfit | place from the end, mm | piece, m/s |",
             "|---" * 11 + "|"]
    for setting, found in grouped(records):
        rate, strength = statistics.mean(found["rate"]), statistics.mean(found["strength"]) / STATIC
        lines.append(f"| {setting['rate']} | {setting['v']:g} | {len(found['rate'])} | {spread(found['rate'], 0)} | {spread(found['strength'], 1, 1e-6)} | "
                     f"{spread(found['novikov'], 1, 1e-6)} | {strength:.1f} | {malvar_ross(rate):.1f} | {100 * (strength / malvar_ross(rate) - 1):+.0f} % | "
                     f"{spread(found['place'], 0, 1e3)} | {spread(found['piece'], 1)} |")
    return lines


# ---------------------------------------------------------------- compression

SHORT, RISE_OF_BARS = 0.04, 15e-6  # length of the specimen [m], until the ends have their speed [s]


def hopkinson(seed, setting):
    speed, layer = setting["rate"] * SHORT / 2, 0.0026
    end = RISE_OF_BARS + 0.012 / setting["rate"]
    text = HEAD.format(title="Compression between Hopkinson bars", seed=seed, end=f"{1e6 * end:g} us", safety=0.4, history=f"{1e6 * min(0.25e-6, end / 400):g} us" if setting["rate"] > 100 else f"{1e6 * end / 1000:g} us",
                       concrete="C40", keys="")
    text += (f'\n[[body]]\nname = "specimen"\nshape = "cylinder"\nmaterial = "concrete"\ncenter = [0.0, 0.0, 0.0]\nradius = {RADIUS}\n'
             f'length = {SHORT}\npack = {{ count = {setting["elements"]}, size_ratio = 2.0, compactness = 0.56 }}\n')
    for name, low, high, v in (("top", SHORT / 2 - layer, 1.0, -speed), ("bottom", -1.0, layer - SHORT / 2, speed)):
        text += (f'\n[[support]]\nname = "{name}"\non = "specimen"\nmin = [-1.0, -1.0, {low}]\nmax = [1.0, 1.0, {high}]\nfix = ["z"]\n'
                 f'velocity = [0.0, 0.0, {v}]\nramp = {RISE_OF_BARS}\n') + probe(f"force_{name}", name, "force_z", "sum")
    return text


def pressed(rows):
    """The largest mean of both ends' forces over the section, the rate of strain then, and the force that is out of balance."""
    area = math.pi * RADIUS**2
    both = smooth([0.5 * (abs(r["force_top"]) + abs(r["force_bottom"])) / area for r in rows], 2)
    k = max(range(len(both)), key=both.__getitem__)
    return {"strength": both[k], "time": rows[k]["time"], "balance": abs(abs(rows[k]["force_top"]) - abs(rows[k]["force_bottom"])) / area / both[k]}


def model_code_90(rate, strength=48e6):
    alpha = 1 / (5 + 0.9 * strength / 1e6)
    return (rate / 30e-6) ** (1.026 * alpha) if rate <= 30 else 10 ** (6.156 * alpha - 2) * (rate / 30e-6) ** (1 / 3)


def hopkinson_table(records):
    lines = ["| strain rate asked, 1/s | n | strength, MPa | over that at 5/s | CEB-FIP 1990 | misfit | at, us | ends out of balance |", "|---" * 8 + "|"]
    rows = grouped(records)
    slow = next((statistics.mean(found["strength"]) for setting, found in rows if setting["rate"] == 5), math.nan)
    for setting, found in rows:
        over, code = statistics.mean(found["strength"]) / slow, model_code_90(setting["rate"])
        lines.append(f"| {setting['rate']} | {len(found['strength'])} | {spread(found['strength'], 1, 1e-6)} | {over:.2f} | {code:.2f} | {100 * (over / code - 1):+.0f} % | "
                     f"{spread(found['time'], 0, 1e6)} | {spread(found['balance'], 0, 100)} % |")
    return lines


# ---------------------------------------------------------------- hard missiles

def missile(mass, radius, top, nose, length, speed, friction=None):
    nose += "" if friction is None else f"friction = {friction}\n"
    return (f'\n[[wall]]\nname = "missile"\nshape = "cylinder"\npoint = [0.0, 0.0, {top}]\nnormal = [0.0, 0.0, -1.0]\nradius = {radius}\n'
            f'length = {length}\n{nose}mass = {mass}\nvelocity = [0.0, 0.0, {-speed}]\n'
            + probe("speed", "missile", "velocity_z") + probe("force", "missile", "force_z") + probe("tip", "missile", "position_z"))


def rim(size, width, fix):
    inner = size / 2 - width
    sides = {"west": ((-9, -9), (-inner, 9)), "east": ((inner, -9), (9, 9)), "south": ((-inner, -9), (inner, -inner)), "north": ((-inner, inner), (inner, 9))}
    return "".join(f'\n[[support]]\nname = "{name}"\non = "target"\nmin = [{low[0]}, {low[1]}, -1.0]\nmax = [{high[0]}, {high[1]}, 1.0]\nfix = {fix}\n'
                   for name, (low, high) in sides.items())


def punching(seed, setting):
    text = HEAD.format(title="A hard missile through a slab (VTT P1 to P3)", seed=seed, end="14 ms", safety=0.7, history="50 us", concrete="C60", keys="")
    return (text + BARS.format(mats='diameter = "10 mm", cover = "25 mm", layers = 2, bars = 23, elements = 56') + slab(2.1, 0.25, setting["elements"])
            + rim(2.1, 0.05, '["z"]') + missile(47.4, 0.084, 0.1255, "", 0.64, 135.0))


def perforation(seed, setting):
    text = HEAD.format(title="An ogive through a slab (Hanchak et al. 1992)", seed=seed, end=f"{0.9 / setting['v'] * 1e3:.3f} ms", safety=0.7, history="5 us", concrete="C40", keys="")
    nose = f'nose = "ogive"\nnose_length = {0.0127 * math.sqrt(11):.6g}\n'  # caliber radius head 3
    return (text + slab(0.61, 0.178, setting["elements"]) + rim(0.61, 0.02, '["all"]')
            + missile(0.5, 0.0127, 0.0895, nose, 0.1437, setting["v"], setting.get("friction")))


def flown(rows):
    speed, last = [-r["speed"] for r in rows], rows[-1]["time"]
    before = next(-r["speed"] for r in rows if r["time"] >= 0.9 * last)
    return {"residual": speed[-1], "slowing": (before - speed[-1]) / (0.1 * last * 1e3), "force": max(abs(r["force"]) for r in rows),
            "way": -rows[-1]["tip"]}


HANCHAK = {301: 0, 360: 67, 381: 136, 434: 214, 606: 449, 746: 605, 749: 615, 1058: 947}  # m/s: struck, left
STRUCK = [v for v in HANCHAK if v not in (381, 746)]
VTT = (33.8, 45.3, 35.8)  # m/s left, P1 to P3


def punching_table(records):
    limit = impact_formulas.cea_edf(0.168, 0.25, 47.4, 60e6, 2400, 0.349)
    lines = ["| elements | n | left, m/s | slowing at the end, m/s each ms | largest force, MN | measured | misfit | misfit of the energy taken | CEA-EDF with bars leaves |", "|---" * 9 + "|"]
    for setting, found in grouped(records):
        here, there = statistics.mean(found["residual"]), statistics.mean(VTT)
        lines.append(f"| {setting['elements']:,} | {len(found['residual'])} | {spread(found['residual'], 1)} | {spread(found['slowing'], 1)} | {spread(found['force'], 1, 1e-6)} | "
                     f"{', '.join(map(str, VTT))} m/s (mean {there:.1f}) | {here - there:+.1f} m/s | {100 * ((135**2 - here**2) / (135**2 - there**2) - 1):+.0f} % | "
                     f"{math.sqrt(135**2 - limit**2):.0f} m/s |")
    return lines


def perforation_table(records):
    lines = ["| elements | friction of the missile | struck at, m/s | n | left, m/s | largest force, kN | measured, m/s | misfit | misfit of the energy taken |", "|---" * 9 + "|"]
    for setting, found in grouped(records):
        here, there, v = statistics.mean(found["residual"]), HANCHAK[setting["v"]], setting["v"]
        lines.append(f"| {setting['elements']:,} | {setting.get('friction', 0.577)} | {v} | {len(found['residual'])} | {spread(found['residual'], 0)} | {spread(found['force'], 0, 1e-3)} | {there} | "
                     f"{here - there:+.0f} m/s | {100 * ((v**2 - max(0, here)**2) / (v**2 - there**2) - 1):+.0f} % |")
    return lines


# ---------------------------------------------------------------- runs, records, tables

TESTS = {  # name: settings, case, what a history shows, table
    "spall": ([{"rate": rate, "v": v, "elements": 2500} for rate in ("none", "mc2010", "malvar_ross") for v in (1.5, 3.0, 5.0)], spall, spalled, spall_table),
    "hopkinson": ([{"rate": rate, "elements": 833} for rate in (5, 50, 150, 500)], hopkinson, pressed, hopkinson_table),
    "punching": ([{"elements": n} for n in (18000, 36000)], punching, flown, punching_table),
    "perforation": ([{"elements": 60000, "v": v} for v in STRUCK] + [{"elements": 480000, "v": 749}] + [{"elements": 480000, "v": v, "friction": 0.1} for v in STRUCK if v > 400], perforation, flown, perforation_table),
    "fall": ([*FALLS, FINE], fall, struck, fall_table),
    "push": ([*FALLS, FINE], push, pushed, push_table),
}
RECORD = ["test", "setting", "seed", "commit", "device", "hash", "seconds", "quantity", "value"]


def name_of(test, setting, seed):
    return "-".join([test, *(str(v) for v in setting.values()), str(seed)])


def runs_of(test, setting):
    """Folders of the finished runs of a setting."""
    found = [OUT / name_of(test, setting, seed) for seed in range(1, 100)]
    return [folder for folder in found if (folder / "summary.json").exists()]


def rows_of(folder):
    with open(folder / "history.csv", newline="") as file:
        return [{k: float(v) for k, v in row.items() if k != "stage"} for row in list(csv.DictReader(file))[1:]]


def row_of_falls(falls):
    """The falling weight's line of the summary: the largest reaction of a slab over all blows, by supports."""
    borne = {setting["sides"]: [max(one) for one in felt_by(found)] for setting, found in falls}
    return ("falling weight, 300 kg, 1 to 4.5 m/s, slab of 0.18 m with one mat (Kishi 2010)", "by the authors' summary slabs bear about as much on both; forces not at hand",
            f"largest reaction {spread(borne[4], 0, 1e-3)} kN on four sides, {spread(borne[2], 0, 1e-3)} kN on two", f"**two sides over four {100 * (statistics.mean(borne[2]) / statistics.mean(borne[4]) - 1):+.0f} %**",
            "not known; these reactions hold inertia, and pressed slowly both bear about alike (next line)")


def row_of_pushes(pushes):
    """The same slab pressed slowly beside the code's strength in punching; nothing where it was not run."""
    load = {setting["sides"]: found["load"] for setting, found in pushes}
    if {4, 2} <= load.keys():
        over = {sides: 100 * (statistics.mean(of) / CODE_OF_THE_PAPER - 1) for sides, of in load.items()}
        yield ("the same slab pressed slowly by a disc of 90 mm", f"{CODE_OF_THE_PAPER / 1e3:.1f} kN by the code; by the authors' summary about as much on both",
               f"{spread(load[4], 0, 1e-3)} kN on four sides, {spread(load[2], 0, 1e-3)} kN on two", f"{over[4]:+.0f} % on four sides, **{over[2]:+.0f} % on two**; two over four {100 * (statistics.mean(load[2]) / statistics.mean(load[4]) - 1):+.0f} %", "not known (below)")


def summary(records):
    """One line for each experiment."""
    def of(test, **wanted):
        return [(setting, found) for setting, found in grouped([one for one in records if one["test"] == test]) if all(setting.get(k) == v for k, v in wanted.items())]

    def ends(values, digits=1):
        return f"{min(values):.{digits}f} to {max(values):.{digits}f}"

    def off(values):
        return "**" + " to ".join(f"{100 * v:+.0f}" for v in (max(values), min(values))) + " %**"

    setting, found = max(of("punching"), key=lambda one: one[0]["elements"])
    here, there = statistics.mean(found["residual"]), statistics.mean(VTT)
    rows = [("hard missile, 47.4 kg at 135 m/s, slab of 0.25 m (VTT P1 to P3)", f"leaves with {', '.join(map(str, VTT))} m/s", f"{spread(found['residual'], 1)} m/s ({setting['elements']:,} elements)",
             f"{here - there:+.0f} m/s; {100 * ((135**2 - here**2) / (135**2 - there**2) - 1):+.0f} % of the energy taken",
             "**right in part by luck**: the missile is slowed 20 mm deep, not over the slab (below)")]
    coarse, fine = ({setting["v"]: found["residual"] for setting, found in of("perforation", elements=n) if setting.get("friction") == friction} for n, friction in ((60000, None), (480000, 0.1)))

    def fast(nose):
        return [statistics.mean(left) - HANCHAK[v] for v, left in nose.items() if v >= 434]

    rows.append(("ogive, 0.5 kg, 25.4 mm, slab of 0.178 m (Hanchak)", "leaves from 301 m/s on",
                 "; ".join(f"from {v} m/s with {spread(of_v[v], 0)} m/s (measured {HANCHAK[v]}; {text})" for of_v, v, text in ((coarse, 301, "60,000 elements"), (fine, 749, "480,000, friction 0.1"))),
                 f"at the limit {100 * statistics.mean(coarse[301])**2 / 301**2:.0f} % of the energy is left (60,000 elements, 0.577); from 434 m/s on **{max(fast(fine)):.0f} to {min(fast(fine)):.0f} m/s** with 480,000 elements and the friction of fast steel, "
                 f"{max(fast(coarse)):.0f} to {min(fast(coarse)):.0f} m/s with 60,000 and 0.577", "size of elements and friction of the nose (none: -12 % at 749 m/s); believed: inertia of elements, strength under some GPa"))
    pressed_at = {setting["rate"]: statistics.mean(found["strength"]) for setting, found in of("hopkinson")}
    over = {rate: strength / pressed_at[5] for rate, strength in pressed_at.items()}
    low = [over[rate] / model_code_90(rate) - 1 for rate in over if rate > 5]
    rows.append(("compression between Hopkinson bars, 5 to 500/s (CEB-FIP 1990's curve of such tests; Hentz 2004: no law of rate is needed)", f"{ends([model_code_90(r) for r in over])} f_c",
                 f"{ends(over.values())} f_c without a law of rate", f"**{100 * (1 / model_code_90(5) - 1):+.0f} % at 5/s**, **{' to '.join(f'{100 * v:+.0f}' for v in (max(low), min(low)))} % above**",
                 "inertia alone: experiments gain by water and by cracks that cannot keep up, too, which is not in the model"))
    spalls = [(statistics.mean(found["rate"]), statistics.mean(found["strength"]) / STATIC) for _, found in of("spall", rate="malvar_ross")]
    rows.append((f"spalling, {min(r for r, _ in spalls):.0f} to {max(r for r, _ in spalls):.0f}/s (Malvar and Ross' curve of such tests)", f"{ends([malvar_ross(r) for r, _ in spalls])} f_t",
                 f"{ends([s for _, s in spalls])} f_t with `rate = \"malvar_ross\"`", off([s / malvar_ross(r) - 1 for r, s in spalls]), "links soften and share the load before planes open"))
    rows += [row_of_falls(of("fall", elements=18000)), *row_of_pushes(of("push", elements=18000))]
    return "\n".join(["| experiment | measured | here | misfit | believed cause |", "|---" * 5 + "|", *("| " + " | ".join(row) + " |" for row in rows)])


def markdown(records, test):
    if test == "summary":
        return summary(records)
    of = [one for one in records if one["test"] == test]
    return "\n".join(TESTS[test][3](of)) if of else ""


def run(test, setting, seed, given):
    name, made = name_of(test, setting, seed), TESTS[test][1](seed, setting)
    case, folder = OUT / f"{name}.toml", OUT / name
    if (folder / "summary.json").exists() and case.exists() and case.read_text() == made:
        return
    case.write_text(made)
    done = subprocess.run([given.binary, "run", case, "-o", folder, "--threads", str(given.threads), "--device", given.device, "--force", "--no-progress"], stdout=subprocess.DEVNULL)
    print(name, "exit code", done.returncode, flush=True)


def collected():
    for test, (settings, _, measured, _) in TESTS.items():
        for setting in settings:
            for folder in runs_of(test, setting):
                summary = json.loads((folder / "summary.json").read_text())
                of = {"test": test, "setting": json.dumps(setting), "seed": folder.name.rsplit("-", 1)[1], "commit": summary["breccia"]["commit"],
                      "device": summary["machine"]["device"], "hash": "", "seconds": ""}
                if summary["status"] == "done":  # a run that was cut has neither
                    of |= {"hash": summary["state_hash"], "seconds": f"{sum(summary['stages_s'].values()):.4g}"}
                for quantity, value in measured(rows_of(folder)).items():
                    yield {**of, "quantity": quantity, "value": f"{value:.9g}"}


def plots(folder):
    """Of tests that have finished runs here."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    records = list(collected())
    there = {one["test"] for one in records}
    if "hopkinson" in there:
        plot_hopkinson(plt, records, folder)
    if "spall" in there:
        plot_spall(plt, records, folder)
    if {"punching", "perforation"} <= there:
        plot_missiles(plt, records, folder)
    if "fall" in there:
        plot_falls(plt, runs_of, rows_of, folder)


def plot_hopkinson(plt, records, folder):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.6))
    found = grouped([one for one in records if one["test"] == "hopkinson"])
    slow = statistics.mean(found[0][1]["strength"])
    for (setting, values), color in zip(found, ("0.4", "tab:blue", "tab:orange", "tab:red")):
        for k, folder_of in enumerate(runs_of("hopkinson", setting)):
            rows = rows_of(folder_of)
            strain = [100 * setting["rate"] * (r["time"] ** 2 / 2 / RISE_OF_BARS if r["time"] < RISE_OF_BARS else r["time"] - RISE_OF_BARS / 2) for r in rows]
            left.plot(strain, smooth([0.5e-6 * (abs(r["force_top"]) + abs(r["force_bottom"])) / (math.pi * RADIUS**2) for r in rows], 2), color=color, lw=0.8,
                      label=f"{setting['rate']}/s" if not k else None)
        left.axhline(1e-6 * slow * model_code_90(setting["rate"]), color=color, lw=1, ls="--")
        right.plot([setting["rate"]] * len(values["strength"]), [s / slow for s in values["strength"]], "o", ms=4, color=color, label="here, a packing each" if setting["rate"] == 5 else None)
    left.plot([], [], "k--", lw=1, label=f"{1e-6 * slow:.0f} MPa times the code's curve")
    rates = [1, 3, 10, 30, 100, 300, 600]
    right.plot(rates, [model_code_90(r) for r in rates], "k--", lw=1, label="CEB-FIP 1990, 48 MPa")
    right.set(xscale="log", xlabel="strain rate, 1/s", ylabel="strength over that at rest (here: at 5/s)")
    left.set(xlabel="strain, %", ylabel="stress, MPa", xlim=(0, 1.2), ylim=(0, None))
    published_runs.save_plot(figure, (left, right), folder / "published_hopkinson.png")


def plot_spall(plt, records, folder):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.6))
    for rate, color in (("none", "0.4"), ("mc2010", "tab:blue"), ("malvar_ross", "tab:red")):
        setting = {"rate": rate, "v": 3.0, "elements": 2500}
        for k, folder_of in enumerate(runs_of("spall", setting)):
            rows = rows_of(folder_of)
            left.plot([1e6 * r["time"] for r in rows], [r["end"] for r in rows], color=color, lw=0.8, label=rate if not k else None)
        found = [values for setting, values in grouped([one for one in records if one["test"] == "spall"]) if setting["rate"] == rate]
        right.plot([x for f in found for x in f["rate"]], [s / STATIC for f in found for s in f["strength"]], "o", ms=4, color=color, label=rate)
    rates = [1, 3, 10, 30, 100, 160]
    right.plot(rates, [malvar_ross(x) for x in rates], "k--", lw=1, label="Malvar and Ross, f_c 42 MPa")
    right.set(xscale="log", xlabel="strain rate, 1/s", ylabel="strength / f_t")
    left.set(xlabel="time, us", ylabel="velocity of the free end, m/s")
    published_runs.save_plot(figure, (left, right), folder / "published_spall.png")


def plot_missiles(plt, records, folder):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.6))
    for elements, color in ((18000, "0.5"), (36000, "tab:blue")):
        for k, folder_of in enumerate(runs_of("punching", {"elements": elements})):
            rows = rows_of(folder_of)
            left.plot([1e3 * r["time"] for r in rows], [-r["speed"] for r in rows], color=color, lw=1, label=f"{elements:,} elements" if not k else None)
    for v in VTT:
        left.axhline(v, color="k", lw=1, ls="--", label="measured" if v == VTT[0] else None)
    left.set(xlabel="time, ms", ylabel="velocity of the missile, m/s", title="VTT P1 to P3")
    right.plot(list(HANCHAK), list(HANCHAK.values()), "kx-", lw=1, label="measured (Hanchak)")
    for setting, found in grouped([one for one in records if one["test"] == "perforation"]):
        mu, fine = setting.get("friction", 0.577), setting["elements"] > 60000
        right.plot([setting["v"]] * len(found["residual"]), found["residual"], "o" if mu < 0.5 else "s", ms=4, color=("tab:blue" if mu < 0.5 else "tab:orange") if fine else ("tab:cyan" if mu < 0.5 else "0.6"),
                   label=f"here, {setting['elements']:,} elements, friction {mu}" if setting["v"] == 749 else None)
    right.set(xlabel="struck at, m/s", ylabel="left, m/s", title="Hanchak")
    published_runs.save_plot(figure, (left, right), folder / "published_missiles.png")


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("names", nargs="*", default=list(TESTS))
    p.add_argument("--binary", type=pathlib.Path, default=ROOT / "build/release/breccia")
    p.add_argument("--seeds", type=int, default=3)
    p.add_argument("--device", default="cpu")
    p.add_argument("--threads", type=int, default=1)
    p.add_argument("--jobs", type=int, default=1)
    p.add_argument("--record", type=pathlib.Path, help="a file for the numbers of all finished runs, as docs/results/published.csv")
    p.add_argument("--plots", type=pathlib.Path, metavar="DIR", help="draw what finished runs show; nothing is run")
    given = p.parse_args()
    OUT.mkdir(parents=True, exist_ok=True)
    if given.plots:
        plots(given.plots)
        return
    published_runs.run_all(given.jobs, run, [(n, s, seed, given) for seed in range(1, given.seeds + 1) for n in given.names for s in TESTS[n][0]])
    records = list(collected())
    for test in TESTS:
        print(markdown(records, test) + "\n")
    if given.record:
        published_runs.write_record(given.record, RECORD, records)


if __name__ == "__main__":
    main()
