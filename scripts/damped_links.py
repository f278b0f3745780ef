#!/usr/bin/env python3
"""Strengths of C30 as the library had it before its links were damped (`keyed_specimens.LOCAL_C30`), with damped links, over element size, rate and local damping, for docs/theory.md.

    scripts/damped_links.py [--binary build/release/breccia] [--jobs 1] [--only TEXT] [-o out/damped_links] [--record docs/results/damping.csv]

Specimens of `breccia test` (`SETTINGS`): link_damping, link_damping_time, local damping, elements, rate over that of `breccia test`, tests, packings. Lines of --record that are
not made anew stay.
"""
import argparse
import concurrent.futures
import csv
import json
import pathlib
import statistics
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
import keyed_specimens  # noqa: E402
import published_runs  # noqa: E402

KEYS = ["damping", "time", "local", "elements", "rate", "test"]
RECORD = [*KEYS, "specimen", "commit", "hash", "quantity", "value"]
BRANCHES = ((0.3, 0.2), (0.5, 0.4), (1.0, 0.4))
BOTH = ("compression_prism", "tension")
SETTINGS = [(*branch, local, elements, rate, tests, packings) for branch in BRANCHES for local, elements, rate, tests, packings in (
    (0, 600, 1, BOTH, 4), (0, 1200, 1, (*BOTH, "tension_notched"), 4), (0, 1200, 1, ("brazilian",), 3), (0, 2400, 1, BOTH, 3), (0, 4800, 1, BOTH, 3), (0, 1200, 0.25, BOTH, 4), (0.05, 1200, 1, BOTH, 4))]
CASE = """breccia = 1
method = "dem3d"
[time]
end = 1e-3
[links]
range = 1.443
[material.c]
use = "C30"
""" + "".join(f"{key} = {value}\n" for key, value in keyed_specimens.LOCAL_C30.items()) + """[[body]]
name = "b"
material = "c"
size = [0.1, 0.1, 0.1]
pack = { count = 300, size_ratio = 2.0, compactness = 0.56 }
"""


def test(given, case, folder, setting, specimen):
    damping, time, local, elements, _, name = setting
    command = [given.binary, "test", case, "--material", "c", "--only", name, "--seeds", "1", "--first-seed", str(specimen), "--elements", str(elements), "--damping", str(local), "--jobs", "1",
               "--threads", "1", "-o", folder, "--set", f"material.c.link_damping={damping}", "--set", f"material.c.link_damping_time={time}"]
    subprocess.run(command, stdout=subprocess.DEVNULL)  # 9: off the targets
    return next((folder / "cases").glob("*.toml")), next((folder / "runs").glob("*/summary.json"))


def slowed(given, made, folder, rate):
    """The specimen of a case, loaded more slowly."""
    case = tomllib.loads(made.read_text())
    keys = [f"time.end={case['time']['end'] / rate!r}"]
    for support in case["support"]:
        keys += [f"support.{support['name']}.velocity={json.dumps([rate * v for v in support['velocity']])}", f"support.{support['name']}.ramp={support['ramp'] / rate!r}"]
    subprocess.run([given.binary, "run", made, "-o", folder, "--threads", "1", "--force", "--no-progress", *(a for key in keys for a in ("--set", key))], check=True, stdout=subprocess.DEVNULL)
    return folder / "summary.json"


def make(given, case, setting, specimen):
    folder = given.out / "-".join(str(s) for s in (*setting, specimen))
    made, summary = test(given, case, folder, setting, specimen)
    if setting[4] != 1:
        summary = slowed(given, made, folder / "slow", setting[4])
        with open(folder / "slow/history.csv", newline="") as file:
            forces = [0.5 * abs(float(row["force_bottom"]) - float(row["force_top"])) for row in list(csv.DictReader(file))[1:]]
        numbers = {"strength": max(forces) / 0.01 / 1e6}
    else:
        with open(folder / "specimens.csv", newline="") as file:
            numbers = {row["quantity"]: float(row["value"]) for row in csv.DictReader(file)}
    of = json.loads(summary.read_text())
    return [dict(zip(RECORD, (*setting, specimen, of["breccia"]["commit"], of["state_hash"], quantity, f"{numbers[quantity]:.9g}"))) for quantity in ("strength", "fracture_energy") if quantity in numbers]


def table(records):
    found = {}
    for one in records:
        key = (*(float(one[key]) for key in KEYS[:-1]), one["test"], one["quantity"])
        found.setdefault(key, []).append(float(one["value"]))

    def cell(branch, local, elements, rate, name, quantity, digits):
        values = found.get((*branch, local, elements, rate, name, quantity), [])
        return f"{statistics.mean(values):.{digits}f} +- {statistics.stdev(values):.{digits}f}" if len(values) > 1 else ""

    lines = [("600 elements", 0, 600, 1), ("1,200", 0, 1200, 1), ("2,400", 0, 2400, 1), ("4,800", 0, 4800, 1), ("1,200, a quarter of the rate", 0, 1200, 0.25), ("1,200, with local damping of 0.05", 0.05, 1200, 1)]
    titles = [f"m = {m:g}, tau c/D = {t:g}" for m, t in BRANCHES]
    out = ["| C30_local, f_c and f_t, MPa | " + " | ".join(titles) + " |", "|---" * (1 + len(titles)) + "|"]
    for words, *of in lines:
        out.append(f"| {words} | " + " | ".join(", ".join(cell(b, *of, name, "strength", digits) for name, digits in (("compression_prism", 1), ("tension", 2))) for b in BRANCHES) + " |")
    out.append("| disc of 2,400, 2P/(pi d t), MPa | " + " | ".join(cell(b, 0, 1200, 1, "brazilian", "strength", 2) for b in BRANCHES) + " |")
    out.append("| G_F of notched prisms, J/m2 | " + " | ".join(cell(b, 0, 1200, 1, "tension_notched", "fracture_energy", 0) for b in BRANCHES) + " |")
    return "\n".join(out)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("-o", "--out", type=pathlib.Path, default=ROOT / "out/damped_links")
    p.add_argument("--only", default="", help="settings that have this in their text")
    published_runs.add_options(p, device=False)
    given = p.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    case = given.out / "c30.toml"
    case.write_text(CASE)
    jobs = [((*of, name), specimen) for *of, tests, packings in SETTINGS for name in tests for specimen in range(1, packings + 1)]
    jobs = [job for job in jobs if given.only in str(job)]
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        records = [line for task in [pool.submit(make, given, case, *job) for job in jobs] for line in task.result()]
    if given.record:
        records = published_runs.merge_record(given.record, RECORD, records, (*KEYS, "specimen"))
    print(table(records))


if __name__ == "__main__":
    main()
