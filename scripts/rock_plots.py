#!/usr/bin/env python3
"""Plots of the rock cases' READMEs, from result folders. Needs python3-matplotlib.

    scripts/rock_plots.py KIND RESULT_DIR [RESULT_DIR...] -o plot.png

KIND: tension, crack (fracture energy over growth), bending (force over the way of the press, of three_point_bending_3d), disc (force over travel), kalthoff and kalthoff_3d (crack path), ball (embedded_slab), cylinder (stress over time), dips (strength over the dip of joints), branching (crack front), branching_3d (crack path), spall (velocity of the free end),
triaxial (strengths over pressure, of docs/results/rock.csv), wings (stress over time), arch (crowns over time), dominoes (speed along the row, several runs),
checks (any case: probes over time, and what its checks expect of them).
"""

import argparse
import csv
import json
import math
import pathlib
import textwrap
import tomllib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import arch_thrust
import beam_reference
import domino_wave
import rock_measures


def tension(axes, results):
    for r in results:
        rows = r.rows("history.csv")
        axes.plot([1e6 * row["time"] for row in rows], [row["force"] / 150e3 for row in rows], label=f"{r.value('model.triangles'):.0f} triangles")
    axes.axhline(1.0, color="0.5", lw=1, ls="--", label="f_t")
    axes.set(xlabel="time, us", ylabel="mean stress / f_t")


def crack(axes, results):
    for r in results:
        front, _ = rock_measures.front_energy(r)
        axes.plot([1e3 * x for x, _ in front], [1e3 * f / rock_measures.CRACK_ENERGY for _, f in front], label=f"{r.value('model.triangles'):.0f} triangles")
    axes.plot([5, 35], [15, 45], color="0.5", lw=1, ls="--", label="slope 1: G_I")
    axes.set(xlabel="growth of the crack, mm", ylabel="fracture energy / G_I, mm")


def bending(axes, results):
    notches = set()
    for r in results:
        case = tomllib.loads((r.folder / "case.toml").read_text())
        press = next(s for s in case["support"] if s["name"] == "press")
        speed, ramp = abs(press["velocity"][2]), press["ramp"]
        notch = 1e3 * sum(max(p[2] for p in d["points"]) + 0.02 for d in case.get("discontinuity", []))
        notches.add(round(notch, 3))
        rows = r.rows("history.csv")
        way = [1e6 * speed * (t * t / 2 / ramp if t < ramp else t - ramp / 2) for t in (row["time"] for row in rows)]
        axes.plot(way, [row["force"] for row in rows], lw=0.8,
                  label=f"{r.value('model.tetrahedra'):.0f} tetrahedra" + (f", notch of {notch:.0f} mm" if notch else ""))
    for notch in sorted(notches):
        rows = beam_reference.bend(lambda o: beam_reference.breccia(o, 2.588612779530447), notch=1e-3 * notch)
        axes.plot(1e6 * rows[:, 0], rows[:, 1], "k--" if notch else "k:", lw=1, label="one cohesive plane, at rest" + (f", notch of {notch:.0f} mm" if notch else ""))
    axes.set(xlabel="way of the press, um", ylabel="force, N", xlim=(0, 110), ylim=(0, None))


def disc(axes, results):
    half = math.radians(10.0)
    for r in results:
        rows = r.rows("history.csv")
        axes.plot([1e6 * row["time"] for row in rows],
                  [2.0 * row["force_top"] / (math.pi * 0.04) / 5e6 * (math.sin(2 * half) / half - 1) for row in rows],
                  label=f"{r.value('model.triangles'):.0f} triangles")
    axes.axhline(1.0, color="0.5", lw=1, ls="--", label="Hondros: the centre at f_t")
    axes.set(xlabel="time, us", ylabel="stress at the centre by Hondros / f_t")


def kalthoff(axes, results):
    for r in results:
        for c in r.cracks():
            axes.plot([1e3 * c["x0"], 1e3 * c["x1"]], [1e3 * c["y0"], 1e3 * c["y1"]], color="k", lw=1)
    for angle in (60, 70):
        a = math.radians(angle)
        axes.plot([50, 50 + 75 / math.tan(a)], [25, 100], lw=1, ls="--", label=f"{angle} degrees")
    axes.plot([0, 50], [25, 25], color="0.5", lw=3, label="notch")
    axes.set(xlabel="x, mm", ylabel="y, mm", xlim=(0, 100), ylim=(0, 100), aspect="equal")


def kalthoff_3d(axes, results):
    for r in results:
        axes.plot([1e3 * c["x0"] for c in r.rows("cracks.csv")], [1e3 * c["y0"] for c in r.rows("cracks.csv")], ".", ms=4,
                  label=f"{r.value('model.tetrahedra'):.0f} tetrahedra")
    for angle in (60, 70):
        a = math.radians(angle)
        axes.plot([50, 50 + 75 / math.tan(a)], [25, 100], color="0.5", lw=1, ls="--" if angle == 60 else ":", label=f"{angle} degrees")
    axes.plot([0, 50], [25, 25], color="0.5", lw=3, label="notch")
    axes.set(xlabel="x, mm", ylabel="y, mm", xlim=(0, 100), ylim=(0, 100), aspect="equal")


def ball(axes, results):
    told = set()
    for r in results:
        coupled = "coupling" in r.summary
        rows = r.rows("history.csv")
        axes.plot([1e6 * row["time"] for row in rows], [row["ball"] for row in rows], color="C0" if coupled else "C1", lw=1,
                  label=None if coupled in told else "spheres tied in tetrahedra" if coupled else "spheres alone")
        told.add(coupled)
    axes.axhline(0.0, color="0.5", lw=1, ls="--")
    axes.set(xlabel="time, us", ylabel="velocity of the ball, m/s")


def cylinder(axes, results):
    area = math.pi * 0.025**2
    for r in results:
        rows = r.rows("history.csv")
        axes.plot([1e6 * row["time"] for row in rows], [1e-6 * row["force"] / area for row in rows],
                  label=f"{r.value('model.tetrahedra'):.0f} tetrahedra")
    axes.axhline(34.64, color="0.5", lw=1, ls="--", label="2 c cos(phi)/(1 - sin(phi))")
    axes.set(xlabel="time, us", ylabel="force / section, MPa")


def dips(axes, results):
    """Strength over the dip of the joints, and a plane of weakness (Jaeger 1960)."""
    slope = math.tan(math.radians(30))
    curve = [30.5 + 0.1 * k for k in range(440)]
    borne = [4.0 / ((1 - slope / math.tan(math.radians(b))) * math.sin(2 * math.radians(b))) for b in curve]
    axes.plot(curve, borne, color="0.5", lw=1, ls="--", label="2 c/((1 - tan(phi)/tan(dip)) sin(2 dip))")
    for r in results:
        case = tomllib.loads((r.folder / "case.toml").read_text())
        x, _, z = case["joint_set"][0]["normal"]
        axes.plot(math.degrees(math.atan2(x, z)), 1e-6 * r.value("probe.force.max") / 0.05**2, "C0+", label=None if axes.get_lines()[1:] else f"{len(results)} runs, edges of 16 mm")
    axes.set(xlabel="dip of the joints, degrees", ylabel="strength, MPa", xlim=(35, 70), ylim=(0, 20))


def branching(axes, results):
    for r in results:
        cracks = r.cracks()
        axes.plot([1e6 * c["time"] for c in cracks], [1e3 * c["x"] for c in cracks], ".", ms=3, label="joints that break")
    for share, style in ((0.6, "--"), (1.0, ":")):
        axes.plot([20, 20 + 50 / (2.125 * share)], [0, 50], color="0.5", lw=1, ls=style, label=f"{share} c_R")
    axes.set(xlabel="time, us", ylabel="x, mm", xlim=(10, 80), ylim=(0, 50))


def branching_3d(axes, results):
    for r in results:
        cracks = r.rows("cracks.csv")
        axes.plot([1e3 * c["x0"] for c in cracks], [1e3 * c["y0"] for c in cracks], ".", ms=4, label=f"{r.value('model.tetrahedra'):.0f} tetrahedra")
    axes.set(xlabel="x, mm", ylabel="y, mm", xlim=(0, 50), ylim=(-20, 20), aspect="equal")


def spall(axes, results):
    c = 3319.6
    for r in results:
        rows = r.rows("history.csv")
        axes.plot([1e6 * row["time"] for row in rows], [row["end"] for row in rows], label="free end")
        axes.plot([1e6 * row["time"] for row in rows], [row["cap"] for row in rows], label="mean of the last 45 mm")
    for speed, text in ((20e6, "2 p/(rho c)"), (15e6, "(2 p - f_t)/(rho c)"), (10e6, "(2 p - 2 f_t)/(rho c)")):
        axes.axhline(speed / 2500 / c, color="0.5", lw=1, ls="--")
        axes.text(162, speed / 2500 / c + 0.03, text, fontsize=8)
    axes.set(xlabel="time, us", ylabel="velocity, m/s", xlim=(160, None))


def triaxial(axes, results):
    """Of docs/results/rock.csv: every run of its table triaxial."""
    found = {}
    for row in results:
        if row["table"] == "triaxial" and row["quantity"] == "sigma_1, MPa":
            setting = json.loads(row["setting"])
            found.setdefault(setting["edge"], []).append((setting["pressure"], float(row["value"])))
    for k, (edge, points) in enumerate(sorted(found.items(), reverse=True)):
        axes.plot([p + 0.4 * (k - 1) for p, _ in points], [s for _, s in points], "o", mfc="none", ms=5, label=f"edges of {1e3 * edge:g} mm, {len(points) // 3} meshes")
    axes.plot([-1, 22], [34.64 - 3, 34.64 + 66], color="0.5", lw=1, ls="--", label="Mohr and Coulomb")
    axes.set(xlabel="confining pressure, MPa (sizes beside each other)", ylabel="strength, MPa", xlim=(-1.5, 22.5), ylim=(20, 110))


def wings(axes, results):
    for r in results:
        rows = r.rows("history.csv")
        line, = axes.plot([1e3 * row["time"] for row in rows], [row["force_top"] / 50e3 for row in rows], lw=1, label=f"{r.value('model.triangles'):.0f} triangles")
        first = r.value("fracture.first_break")
        axes.plot(1e3 * first, max(row["force_top"] for row in rows if row["time"] <= first) / 50e3, "o", color=line.get_color(), label="first broken joint")
    axes.axhspan(5.1, 14.6, color="C2", alpha=0.15, lw=0, label="first crack by linear elastic fracture mechanics")
    axes.axhspan(32, 33, color="C3", alpha=0.3, lw=0, label="published strength")
    axes.axhline(7.0, color="C3", lw=1, ls="--", label="published first crack")
    axes.set(xlabel="time, ms", ylabel="mean stress, MPa", xlim=(0, None), ylim=(0, 34))
    axes.legend(fontsize=8, loc="upper left")


def arch(axes, results):
    for r in results:
        rows = r.rows("history.csv")
        for probe, share in (("crown_thick", 0.118), ("crown_thin", 0.098)):
            axes.plot([row["time"] for row in rows], [row[probe] for row in rows], label=f"t/R = {share}")
    stones, limit = 13, arch_thrust.least_thickness(13)
    built = [(1 + share / 2) * math.cos(math.pi / 2 / stones) for share in (0.098, 0.118)]
    axes.axhline(sum(built) / 2, color="0.5", lw=1, ls="--", label=f"as built: rigid stones stay from t/R = {limit:.4f} on")
    axes.set(xlabel="time, s", ylabel="height of the crown, m", xlim=(0, None), ylim=(0, 1.2))


def dominoes(axes, results):
    for r in results:
        rows = r.rows("history.csv")
        count = sum(1 for key in rows[0] if key[0] == "x" and key[1:].isdigit())
        moved = [next((row["time"] for row in rows if row[f"x{k}"] > rows[0][f"x{k}"] + 1e-3), math.nan)
                 for k in range(1, count + 1)]
        case = tomllib.loads((r.folder / "case.toml").read_text())
        friction = case["material"]["stone"]["friction"]
        axes.plot(range(2, count), [0.05 / (b - a) for a, b in zip(moved, moved[2:])], ".-",
                  label=f"friction of stones {friction:g}")
    limit = domino_wave.speeds(stones=40, push=6.0)[-1]
    axes.axhline(limit, color="0.5", lw=1, ls="--", label=f"rigid, without friction: {limit:.2f} m/s")
    axes.set(xlabel="stone", ylabel="speed, m/s", ylim=(0, None))


def checks(axes, results):
    """Probes over time, and dashed what the checks of the case expect of them."""
    for r in results:
        case = tomllib.loads((r.folder / "case.toml").read_text())
        rows = r.rows("history.csv")
        asked = [(c["value"].split(".")[1], float(c["expected"]), c.get("unit", "-"), c["name"]) for c in case["check"]
                 if c["value"].startswith("probe.")]
        unit = asked[0][2]
        asked = [a for a in asked if a[2] == unit]
        largest = max(abs(expected) for _, expected, _, _ in asked)
        prefix, size = next(p for p in (("M", 1e6), ("k", 1e3), ("", 1.0), ("m", 1e-3), ("u", 1e-6)) if largest >= p[1] or p[0] == "u")
        for probe in dict.fromkeys(a[0] for a in asked):
            axes.plot([1e3 * row["time"] for row in rows], [row[probe] / size for row in rows], label=probe)
        for k, (_, expected, _, name) in enumerate(asked):
            axes.axhline(expected / size, color=f"C{len(asked) + k}", lw=1, ls="--", label=textwrap.fill(name, 70))
        axes.set(xlabel="time, ms", ylabel=f"{prefix}{unit}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    kinds = {f.__name__: f for f in (tension, crack, bending, disc, kalthoff, kalthoff_3d, ball, cylinder, dips, branching, branching_3d, spall, triaxial, wings, arch, dominoes, checks)}
    parser.add_argument("kind", choices=kinds)
    parser.add_argument("results", nargs="+", type=pathlib.Path)
    parser.add_argument("-o", "--out", required=True)
    options = parser.parse_args()
    figure, axes = plt.subplots(figsize=(6.4, 4.0))
    read = lambda path: [rock_measures.Result(path)] if path.is_dir() else csv.DictReader(path.open(newline=""))
    kinds[options.kind](axes, [one for path in options.results for one in read(path)])
    axes.grid(alpha=0.3)
    if axes.get_legend_handles_labels()[0] and not axes.get_legend():
        axes.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(options.out, dpi=100)


if __name__ == "__main__":
    main()
