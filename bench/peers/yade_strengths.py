#!/usr/bin/env python3
"""Strengths of the same spheres in Breccia and in YADE (Cpm, parameters of its examples/concrete/uniax.py).

    bench/peers/yade_strengths.py build/release/breccia [-o out/yade] [--seeds 3] [--material MATERIAL]

Prisms of 941 and 2,000 elements, pulled and pressed between smooth ends, and a cube of 941, smooth and held, from the
specimens of `breccia test`; links reach equally far in both. Prints the table of docs/validation-concrete.md; curves are in
DIR. Needs the Debian package yade. Called again, it computes what is missing.
"""
import argparse
import csv
import math
import os
import pathlib
import re
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
import frames  # noqa: E402

RANGE = 1.443
KEYS = ["friction_cap=3e6", "broken_friction=0.6", "broken_rolling_limit=1"]
# name, test of the laboratory, elements of its prism, rate, strain at the end, held, height
TESTS = [
    ("tension 941", "tension", 941, 0.2, 6e-4, False, 0.2),
    ("compression 941", "compression_prism", 941, -0.6, 5e-3, False, 0.2),
    ("tension 2000", "tension", 2000, 0.2, 6e-4, False, 0.2),
    ("compression 2000", "compression_prism", 2000, -0.6, 4.5e-3, False, 0.2),
    ("cube smooth", "compression_cube", 1882, -0.6, 3e-3, False, 0.1),
    ("cube held", "compression_cube", 1882, -0.6, 3.4e-2, True, 0.1),
]


def quiet(*command):
    return subprocess.run([str(c) for c in command], check=True, capture_output=True, text=True).stdout


def case(breccia, out, test, elements, seed, material, held):
    """The case that `breccia test` makes, with frames and, if asked, with held ends."""
    made = out / f"specimens-{elements}"
    if not list(made.glob(f"cases/{test}-{seed}-*.toml")):
        keys = [a for k in KEYS for a in ("--set", f"material.{material}.{k}")]
        quiet(breccia, "test", ROOT / "cases/rc_slab", "--material", material, *keys, "--only", test, "--first-seed", seed,
              "--seeds", 1, "--elements", elements, "--threads", 1, "-o", made)
    text = next(made.glob(f"cases/{test}-{seed}-*.toml")).read_text()
    text = text.replace("frames = 0", "frames = 1", 1).replace("fields = false", "fields = true", 1)
    if held:
        text = text.replace('fix = ["z"]', 'fix = ["all"]')
        text = re.sub(r"(?m)^end = 0\.00833\d*", f"end = {8e-3 / 0.6}", text)
    return text


def rows(path):
    with open(path, newline="") as lines:
        return list(csv.DictReader(lines))


def breccia_curve(folder, height):
    """Strain and stress from the history, tension positive, and E by regression from 10 to 33 % of the peak."""
    table = rows(folder / "history.csv")[1:]
    first = float(table[0]["top"]) - float(table[0]["bottom"])
    strain = [(float(r["top"]) - float(r["bottom"])) / first - 1 for r in table]
    return strain, [0.5 * (float(r["force_top"]) - float(r["force_bottom"])) / 0.01 for r in table]


def numbers(strain, stress):
    sense = 1 if max(stress) > -min(stress) else -1  # that of the forces on the ends, against the pull or push
    y = [sense * v for v in stress]
    x = [math.copysign(1.0, strain[-1]) * v for v in strain]
    peak = max(range(len(y)), key=y.__getitem__)
    part = [k for k in range(peak + 1) if 0.1 * y[peak] < y[k] < 0.33 * y[peak]]
    mx, my = statistics.mean(x[k] for k in part), statistics.mean(y[k] for k in part)
    young = sum((x[k] - mx) * (y[k] - my) for k in part) / sum((x[k] - mx) ** 2 for k in part)
    after = [y[k] / y[peak] for k in range(peak, len(y)) if abs(x[k] - 3 * x[peak]) < 0.15 * x[peak]]
    return {"strength": y[peak] * 1e-6, "strain": x[peak] * 1e3, "young": young * 1e-9,
            "rest": statistics.mean(after) if after else float("nan")}


def one(breccia, out, spec, seed, material):
    name, test, elements, rate, end, held, height = spec
    key = name.replace(" ", "-") + f"-{seed}"
    folder = out / key
    if not (folder / "summary.json").exists():
        (out / f"{key}.toml").write_text(case(breccia, out, test, elements, seed, material, held))
        quiet(breccia, "run", out / f"{key}.toml", "-o", folder, "--threads", 1, "--force", "--no-progress")
    frame = frames.first(folder)
    spheres = out / f"{key}.csv"
    with open(spheres, "w") as file:
        file.write("x,y,z,radius\n")
        for (x, y, z), r in zip(frame["points"], frame["radius"]):
            file.write(f"{x},{y},{z},{r}\n")
    curve = out / f"{key}-yade.csv"
    if not curve.exists():
        layer = 2 * (0.75 * 0.002 * 0.56 / math.pi / elements) ** (1 / 3)
        partial = out / f"{key}-yade.tmp"
        said = quiet("yade", "-n", "-x", "-j1", ROOT / "bench/peers/yade_specimen.py", spheres, partial, rate, end, int(held), height,
                     0.01, RANGE, layer)
        (out / f"{key}-yade.log").write_text(said)
        os.replace(partial, curve)
    yade = rows(curve)
    links = int(re.search(r"links (\d+)", (out / f"{key}-yade.log").read_text()).group(1))
    ours = len(frames.first(folder, "links")["kind"])
    return {"breccia": numbers(*breccia_curve(folder, height)),
            "yade": numbers([float(r["strain"]) for r in yade], [float(r["stress"]) for r in yade]), "links": (ours, links)}


def draw(out, height, name, spec, seeds):
    """Stress (MPa) over strain (1e-3) of one test in both programs, a line a packing."""
    width, tall, left, top, most_x, most_y = 640, 360, 60, 20, 5.0, 40.0
    place = lambda x, y: f"{left + (width - left - 20) * x / most_x:.1f},{tall - 40 - (tall - 40 - top) * y / most_y:.1f}"  # noqa: E731
    lines = []
    for seed in range(1, seeds + 1):
        key = spec.replace(" ", "-") + f"-{seed}"
        yade = rows(out / f"{key}-yade.csv")
        for colour, strain, stress in (("#1f5fa8", *breccia_curve(out / key, height)),
                                       ("#c8501e", [float(r["strain"]) for r in yade], [float(r["stress"]) for r in yade])):
            step = max(1, len(strain) // 200)
            points = [place(1e3 * abs(x), 1e-6 * abs(y)) for x, y in list(zip(strain, stress))[::step] if 1e3 * abs(x) <= most_x]
            lines.append(f'<polyline fill="none" stroke="{colour}" stroke-width="1.5" points="{" ".join(points)}"/>')
    for x in range(0, 6):
        a, b = place(x, 0).split(",")
        lines.append(f'<text x="{a}" y="{float(b) + 16}" text-anchor="middle">{x}</text>')
    for y in range(0, 41, 10):
        a, b = place(0, y).split(",")
        lines.append(f'<text x="{float(a) - 8}" y="{float(b) + 4}" text-anchor="end">{y}</text>')
    corner, end, up = place(0, 0), place(most_x, 0), place(0, most_y)
    lines.append(f'<polyline fill="none" stroke="#444" points="{up} {corner} {end}"/>')
    lines.append(f'<text x="{width / 2}" y="{tall - 6}" text-anchor="middle">strain, 1e-3</text><text x="{left + 12}" y="14">stress, MPa</text>'
                 f'<text x="{width - 150}" y="34" fill="#1f5fa8">Breccia</text><text x="{width - 150}" y="52" fill="#c8501e">YADE Cpm</text>')
    name.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {tall}" font-family="sans-serif" font-size="12">'
                    '<rect width="100%" height="100%" fill="white"/>' + "".join(lines) + "</svg>\n")


def text(values, digits=2):
    spread = statistics.stdev(values) if len(values) > 1 and not any(map(math.isnan, values)) else 0.0
    return f"{statistics.mean(values):.{digits}f} +- {spread:.{digits}f}"


def main():
    p = argparse.ArgumentParser()
    p.add_argument("breccia", type=pathlib.Path)
    p.add_argument("-o", "--out", type=pathlib.Path, default=ROOT / "out" / "yade")
    p.add_argument("--seeds", type=int, default=3)
    p.add_argument("--material", default="c30")
    given = p.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    found = {}
    for spec in TESTS:
        found[spec[0]] = [one(given.breccia, given.out, spec, seed, given.material) for seed in range(1, given.seeds + 1)]
        links = found[spec[0]][0]["links"]
        print(f"{spec[0]}: links of seed 1 {links[0]:,} in Breccia, {links[1]:,} in YADE; strength "
              + "; ".join(f"{who} {text([f[who]['strength'] for f in found[spec[0]]])}" for who in ("breccia", "yade")),
              flush=True)
    draw(given.out, 0.2, given.out / "compression_941.svg", "compression 941", given.seeds)
    print(f"\nn = {given.seeds}\n\n| | Breccia | YADE Cpm |\n|---|---|---|")

    def row(title, value, digits=2):
        cells = [text([value(who, k) for k in range(given.seeds)], digits) for who in ("breccia", "yade")]
        print(f"| {title} | " + " | ".join(cells) + " |")

    for n in (941, 2000):
        t, c = found[f"tension {n}"], found[f"compression {n}"]
        row(f"{n:,}: f_t, MPa", lambda who, k: t[k][who]["strength"])
        row(f"{n:,}: f_c, MPa", lambda who, k: c[k][who]["strength"], 1)
        row(f"{n:,}: f_c / f_t", lambda who, k: c[k][who]["strength"] / t[k][who]["strength"], 1)
        row(f"{n:,}: E, GPa", lambda who, k: c[k][who]["young"], 1)
        row(f"{n:,}: strain at f_c, 1e-3", lambda who, k: c[k][who]["strain"])
        row(f"{n:,}: left of f_c at 3 times that strain", lambda who, k: c[k][who]["rest"])
    s, h = found["cube smooth"], found["cube held"]
    row("cube of 941: smooth, MPa", lambda who, k: s[k][who]["strength"], 1)
    row("cube of 941: held, MPa", lambda who, k: h[k][who]["strength"], 1)
    row("held over smooth", lambda who, k: h[k][who]["strength"] / s[k][who]["strength"])


if __name__ == "__main__":
    main()
