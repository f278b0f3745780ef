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

import rock_measures as measures

ROOT = pathlib.Path(__file__).resolve().parent.parent
CASES, MATERIALS = ROOT / "cases", ROOT / "src/io/case/materials.toml"
SEEDS = (1, 2, 3)
RECORD = ["table", "setting", "run", "commit", "device", "hash", "seconds"]


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


def shear_runs():
    """The rows of a crossed mesh lie in the crack's plane; free ones do not."""
    yield ({"edge": 2.5e-3, "mesh": "aligned"},
           {"body.strip.mesh_size": 2.5e-3, "body.strip.structured": "true", "body.strip.pattern": "crossed", "body.strip.jitter": 0.0})
    yield from over_meshes("strip", (3e-3, 2e-3, 1.4e-3), mesh="free")


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


def compression_runs():
    """Without a cell, by friction angle and by the zone in which joints slide to their end, E' G_II/c^2, over the width of 30 mm."""
    few, more = (30, 45, 60), (20, 30, 45, 60)
    for energy, edges, angles in ((250.0, (3e-3, 2e-3, 1.4e-3), more), (50.0, (3e-3,), few), (1000.0, (2e-3,), few)):
        for edge in edges:
            for degrees in angles:
                for setting, sets in over_meshes("rock", (edge,)):
                    bears = measures.mohr_coulomb(10e6, degrees)
                    softer = {} if energy == 250.0 else {"material.rock.joint.energy_slide": energy, "material.rock.joint.energy_open": 0.2 * energy}
                    yield ({"phi, degrees": degrees, "E' G_II/(c^2 W)": round(20e9 / 0.96 * energy / 1e14 / 0.03, 2), **setting},
                           {**sets, "load.cell_left.pressure": 0.0, "load.cell_right.pressure": 0.0,
                            "material.rock.joint.friction_angle": f'"{degrees} deg"', "material.rock.friction": round(math.tan(math.radians(degrees)), 5),
                            "time.end": round(0.2e-3 + (1.9 if energy > 500.0 else 1.35) * bears / 18e9 * 0.06 / 0.2, 6), **softer})


def servos_runs():
    """Rock that servos press from all sides with 10 MPa."""
    for setting, sets in over_meshes("rock", (5e-3, 3.5e-3, 2.5e-3)):
        yield setting, {**sets, "body.rock.jitter": 0.1}


def granite_runs():
    """Grains and mesh change with the seed; the paper's size, and edges of 1 mm by both criteria."""
    for edge, criterion in ((1e-3, "edge"), (1e-3, "rock"), (0.5e-3, "edge"), (0.5e-3, "rock")):
        for seed in (1, 2, 3, 4, 5):
            coarser = {"body.disc.mesh_size": edge} if edge > 0.5e-3 else {}
            shorter = {"time.end": 0.45e-3} if criterion == "rock" else {}  # splits at 0.34 ms
            yield {"edge": edge, "criterion": criterion}, {"seed": seed, "joints.criterion": criterion, **coarser, **shorter}


def dominoes_runs():
    for friction in (0.0, 0.1, 0.3):
        yield {"friction of stones": friction}, {"material.stone.friction": friction}


CAMPAIGNS = {  # name: case, runs, quantities
    "tension": ("tension_free_mesh", tension_runs, measures.tension),
    "crack": ("crack_growth", crack_runs, measures.crack),
    "shear": ("crack_growth/shear.toml", shear_runs, measures.shear),
    "energy": ("crack_growth", energy_runs, measures.energy),
    "disc": ("homogeneous_disc", disc_runs, measures.disc),
    "kalthoff": ("kalthoff", lambda: over_meshes("plate", (2e-3, 1.4e-3, 1e-3)), measures.kalthoff),
    "branching": ("branching", lambda: over_meshes("plate", (1.25e-3, 1e-3, 0.7e-3)), measures.branching),
    "spall": ("spall_bar", lambda: over_meshes("bar", (4e-3, 2.5e-3, 1.5e-3)), measures.spall),
    "triaxial": ("triaxial_envelope", triaxial_runs, measures.triaxial),
    "compression": ("triaxial_envelope", compression_runs, measures.compression),
    "servos": ("triaxial/rock.toml", servos_runs, measures.servos),
    "granite": ("brazilian_disc", granite_runs, measures.granite),
    "dominoes": ("dominoes", dominoes_runs, measures.dominoes),
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
        case = CASES / job["case"]
        done = call([binary, "prepare", case if case.suffix else case / "case.toml", "-o", model,
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
        result = measures.Result(done)
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
