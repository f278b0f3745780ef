#!/usr/bin/env python3
"""Impact on the slab of cases/rc_slab over packings, for its README and docs/validation-concrete.md.

    scripts/impact_tables.py ball [--seeds 10] [--speeds 10,30] [--concrete NAME,...] [--bars yes,no]
    scripts/impact_tables.py hard [--seeds 5] [--speeds 20,30,45,60] [--concrete NAME,...] [--bars yes,no]
    scripts/impact_tables.py print ball|hard
    scripts/impact_tables.py record         all finished rows into docs/results/impact.csv; lines of others stay
    scripts/impact_tables.py plot           the plot of cases/rc_slab from that file; needs python3-matplotlib

"ball" is the case as it is: the ball of concrete. "hard" replaces it by one rigid sphere of its mass and size
and writes the formulas beside it. Each row is a `breccia sweep` over seeds in out/impact/, and is kept: called again,
only what is missing is run. "print" makes the table of all finished rows, scripts/result_tables.py those of the pages from
docs/results/impact.csv. --jobs, --binary and --device are those of `breccia sweep`.
"""
import argparse
import collections
import csv
import json
import math
import pathlib
import re
import statistics
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import frames  # noqa: E402
import impact_formulas  # noqa: E402
import keyed_specimens  # noqa: E402
import published_runs  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
OUT = ROOT / "out" / "impact"

MASS, DIAMETER, THICKNESS = 14.5, 0.226, 0.1

# Concretes of the slab: as the case has it; with friction bounded under pressure; C30 of `breccia materials`, and as the library had it before its links were damped, or
# before that with a corner (docs/validation-concrete.md); links as packed, without the bulk's fabric at faces; the slab of cases/rc_slab_ldpm, and that with grains of 10 to 20 mm.
CONCRETES = {
    "case": {},
    "friction_cap": {"friction_cap": '"3 MPa"', "broken_friction": "0.6", "broken_rolling_limit": "1.0"},
    "C30": {"use": '"C30"'},
    "C30_local": {"use": '"C30"\n' + "\n".join(f"{key} = {value}" for key, value in keyed_specimens.LOCAL_C30.items())},
    "C30_corner": {"use": '"C30"\n' + "\n".join(f"{key} = {value}" for key, value in (keyed_specimens.LOCAL_C30 | {
        "young": '"33.6 GPa"', "poisson": "0.144", "tensile_strength": '"0.725 MPa"', "cohesion": '"9.078 MPa"', "criterion": '"corner"', "friction_angle": '"10 deg"', "knee_strength": "0.0", "slip_wear": "0.3",
        "fabric": '"even"'}).items())},
    "packed": {"fabric": '"packed"', "stiffness": '"estimated"'},
    "ldpm": {},
    "ldpm_fine": {"mix": '{ cement = 315.0, water_ratio = 0.5, air = 0.03, smallest = "10 mm", largest = "20 mm", fuller = 0.5 }'},
}
# Prisms of 2,000 and 1,200 elements of these concretes: docs/validation-concrete.md. LDPM: cases/rc_slab_ldpm.
STRENGTH = {"case": 32.3e6, "friction_cap": 32.3e6, "C30": 38e6, "C30_local": 38e6, "C30_corner": 38e6, "packed": 26.3e6, "ldpm": 28.9e6, "ldpm_fine": 31.5e6}


def body(text, name):
    """Where the [[body]] of this name begins and ends, comments before it included."""
    blocks = [m.start() for m in re.finditer(r"^\[\[?\w", text, re.M)] + [len(text)]
    for start, end in zip(blocks, blocks[1:]):
        if text.startswith("[[body]]", start) and f'name = "{name}"' in text[start:end]:
            return start, end
    raise SystemExit(f"no body {name}")


def variant(concrete, bars, speed=None, end=None):
    """The text of cases/rc_slab/case.toml, or cases/rc_slab_ldpm/case.toml, with another concrete, without bars, with a hard missile."""
    lattice = concrete.startswith("ldpm")
    text = (ROOT / "cases" / ("rc_slab_ldpm" if lattice else "rc_slab") / "case.toml").read_text()
    text = text[: text.index("[[check]]")].replace("ball_", "rock_")
    text = text.replace("frames = 20", "frames = 2")
    changes = CONCRETES[concrete]
    if "use" in changes:
        start = text.index("[material.c30]")
        text = text[:start] + f"[material.c30]\nuse = {changes['use']}\n\n" + text[text.index("[material.b500]"):]
    else:
        for key, value in changes.items():
            text, found = re.subn(rf"(?m)^{key} = .*$", f"{key} = {value}", text, count=1)
            if not found:
                text = text.replace("[material.c30]\n", f"[material.c30]\n{key} = {value}\n")
    if not bars:
        start, stop = body(text, "steel")
        text = text[:start] + text[stop:]
        text = text.replace("count = 79211", "range = 1.443")
    if speed is not None:
        start, stop = body(text, "impactor")
        volume = 4 / 3 * math.pi * (DIAMETER / 2) ** 3
        text = text[:start] + (
            '[[body]]\nname = "impactor"\nshape = "element"\nmaterial = "missile"\n'
            f"center = [0.0, 0.0, {0.182 if lattice else 0.164}]\nradius = {DIAMETER / 2}\nvelocity = [0.0, 0.0, {-speed}]\n\n") + text[stop:]
        text = text.replace("[material.b500]", '[material.missile]\nlaw = "grain"\n'
                            f'density = {MASS / volume}\nyoung = "200 GPa"\npoisson = 0.3\n\n[material.b500]')
        text = text.replace("[[probe]]", '[[probe]]\nname = "rock_place"\non = "impactor"\nquantity = "position_z"\n'
                            'reduce = "mean"\n\n[[probe]]', 1)
        text = text.replace("count = 79211", "range = 1.443")
    if end:
        text = re.sub(r'end = "8 ms"', f'end = "{end} ms"', text)
    return text


def ball_at(text, speed):
    start, stop = body(text, "impactor")
    return text[:start] + re.sub(r"(?m)^velocity = .*$", f"velocity = [0.0, 0.0, {-speed}]", text[start:stop]) + text[stop:]


def name_of(kind, concrete, bars, speed=None):
    return f"{kind}-{concrete}-{'bars' if bars else 'plain'}" + (f"-{speed:g}" if speed else "")


def sweep(name, text, seeds, jobs, binary, device):
    OUT.mkdir(parents=True, exist_ok=True)
    case = OUT / f"{name}.toml"
    if not case.exists() or case.read_text() != text:
        case.write_text(text)
    done = subprocess.run([binary, "sweep", case, "--seeds", str(seeds), "-o", OUT / name, "--jobs", str(jobs),
                           "--threads", "1", "--device", device], stdout=subprocess.DEVNULL)
    print(name, "exit code", done.returncode, flush=True)


def runs_of(name):
    """Folders of the runs of a row that are done."""
    with open(OUT / name / "sweep.csv") as file:
        return [pathlib.Path(row["folder"]) for row in csv.DictReader(file) if row["status"] == "done"]


def history(folder):
    with open(folder / "history.csv") as file:
        return list(csv.DictReader(file))[1:]


def blocks(folder):
    """Pieces of five elements and more, without the largest one."""
    with open(folder / "fragments.csv") as file:
        return sum(1 for row in list(csv.DictReader(file))[2:] if int(row["elements"]) >= 5)


def holes(folder):
    """Diameters of the circles as large as what the slab lost of its struck and of its far face, m: elements of the
    outermost 15 mm that unbroken links no longer tie to its largest piece."""
    start, end, links = frames.first(folder), frames.last(folder), frames.last(folder, "links")
    height = {i: p[2] for i, p in zip(start["id"], start["points"])}
    root = list(range(len(end["id"])))

    def top(k):
        while root[k] != k:
            root[k] = root[root[k]]
            k = root[k]
        return k

    ends = links["connectivity"]
    for k, state in enumerate(links["state"]):
        if state < 2:
            root[top(int(ends[2 * k]))] = top(int(ends[2 * k + 1]))
    slab = [k for k, g in enumerate(end["group"]) if g == 0]
    count = collections.Counter(top(k) for k in slab)
    largest = count.most_common(1)[0][0]
    result = []
    for sense in (1, -1):
        face = [k for k in slab if sense * height[end["id"][k]] > THICKNESS / 2 - 0.015]
        lost = sum(1 for k in face if top(k) != largest)
        result.append(2 * math.sqrt(lost / len(face) / math.pi))
    return result


def mean(values, digits):
    values = [float(v) for v in values]
    spread = statistics.stdev(values) if len(values) > 1 else 0.0
    return f"{statistics.mean(values):,.{digits}f} +- {spread:,.{digits}f}"


def velocity(folder):
    return float(history(folder)[-1]["rock_velocity"])


def force(folder):
    return max(float(r["rock_force"]) for r in history(folder)) * 1e-3


def slowing(folder):
    """Of the last millisecond, m/s."""
    rows = history(folder)
    t = float(rows[-1]["time"])
    before = next(r for r in rows if float(r["time"]) >= t - 1e-3)
    return float(rows[-1]["rock_velocity"]) - float(before["rock_velocity"])


def depth(folder):
    """How far the tip went below the struck face, mm."""
    return 1e3 * (THICKNESS / 2 + DIAMETER / 2 - min(float(r["rock_place"]) for r in history(folder)))


def broken(folder):
    return json.loads((folder / "summary.json").read_text())["fracture"]["broken_links"]


def pieces(folder):
    return json.loads((folder / "summary.json").read_text())["fracture"]["fragments"]


MEASURES = {"velocity": velocity, "slowing": slowing, "depth": depth, "force": force, "broken": broken, "pieces": pieces, "blocks": blocks}
RECORD = ["kind", "concrete", "bars", "speed", "end", "seed", "commit", "device", "hash", "quantity", "value"]


def collected():
    """A line for each quantity of each run of a finished row: {column of RECORD: value}."""
    for case in sorted(OUT.glob("*.toml")):
        if not (OUT / case.stem / "sweep.csv").exists():
            continue
        kind, concrete, bars, speed = case.stem.split("-")
        end = float(re.search(r'(?m)^end = "([\d.]+) ms"', case.read_text())[1])
        for folder in runs_of(case.stem):
            summary = json.loads((folder / "summary.json").read_text())
            of = {"kind": kind, "concrete": concrete, "bars": bars, "speed": speed, "end": end,
                  "seed": summary["case"]["seed"], "commit": summary["breccia"]["commit"], "device": summary["machine"]["device"],
                  "hash": summary["state_hash"]}
            values = {name: measure(folder) for name, measure in MEASURES.items() if kind == "hard" or name not in ("slowing", "depth")}
            if kind == "hard":
                values["lost_struck"], values["lost_far"] = holes(folder)
            for quantity, value in values.items():
                yield {**of, "quantity": quantity, "value": f"{value:.9g}"}


def rows_of(records, kind):
    """{(concrete, bars, speed, end): {quantity: values}}, in the order of the tables."""
    rows = {}
    for one in records:
        if one["kind"] == kind:
            key = one["concrete"], one["bars"] == "bars", float(one["speed"]), float(one["end"])
            rows.setdefault(key, {}).setdefault(one["quantity"], []).append(float(one["value"]))
    order = list(CONCRETES)
    return sorted(rows.items(), key=lambda row: (order.index(row[0][0]), not row[0][1], row[0][2]))


def table_of_ball(records):
    lines = ["| concrete | bars | speed, m/s | n | ball after 8 ms, m/s | largest force, kN | broken links | pieces | of 5 elements and more |",
             "|---|---|---|---|---|---|---|---|---|"]
    for (concrete, bars, speed, _), found in rows_of(records, "ball"):
        lines.append(f"| {concrete} | {'yes' if bars else 'no'} | {speed:g} | {len(found['velocity'])} | " + " | ".join(
            mean(found[quantity], digits)
            for quantity, digits in (("velocity", 2), ("force", 0), ("broken", 0), ("pieces", 0), ("blocks", 0))) + " |")
    return "\n".join(lines)


def table_of_hard(records):
    lines = ["| concrete, bars | m/s | n | velocity at the end, m/s | slowing, m/s each ms | tip below the face, mm (NDRC: depth) | "
             "largest force, kN | lost of the struck, the far face, mm | left by CEA-EDF, NDRC, m/s |", "|---|---|---|---|---|---|---|---|---|"]
    percent = 100 * 7 * math.pi / 4 * 0.008**2 / THICKNESS
    for (concrete, bars, speed, end), found in rows_of(records, "hard"):
        f_c = STRENGTH[concrete]
        x = impact_formulas.ndrc_depth(DIAMETER, MASS, f_c, speed, 1.0)[0] * DIAMETER
        through = impact_formulas.speed_for(THICKNESS, DIAMETER, MASS, f_c, 1.0, impact_formulas.perforated)
        cea = impact_formulas.cea_edf(DIAMETER, THICKNESS, MASS, f_c, 2400, percent if bars else 0.0)
        left = lambda limit: f"{math.sqrt(max(0.0, speed**2 - limit**2)):.0f}"  # noqa: E731
        lost = [mean([1e3 * v for v in found[q]], 0) for q in ("lost_struck", "lost_far")]
        lines.append(f"| {concrete}, {'yes' if bars else 'no'} | {speed:g} | {len(found['velocity'])} | {mean(found['velocity'], 1)} | "
                     f"{mean(found['slowing'], 2)} | {mean(found['depth'], 0)} ({1e3 * x:.0f}) | {mean(found['force'], 0)} | "
                     f"{'; '.join(lost)} | {left(cea)}; {left(through)} |")
    return "\n".join(lines)


def plot(record, picture):
    """Mean and deviation of the ball's velocity, of its largest force and of broken links over speed, with bars and without."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    with open(record, newline="") as file:
        rows = [row for row in rows_of(csv.DictReader(file), "ball") if row[0][0] == "case"]
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.4))
    for a, (quantity, words) in zip(axes, (("velocity", "ball after 8 ms, m/s"), ("force", "largest force, kN"), ("broken", "broken links"))):
        for bars, color in ((True, "tab:blue"), (False, "tab:red")):
            of = [(key[2], found[quantity]) for key, found in rows if key[1] == bars]
            a.errorbar([v for v, _ in of], [statistics.mean(x) for _, x in of], [statistics.stdev(x) for _, x in of],
                       marker="o", ms=4, capsize=3, color=color, label="with bars" if bars else "without")
        a.set(xlabel="speed of the ball, m/s", ylabel=words)
        a.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(picture, dpi=100)


TABLES = {"ball": table_of_ball, "hard": table_of_hard}


def main():
    p = argparse.ArgumentParser()
    p.add_argument("what", choices=["ball", "hard", "print", "record", "plot"])
    p.add_argument("table", nargs="?", choices=["ball", "hard"])
    p.add_argument("--seeds", type=int)
    p.add_argument("--speeds", help="m/s; default: 30 for the ball, 20,30,45,60 for the hard missile")
    p.add_argument("--end", type=float, default=8)
    p.add_argument("--concrete", default="case")
    p.add_argument("--bars", default="yes,no")
    p.add_argument("--jobs", type=int, default=2)
    p.add_argument("--binary", default=ROOT / "build/release/breccia")
    p.add_argument("--device", default="cpu")
    p.add_argument("--record", default=ROOT / "docs/results/impact.csv", help="of record and plot: the file")
    given = p.parse_args()
    if given.what == "print":
        print(TABLES[given.table](collected()))
        return
    if given.what == "plot":
        plot(given.record, ROOT / "cases/rc_slab/sweep.png")
        return
    if given.what == "record":
        published_runs.merge_record(pathlib.Path(given.record), RECORD, list(collected()), RECORD[:6])
        return
    given.speeds = given.speeds or ("30" if given.what == "ball" else "20,30,45,60")
    how = given.jobs, given.binary, given.device
    for concrete in given.concrete.split(","):
        for bars in (b == "yes" for b in given.bars.split(",")):
            if given.what == "ball":
                for speed in map(float, given.speeds.split(",")):
                    sweep(name_of("ball", concrete, bars, speed), ball_at(variant(concrete, bars), speed), given.seeds or 10, *how)
            elif given.what == "hard":
                for speed in map(float, given.speeds.split(",")):
                    sweep(name_of("hard", concrete, bars, speed), variant(concrete, bars, speed, given.end),
                          given.seeds or 5, *how)


if __name__ == "__main__":
    main()
