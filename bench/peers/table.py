"""One table of Breccia and the peers that run the slab on their own, without being paced: MUSEN and DEM-Engine.

Two scenes, for each program a run of windows of whole steps with no output:
  at rest   the rock stands still, no link breaks: every link is computed in every step
  impact    the rock hits at 30 m/s and links break; the first window, which counts for nothing, reaches it
Times are medians over all windows of all repeats, with the least and the most.
"""
import json
import pathlib
import statistics
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
SCENES = {"at rest": ["--still", "--whole"], "impact": []}
STEPS = {"at rest": {"gpu": 2000, "cpu": 40}, "impact": {"gpu": 1000, "cpu": 200}}  # of a window
HEAD = f"{'program':30} {'scene':14} {'elements':>9} {'links':>9} {'left':>9} {'steps':>7} {'us a step (least to most)':>30} {'link-steps/s':>13}"


def row(run):
    """One line of the table."""
    times = run["us_a_step"]
    middle = statistics.median(times)
    return (f"{run['program']:30} {run['scene']:14} {run['elements']:9} {run['links']:9} {run['links_at_end']:9} {run['steps']:7} "
            f"{f'{middle:.1f} ({min(times):.1f} to {max(times):.1f})':>30} {run['links'] / middle * 1e6:13.3g}")


def last_json(command):
    """Runs a program whose last line is JSON."""
    done = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    if done.returncode != 0 or not lines:
        print(f"{command[0]} ended with {done.returncode}:\n" + done.stdout[-2500:], file=sys.stderr)
        return None
    return json.loads(lines[-1])


def breccia_at_rest(program, device, scratch):
    """The case of the slab with a ball that stands still. No link breaks, so a check of the case fails."""
    folder = scratch / "still"
    subprocess.run([program, "run", HERE.parent.parent / "cases/rc_slab/case.toml", "--device", device, "--set", "body.impactor.velocity=[0,0,0]",
                    "--set", "output.frames=0", "--force", "-q", "--no-progress", "-o", folder], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    run = json.loads((folder / "summary.json").read_text())
    step = run["wall_s"]["loop"] / run["steps"] * 1e6
    links = run["model"]["links"]
    return {"program": f"Breccia, {device}", "scene": "at rest", "elements": run["model"]["elements"], "links": links, "links_at_end": links,
            "steps": run["steps"], "us_a_step": [step]}


def breccia(program, device, scratch):
    """Breccia at rest, and its own benchmark during the impact."""
    yield breccia_at_rest(program, device, scratch)
    file = scratch / "breccia.json"
    subprocess.run([program, "bench", "slab", "--device", device, "--json", file], check=True, stdout=subprocess.DEVNULL)
    measured = json.loads(file.read_text())["benchmarks"]["slab"]

    def value(part, name):
        return round(measured[part][name]["value"])

    links = value("scene", "links")
    part = "during impact"
    step = measured[part]["step"]
    yield {"program": f"Breccia, {device}", "scene": "impact", "elements": value("scene", "elements"), "links": links,
               "links_at_end": links - value(part, "links_broken"), "steps": value(part, "steps"),
               "us_a_step": [step["min"], step["value"], step["max"]]}


def commands(given, folder, scene):
    """A call of each program that runs a scene."""
    words = [*SCENES[scene], "--copies", given.copies]
    steps = {device: max(40, count // given.copies) for device, count in STEPS[scene].items()}
    if given.musen:
        for device in given.musen_devices.split(","):
            yield [sys.executable, HERE / "musen_slab.py", given.musen, folder, "--device", device, "--threads", given.threads,
                   "--steps", steps[device], *words]
    if given.dem_engine:
        yield [given.dem_engine, folder, "--steps", steps["gpu"], *words]
        if scene == "at rest":
            yield [given.dem_engine, folder, "--steps", steps["gpu"], "--contacts", *words]


def measure(given, folder, scratch):
    """Runs all, round by round until `given.repeat` of each are done or the time is over. @returns the rows"""
    end = time.perf_counter() + given.limit
    rows = {}
    print(HEAD, flush=True)
    if given.breccia != "none" and given.copies == 1:
        for run in breccia(given.breccia, given.device, scratch):
            rows[run["program"], run["scene"]] = run
            print(row(run), flush=True)
    for _ in range(given.repeat):
        for scene in SCENES:
            for command in commands(given, folder, scene):
                run = last_json(command) if time.perf_counter() < end else None
                if run is None:
                    continue
                run["scene"] = scene
                known = rows.setdefault((run["program"], scene), run)
                if known is not run:
                    known["us_a_step"] += run["us_a_step"]
                    known["steps"] += run["steps"]
                print(row(run), flush=True)
    print("\nall repeats together\n" + HEAD)
    for run in rows.values():
        print(row(run))
    return list(rows.values())
