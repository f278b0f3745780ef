"""A weight that falls on reinforced slabs (Kishi, Mikami and Kurihashi 2010): cases, what a history shows, tables and a plot."""
import math
import statistics

import published_runs
from published_cases import BARS, grouped, HEAD, probe, slab, smooth, spread

SLAB, THICK, SPAN, DEEP, TIP, WEIGHT = 2.0, 0.18, 1.75, 0.14, 0.045, 300.0  # m, m, m, m: mean depth of the bars, m: radius, kg
BLOWS, PAUSE = (1.0, 2.0, 3.0, 4.0, 4.5), 0.04  # m/s, on one slab; from one blow to the next  [s]
F_C_FALL = 26.6e6  # Pa, of the tested slabs
# C20 of the library brought to 26.6 MPa on prisms by `breccia test` (docs/validation-impact.md); bars as tested; bond 2.5 sqrt(26.6).
CONCRETE = 'young = "30.2 GPa"\ntensile_strength = "1.586 MPa"\ncohesion = "10.6 MPa"\nfracture_energy = 140.0\n'


def reinforced_slab(title, seed, setting, end):
    """The slab with 11 bars of 16 mm each way, 150 mm apart, and the lines on which it lies, kept from rising, too."""
    text = HEAD.format(title=title, seed=seed, end=end, safety=0.7, history="0.1 ms", concrete="C20", keys=CONCRETE)
    bars = BARS.format(mats='diameter = "16 mm"').replace('use = "B500B"', 'use = "B500B"\nyield = "383 MPa"').replace("13.7", "12.9").replace("5.5 MPa", "5.2 MPa")
    text += bars.replace("rebar = { in = \"target\", interface = \"bond\", diameter = \"16 mm\" }", "[body.rebar]\nin = \"target\"\ninterface = \"bond\"\ndiameter = \"16 mm\"")
    low, half, reach = THICK / 2 - DEEP, 0.008, SLAB / 2 - 0.04
    for points, step in ((f"[[-{reach}, -0.75, {low - half:.4g}], [{reach}, -0.75, {low - half:.4g}]]", "[0.0, 0.15, 0.0]"),
                         (f"[[-0.75, -{reach}, {low + half:.4g}], [-0.75, {reach}, {low + half:.4g}]]", "[0.15, 0.0, 0.0]")):
        text += f"[[body.rebar.bar]]\npoints = {points}\ncopies = 11\nstep = {step}\n"
    text += slab(SLAB, THICK, setting["elements"])
    a, w = SPAN / 2, setting["line"] / 2
    lines = {"west": (-a - w, -a, -a + w, a), "east": (a - w, -a, a + w, a), "south": (-a + w, -a - w, a - w, -a + w), "north": (-a + w, a - w, a - w, a + w)}
    for name in {4: ("west", "east", "south", "north"), 2: ("west", "east")}[setting["sides"]]:
        x, y, far_x, far_y = lines[name]
        text += (f'\n[[support]]\nname = "{name}"\non = "target"\nmin = [{x:.6g}, {y:.6g}, -1.0]\nmax = [{far_x:.6g}, {far_y:.6g}, 1.0]\nfix = ["z"]\n'
                 + probe(f"r_{name}", name, "force_z", "sum"))
    below = -0.05
    text += probe("middle", "target", "displacement_z", "mean", [-TIP, -TIP, -1.0], [TIP, TIP, below])
    for name, x, y in (("e", 0.35, 0), ("n", 0, 0.35), ("w", -0.35, 0), ("s", 0, -0.35)):  # beyond a cone of 27 degrees
        text += probe(f"ring_{name}", "target", "displacement_z", "mean", [round(x - TIP, 6), round(y - TIP, 6), -1.0], [round(x + TIP, 6), round(y + TIP, 6), below])
    return text


def fall(seed, setting):
    text = reinforced_slab("A falling weight on a reinforced slab (Kishi et al. 2010)", seed, setting, f"{1e3 * (len(BLOWS) * PAUSE + 1e-3):g} ms")
    for k, v in enumerate(BLOWS):  # without gravity: each weight begins as far away as it needs the time
        text += (f'\n[[wall]]\nname = "weight{k}"\nshape = "cylinder"\npoint = [0.0, 0.0, {THICK / 2 + v * (1e-3 + k * PAUSE):.6g}]\nnormal = [0.0, 0.0, -1.0]\n'
                 f'radius = {TIP}\nlength = 1.0\nmass = {WEIGHT}\nvelocity = [0.0, 0.0, {-v}]\n' + probe(f"speed{k}", f"weight{k}", "velocity_z")
                 + probe(f"force{k}", f"weight{k}", "force_z") + probe(f"tip{k}", f"weight{k}", "position_z"))
    return text


def push(seed, setting):
    text = reinforced_slab("A reinforced slab pressed in its middle (Kishi et al. 2010)", seed, setting, "82 ms")
    return (text + f'\n[[wall]]\nname = "disc"\nshape = "cylinder"\npoint = [0.0, 0.0, {THICK / 2}]\nnormal = [0.0, 0.0, -1.0]\nradius = {TIP}\nlength = 0.5\n'
            'velocity = [[0, 0, 0, 0], ["4 ms", 0, 0, -0.15], [1, 0, 0, -0.15]]\n' + probe("force", "disc", "force_z"))


def on_lines(row):
    """How hard the slab presses on its lines; below 0 where they keep it from rising."""
    return -sum(v for k, v in row.items() if k.startswith("r_"))


def step_of(row):
    """How far the middle of the lower face has gone down beyond places 350 mm from it: a plug that comes out, m."""
    return statistics.mean(row[f"ring_{k}"] for k in "enws") - row["middle"]


def struck(rows):
    """Of the blows that ran at least 30 ms; the middle and the step are means of the last 5 ms that ran."""
    found = {}
    for k, v in enumerate(BLOWS):
        start = 1e-3 + k * PAUSE
        if rows[-1]["time"] < start + 0.03:
            break
        of = [r for r in rows if start <= r["time"] < start + PAUSE]
        last = of[-50:]
        found |= {f"force{k}": max(abs(r[f"force{k}"]) for r in of), f"reaction{k}": max(smooth([on_lines(r) for r in of], 5)), f"way{k}": THICK / 2 - min(r[f"tip{k}"] for r in of),
                  f"left{k}": -statistics.mean(r["middle"] for r in last), f"step{k}": statistics.mean(map(step_of, last)), f"rebound{k}": last[-1][f"speed{k}"]}
    return found


def load_of(rows):
    """The mean of what the disc gives and the lines bear, over 5 ms, about as long as the whole slab swings."""
    return smooth([0.5 * (abs(r["force"]) + on_lines(r)) for r in rows], 25)


def pushed(rows):
    load = load_of(rows)
    k = max(range(len(load)), key=load.__getitem__)
    return {"load": load[k], "way": -rows[k]["middle"], "after": load[-26], "end": -rows[-1]["middle"], "step": step_of(rows[-1])}


def code_of_punching(strength=F_C_FALL):
    """JSCE's standard specification without factors of safety: 0.2 sqrt(f_c) beta_d beta_p beta_r u_p d; N."""
    ratio = 100 * math.pi / 4 * 0.016**2 / (0.15 * DEEP)
    over = 2 * math.pi * TIP / DEEP
    return 0.2e6 * math.sqrt(strength / 1e6) * min(1.5, (1 / DEEP) ** 0.25) * min(1.5, ratio ** (1 / 3)) * (1 + 1 / (1 + 0.25 * over)) * math.pi * (2 * TIP + DEEP) * DEEP


CODE_OF_THE_PAPER = 251.6e3  # N


def felt_by(found):
    """Of each packing, the largest reactions of the blows that were computed for all."""
    n = len(found["reaction0"])
    return list(zip(*(found[f"reaction{k}"] for k in range(len(BLOWS)) if len(found.get(f"reaction{k}", ())) == n)))


def failed_at(found):
    """Of each packing, the first blow that its supports feel by less than half of the largest force before: the slab has lost half of what it bears. inf: none that was computed."""
    return [next((v for k, v in zip(range(len(of)), BLOWS) if k and of[k] < 0.5 * max(of[:k])), math.inf) for of in felt_by(found)]


def sides_of(setting):
    return {4: "four sides", 2: "two sides"}[setting["sides"]]


def fall_table(records):
    lines = ["| elements | held along | n | blow, m/s | largest force, kN | largest reaction, kN | weight goes down, mm | lower cover after it, mm | weight leaves with, m/s | half lost |", "|---" * 10 + "|"]
    for setting, found in grouped(records):
        failed = failed_at(found)
        for k, v in enumerate(BLOWS):
            cells = ["not computed"] + [""] * 5
            if f"force{k}" in found:
                whole = len(found[f"force{k}"]) == len(failed)  # no packing was cut before
                lost = f"{sum(at <= v for at in failed)} of {len(failed)}" if whole else ""
                cells = [spread(found[f"force{k}"], 0, 1e-3), spread(found[f"reaction{k}"], 0, 1e-3), spread(found[f"way{k}"], 1, 1e3), spread(found[f"left{k}"], 0, 1e3), spread(found[f"rebound{k}"], 1), lost]
            lines.append("| " + " | ".join([f"{setting['elements']:,}", sides_of(setting), str(len(found.get(f"force{k}", ()))), f"{v:g}", *cells]) + " |")
    return lines


def push_table(records):
    lines = ["| elements | held along | n | largest load, kN | over the code's 251.6 kN | at, mm | load at the end, kN | at, mm | lower face beyond 350 mm, mm |", "|---" * 9 + "|"]
    for setting, found in grouped(records):
        lines.append(f"| {setting['elements']:,} | {sides_of(setting)} | {len(found['load'])} | {spread(found['load'], 0, 1e-3)} | {100 * (statistics.mean(found['load']) / CODE_OF_THE_PAPER - 1):+.0f} % | "
                     f"{spread(found['way'], 1, 1e3)} | {spread(found['after'], 0, 1e-3)} | {spread(found['end'], 1, 1e3)} | {spread(found['step'], 1, 1e3)} |")
    return lines


FALLS = [{"elements": 18000, "line": 0.0175, "sides": n} for n in (4, 2)]  # line: width of a support, a radius  [m]
FINE = {"elements": 60000, "line": 0.0117, "sides": 4}
COLORS = ("tab:blue", "tab:orange")


def plot_falls(plt, runs_of, rows_of, folder):
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(14, 3.8))
    for setting, color in zip(FALLS, COLORS):
        for k, folder_of in enumerate(runs_of("fall", setting)):
            rows = rows_of(folder_of)
            found, name = struck(rows), sides_of(setting) if not k else None
            if not k:
                left.plot([1e3 * r["time"] for r in rows], [1e-3 * f for f in smooth([on_lines(r) for r in rows], 5)], color=color, lw=0.8, label=name)
            at = [i for i in range(len(BLOWS)) if f"reaction{i}" in found]
            middle.plot([BLOWS[i] for i in at], [1e-3 * found[f"reaction{i}"] for i in at], "o-", ms=3, color=color, lw=0.8, label=name)
    for setting, color in zip((*FALLS, FINE), (*COLORS, "k")):
        for k, folder_of in enumerate(runs_of("push", setting)):
            rows = rows_of(folder_of)
            name = sides_of(setting) + (f", {setting['elements']:,} elements" if setting == FINE else "")
            right.plot([-1e3 * r["middle"] for r in rows], [1e-3 * f for f in load_of(rows)], color=color, lw=0.8, label=name if not k else None)
    right.axhline(1e-3 * CODE_OF_THE_PAPER, color="0.4", lw=1, ls="--", label="the code's strength")
    left.set(xlabel="time, ms", ylabel="reaction, kN", title="blows, packing 1")
    middle.set(xlabel="blow, m/s", ylabel="largest reaction, kN", ylim=(0, None), title="blows, all packings")
    right.set(xlabel="middle of the lower face goes down, mm", ylabel="load, kN", ylim=(0, None), title="pressed slowly, all packings")
    published_runs.save_plot(figure, (left, middle, right), folder / "published_fall.png")
