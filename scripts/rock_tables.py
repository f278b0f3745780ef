#!/usr/bin/env python3
"""Runs the tables of docs/validation-rock.md over meshes and seeds and prints them as markdown.

    scripts/rock_tables.py --binary build/release/breccia --out DIR --jobs 2 [NAME...]
    scripts/rock_tables.py --list

Three stages, for a machine without gmsh: --prepare DIR builds the models, --run DIR runs those that have not
run yet (pass DIR to another machine in between), --table DIR prints; with --record CSV it also writes what scripts/result_tables.py
makes the page from. Without a stage: all three. A seed moves the inner vertices (jitter) and changes the edges by 2 %, so that each mesh
is another one.
"""

import argparse
import concurrent.futures
import csv
import json
import math
import pathlib
import statistics
import subprocess
import sys
import time
import tomllib

from crack_networks import ends, network_from, networks

ROOT = pathlib.Path(__file__).resolve().parent.parent
CASES, MATERIALS = ROOT / "cases", ROOT / "src/io/case/materials.toml"
SEEDS = (1, 2, 3)
RECORD = ["table", "setting", "run", "commit", "device", "hash", "seconds"]


# ---------------------------------------------------------------- what a run left

class Result:
    """The files of a finished run."""

    def __init__(self, folder):
        self.folder = folder
        self.summary = json.loads((folder / "summary.json").read_text())

    def value(self, path):
        found = self.summary
        for key in path.split("."):
            found = found[key]
        return float(found)

    def rows(self, name):
        """Rows of history.csv or cracks.csv as numbers; the second line holds units."""
        with open(self.folder / name, newline="") as file:
            rows = list(csv.DictReader(file))[1:]
        return [{key: float(value) for key, value in row.items() if key != "stage"} for row in rows]

    def cracks(self):
        """Broken joints with their ends at the start, by time."""
        return sorted(self.rows("cracks.csv"), key=lambda c: c["time"])

    def strongest(self, probe):
        ends = self.summary["probe"][probe]
        return max(abs(ends["min"]), abs(ends["max"]))


def tension(r, setting):
    width, strength, energy = 0.05, 3e6, 10.0
    return {
        "strength / f_t": r.strongest("force") / (strength * width),
        "fracture energy / (G_I A)": r.value("energy.fracture") / (energy * width),
        "of it in broken joints": sum(c["energy"] for c in r.cracks()) / r.value("energy.fracture"),
        "ledger error": r.value("energy.error_relative"),
    }


CRACK_ENERGY, CRACK_START = 6.0, -0.015  # of cases/crack_growth: G_I, and where its notch ends


def front_energy(r):
    """Growth of the crack with the fracture energy at the moment, each time that its tip moves on; and its growth at last."""
    history, front, reached = r.rows("history.csv"), [], CRACK_START
    for c in r.cracks():
        if (x := max(c["x0"], c["x1"])) > reached:
            reached = x
            front.append((x - CRACK_START, next(row["fracture"] for row in history if row["time"] >= c["time"])))
    return front, reached - CRACK_START


def slope(r):
    """Fracture energy over growth while the crack runs from 5 to 35 mm ahead of its notch, least squares, J/m2."""
    front, growth = front_energy(r)
    return statistics.linear_regression(*zip(*[(x, f) for x, f in front if 5e-3 < x < 35e-3])).slope, growth


def crack(r, setting):
    """The slope of fracture energy over growth, least squares from 5 to 35 mm ahead of the notch, is the energy of the crack with the
    rock that softens beside it; the zone that softens ahead moves along and does not count."""
    energy, growth = slope(r)
    return {
        "fracture energy of growth / (G_I A)": energy / CRACK_ENERGY,
        "length of the path / growth": sum(math.dist(*ends(c)) for c in r.cracks()) / growth,
        "grown, mm": 1e3 * growth,
        "largest force, kN/m": 1e-3 * r.strongest("force"),
        "ledger error": r.value("energy.error_relative"),
    }


def energy(r, setting):
    """What a crack through a rock of the library takes, over what its joints ask for."""
    shown, growth = slope(r)
    return {
        "shown, J/m2": shown,
        "over G_I": shown / setting["G_I, J/m2"],
        "grown, mm": 1e3 * growth,
        "ledger error": r.value("energy.error_relative"),
    }


def disc(r, setting):
    strength, diameter, half = 5e6, 0.04, math.radians(10.0)
    load = r.strongest("force_top")
    unit = 2.0 * load / (math.pi * diameter) / strength
    history = r.rows("history.csv")
    peak = max(history, key=lambda row: row["force_top"])
    first = r.cracks()[:1]
    return {
        "2P/(pi D f_t)": unit,
        "over Hondros": unit * (math.sin(2.0 * half) / half - 1.0),
        "first break at abs(y)/R": abs(0.5 * (first[0]["y0"] + first[0]["y1"])) / 0.02 if first else math.nan,
        "kinetic / work at the peak": peak["kinetic"] / peak["work"],
        "jaws out of balance": abs(peak["force_top"] + peak["force_bottom"]) / peak["force_top"],
        "ledger error": r.value("energy.error_relative"),
    }


def kalthoff(r, setting):
    tip = (0.05, 0.025)
    crack = [c for c in network_from(r.cracks(), tip, 2.5e-3 + setting["edge"]) if c["y"] > 0.02]
    if not crack:
        return {"angle": math.nan}
    far, when = max(((e, c["time"]) for c in crack for e in ends(c)), key=lambda ec: math.dist(ec[0], tip))
    start = crack[0]["time"]
    early = max((e for c in crack for e in ends(c) if math.dist(e, tip) < 0.04), key=lambda e: math.dist(e, tip))
    return {
        "angle of the first 40 mm, degrees": math.degrees(math.atan2(early[1] - tip[1], early[0] - tip[0])),
        "of all, degrees": math.degrees(math.atan2(far[1] - tip[1], far[0] - tip[0])),
        "first break, us": 1e6 * start,
        "length, mm": 1e3 * math.dist(far, tip),
        "mean speed / c_R": math.dist(far, tip) / (when - start) / 2799.0,
        "ledger error": r.value("energy.error_relative"),
    }


def branching(r, setting):
    crack = network_from(r.cracks(), (0.0, 0.0), 2.0 * setting["edge"])
    if not crack:
        return {"first break, us": math.nan}
    front, reached = [], 0.0
    for c in crack:
        x = max(c["x0"], c["x1"])
        if x > reached:
            reached = x
            front.append((c["time"], x))
    window, fastest = 8e-6, 0.0
    for t0, x0 in front:
        later = [(t, x) for t, x in front if t - t0 >= window]
        if later:
            fastest = max(fastest, (later[0][1] - x0) / (later[0][0] - t0))
    # It has branched where a second crack runs at least 2.5 mm beside.
    wide = []
    for k in range(1, 50):
        inside = [c for c in crack if 1e-3 * (k - 1) <= c["x"] < 1e-3 * k]
        if inside and max(c["y"] for c in inside) - min(c["y"] for c in inside) > 2.5e-3:
            wide.append((k - 0.5, min(c["time"] for c in inside)))
    up = max((c["x1"] for c in crack if c["y"] > 2e-3), default=0.0)
    down = max((c["x1"] for c in crack if c["y"] < -2e-3), default=0.0)
    return {
        "first break, us": 1e6 * r.cracks()[0]["time"],
        "branches at x, mm": wide[0][0] if wide else math.nan,
        "and at, us": 1e6 * wide[0][1] if wide else math.nan,
        "fastest in 8 us / c_R": fastest / 2125.0,
        "upper branch to x, mm": 1e3 * up,
        "lower branch to x, mm": 1e3 * down,
        "ledger error": r.value("energy.error_relative"),
    }


def spall(r, setting):
    width = 0.012
    planes = []
    for n in networks(r.cracks()):
        ys = [e[1] for c in n for e in ends(c)]
        if max(ys) - min(ys) > 0.9 * width:
            planes.append((min(c["time"] for c in n), 300.0 - 1e3 * statistics.mean(c["x"] for c in n)))
    planes.sort()
    history = r.rows("history.csv")
    free = [row["end"] for row in history if row["time"] < 0.24e-3]
    return {
        "first plane from the end, mm": planes[0][1] if planes else math.nan,
        "at, us": 1e6 * planes[0][0] if planes else math.nan,
        "planes": float(len(planes)),
        "largest velocity of the end, m/s": max(free),
        "velocity of the last 45 mm, m/s": r.value("probe.cap.last"),
        "ledger error": r.value("energy.error_relative"),
    }


def triaxial(r, setting):
    bears = 20.0 * math.cos(math.pi / 6.0) / (1.0 - math.sin(math.pi / 6.0)) + 3.0 * setting["pressure"]
    history = r.rows("history.csv")
    peak = max(history, key=lambda row: row["force_top"])
    return {
        "sigma_1, MPa": r.strongest("force_top") / 0.03 / 1e6,
        "over Mohr-Coulomb": r.strongest("force_top") / 0.03 / 1e6 / bears,
        "kinetic / work at the peak": peak["kinetic"] / peak["work"],
        "ledger error": r.value("energy.error_relative"),
    }


def dominoes(r, setting):
    """Speed from the times at which middles have moved by 1 mm, over the second half of the row."""
    history = r.rows("history.csv")
    count = sum(1 for key in history[0] if key.startswith("x") and key[1:].isdigit())
    moved = []
    for k in range(1, count + 1):
        start = history[0][f"x{k}"]
        moved.append(next((row["time"] for row in history if row[f"x{k}"] > start + 1e-3), math.nan))
    half, last = count // 2, count - 1
    speed = (last - half) * 0.025 / (moved[last] - moved[half])
    return {
        "speed, m/s": speed,
        "over sqrt(g h)": speed / math.sqrt(9.81 * 0.05),
        "ledger error": r.value("energy.error_relative"),
    }


# ---------------------------------------------------------------- campaigns

def over_meshes(body, edges, **more):
    """A row for each length of edges, three seeds each."""
    for edge in edges:
        for seed in SEEDS:
            sets = {"seed": seed, f"body.{body}.mesh_size": edge * (1.0 + 0.02 * (seed - 2))}
            yield {"edge": edge, **more}, sets


def tension_runs():
    for setting, sets in over_meshes("square", (3e-3, 2e-3, 1e-3), mesh="free", criterion="rock"):
        yield setting, sets
    for setting, sets in over_meshes("square", (3e-3, 2e-3, 1e-3), mesh="free", criterion="edge"):
        yield setting, {**sets, "joints.criterion": "edge"}
    for edge in (2.5e-3, 1e-3):
        yield ({"edge": edge, "mesh": "aligned", "criterion": "rock"},
               {"body.square.mesh_size": edge, "body.square.structured": "true",
                "body.square.pattern": "crossed", "body.square.jitter": 0.0})


def crack_runs():
    for criterion, edges in (("rock", (3e-3, 2e-3, 1e-3)), ("edge", (3e-3, 2e-3))):
        for setting, sets in over_meshes("plate", edges, criterion=criterion):
            yield setting, {**sets, "joints.criterion": criterion}


def energy_runs():
    """Rocks of `breccia materials` in cases/crack_growth, with the edges of their plates of 600, 1,200, 2,400 and 4,800 triangles; the mouth opens as fast as their f_t / E asks for."""
    rocks = {name: of for name, of in tomllib.loads(MATERIALS.read_text()).items() if "brazilian" in of["target"]}
    for edges in ((4.4e-3, 3.1e-3, 2.2e-3), (1.55e-3,)):
        for name, rock in rocks.items():
            joint = rock["fdem2d"]["joint"]
            young, strength = (float(text.split()[0]) * {"GPa": 1e9, "MPa": 1e6}[text.split()[1]] for text in (rock["fdem2d"]["young"], joint["tension"]))
            speed = 20e-3 * strength / young / (3e6 / 30e9)
            for setting, sets in over_meshes("plate", edges):
                yield ({"rock": name, "G_I, J/m2": joint["energy_open"], **setting},
                       {**sets, "material.rock.use": name, "material.rock.damping": 0.3,
                        "support.upper.velocity": f"[0.0, {speed:.4g}]", "support.lower.velocity": f"[0.0, {-speed:.4g}]"})


def disc_runs():
    for energy, edges in ((4.0, (2e-3, 1.4e-3, 1e-3)), (1.0, (1e-3,)), (16.0, (1.4e-3,))):
        for setting, sets in over_meshes("disc", edges):
            yield ({"E G/(f_t^2 R)": round(energy * 30e9 / 25e12 / 0.02, 2), **setting},
                   {**sets, "material.rock.joint.energy_open": energy,
                    "material.rock.joint.energy_slide": 5.0 * energy})


def triaxial_runs():
    for edge in (3e-3, 2e-3, 1e-3):
        for pressure in (0.0, 10.0, 20.0):
            for setting, sets in over_meshes("rock", (edge,)):
                yield ({"pressure": pressure, **setting},
                       {**sets, "load.cell_left.pressure": 1e6 * pressure,
                        "load.cell_right.pressure": 1e6 * pressure,
                        "time.end": 1.8e-3 if pressure > 15.0 else 1.4e-3})


def dominoes_runs():
    for friction in (0.0, 0.1, 0.3):
        yield {"friction of stones": friction}, {"material.stone.friction": friction}


CAMPAIGNS = {  # name: case, runs, quantities
    "tension": ("tension_free_mesh", tension_runs, tension),
    "crack": ("crack_growth", crack_runs, crack),
    "energy": ("crack_growth", energy_runs, energy),
    "disc": ("homogeneous_disc", disc_runs, disc),
    "kalthoff": ("kalthoff", lambda: over_meshes("plate", (2e-3, 1.4e-3, 1e-3)), kalthoff),
    "branching": ("branching", lambda: over_meshes("plate", (1.25e-3, 1e-3, 0.7e-3)), branching),
    "spall": ("spall_bar", lambda: over_meshes("bar", (4e-3, 2.5e-3, 1.5e-3)), spall),
    "triaxial": ("triaxial_envelope", triaxial_runs, triaxial),
    "dominoes": ("dominoes", dominoes_runs, dominoes),
}


def plan(names, edge_at_least):
    for name in names:
        case, runs, _ = CAMPAIGNS[name]
        for number, (setting, sets) in enumerate(runs()):
            if setting.get("edge", math.inf) >= edge_at_least:
                yield {"id": f"{name}_{number:02d}", "campaign": name, "case": case, "setting": setting, "sets": sets}


# ---------------------------------------------------------------- stages

def call(command):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True)


def prepare(binary, folder, jobs):
    (folder / "models").mkdir(parents=True, exist_ok=True)

    def build(job):
        model = folder / "models" / f"{job['id']}.br"
        if model.exists():
            return
        sets = {**job["sets"], "output.frames": 1, "output.pictures": "false", "output.fields": "false"}
        done = call([binary, "prepare", CASES / job["case"] / "case.toml", "-o", model,
                     *(part for key, value in sets.items() for part in ("--set", f"{key}={value}"))])
        if done.returncode != 0:
            sys.exit(f"{job['id']}: {done.stderr}")

    with concurrent.futures.ThreadPoolExecutor(jobs["count"]) as pool:
        list(pool.map(build, jobs["plan"]))
    (folder / "plan.json").write_text(json.dumps(jobs["plan"], indent=1))


def finished(out):
    """Whether a run came to its end; a check that fails (9) stands for the case's own mesh alone."""
    if not (out / "summary.json").exists():
        return False
    summary = json.loads((out / "summary.json").read_text())
    return summary["status"] in ("done", "failed") and summary["exit_code"] in (0, 9)


def run(binary, folder, count):
    jobs = json.loads((folder / "plan.json").read_text())
    jobs.reverse()  # the longest runs stand last

    def work(job):
        out = folder / "runs" / job["id"]
        if finished(out):
            return
        begun = time.monotonic()
        done = call([binary, "run", folder / "models" / f"{job['id']}.br", "-o", out, "--force",
                     "--threads", "1", "--no-progress"])
        state = "" if finished(out) else f"exit code {done.returncode}: {done.stderr}"
        print(f"{job['id']} {time.monotonic() - begun:.1f} s {state}", file=sys.stderr, flush=True)

    with concurrent.futures.ThreadPoolExecutor(count) as pool:
        list(pool.map(work, jobs))


def cell(values):
    known = [v for v in values if not math.isnan(v)]
    if not known:
        return "-"
    short = lambda v: f"{v:.3g}" if abs(v) < 100.0 else f"{v:.0f}"
    text = short(statistics.mean(known))
    if len(known) > 1:
        text += f" +- {statistics.stdev(known):.2g}"
    return text if len(known) == len(values) else f"{text} (of {len(known)})"


def collected(folder):
    """What finished runs of a folder show: one record a run."""
    for job in json.loads((folder / "plan.json").read_text()):
        done = folder / "runs" / job["id"]
        if not finished(done):
            continue
        result = Result(done)
        summary = result.summary
        yield {"table": job["campaign"], "setting": json.dumps(job["setting"]), "run": job["id"], "commit": summary["breccia"]["commit"],
               "device": summary["machine"]["device"], "hash": summary["state_hash"], "seconds": sum(summary["stages_s"].values()),
               "values": CAMPAIGNS[job["campaign"]][2](result, job["setting"])}


def write_records(records, file):
    """One line a run and quantity, as docs/results/rock.csv."""
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(RECORD + ["quantity", "value"])
    for one in records:
        for quantity, value in one["values"].items():
            writer.writerow([f"{one[key]:.6g}" if key == "seconds" else one[key] for key in RECORD] + [quantity, f"{value:.9g}"])


def read_records(file):
    records = {}
    for row in csv.DictReader(file):
        one = records.setdefault(row["run"], {**{key: row[key] for key in RECORD}, "seconds": float(row["seconds"]), "values": {}})
        one["values"][row["quantity"]] = float(row["value"])
    return list(records.values())


def markdown(records, name):
    """The table of a campaign."""
    rows, cost = {}, 0.0
    for one in records:
        if one["table"] == name:
            rows.setdefault(one["setting"], []).append(one["values"])
            cost += one["seconds"]
    if not rows:
        return ""
    settings = [json.loads(key) for key in rows]
    heads = list(dict.fromkeys(q for found in rows.values() for one in found for q in one))
    columns = ["edges, mm" if key == "edge" else key for key in settings[0]]
    lines = [f"**{name}** (cases/{CAMPAIGNS[name][0]}; {cost:.0f} s of steps in all)", "",
             "| " + " | ".join([*columns, "n", *heads]) + " |", "|" + "---|" * (len(columns) + 1 + len(heads))]
    for setting, found in zip(settings, rows.values()):
        given = [f"{1e3 * v:g}" if key == "edge" else str(v) for key, v in setting.items()]
        values = [cell([one.get(q, math.nan) for one in found]) for q in heads]
        lines.append("| " + " | ".join([*given, str(len(found)), *values]) + " |")
    return "\n".join(lines)


def table(folder, record):
    records = list(collected(folder))
    for name in CAMPAIGNS:
        if text := markdown(records, name):
            print(f"\n{text}")
    if record:
        with open(record, "w", newline="") as file:
            write_records(records, file)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(CAMPAIGNS)}; default: all")
    parser.add_argument("--binary", default="build/release/breccia")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time, each on one thread")
    parser.add_argument("--edge-at-least", type=float, default=0.0, metavar="METRES", help="leave out finer meshes")
    parser.add_argument("--list", action="store_true", help="say which runs there are")
    parser.add_argument("--prepare", type=pathlib.Path, metavar="DIR")
    parser.add_argument("--run", type=pathlib.Path, metavar="DIR")
    parser.add_argument("--table", type=pathlib.Path, metavar="DIR")
    parser.add_argument("--record", type=pathlib.Path, metavar="CSV", help="write what each run shows, besides the tables")
    parser.add_argument("--out", type=pathlib.Path, metavar="DIR", default=pathlib.Path("out/rock_tables"))
    options = parser.parse_args()
    unknown = [name for name in options.names if name not in CAMPAIGNS]
    if unknown:
        parser.error(f"no table {', '.join(unknown)}")
    jobs = list(plan(options.names or CAMPAIGNS, options.edge_at_least))
    if options.list:
        for job in jobs:
            print(job["id"], job["case"], job["setting"], job["sets"])
        return
    every = not (options.prepare or options.run or options.table)
    if options.prepare or every:
        prepare(options.binary, options.prepare or options.out, {"plan": jobs, "count": options.jobs})
    if options.run or every:
        run(options.binary, options.run or options.out, options.jobs)
    if options.table or every:
        table(options.table or options.out, options.record)


if __name__ == "__main__":
    main()
