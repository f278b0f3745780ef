#!/usr/bin/env python3
"""Tables of docs/performance.md, from bench/results and docs/results/cases.csv; written by result_tables.py.

speed_tables.py --record FILE [CASE...] runs small cases (all of cases/*/small.toml) on one thread, one after the
other, and adds a line a case to FILE: counts, steps, processor time, state hash, commit.
"""
import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
FIELDS = ("case", "method", "items", "bonds", "steps", "processor_s", "hash", "commit", "cpu")


def loaded(name):
    return json.loads((ROOT / "bench/results" / f"{name}.json").read_text())


def spread(told, digits=0):
    return f"{told['value']:,.{digits}f} ({told['min']:,.{digits}f} to {told['max']:,.{digits}f})"


def table(head, rows):
    return "\n".join(["| " + " | ".join(head) + " |", "|---" * len(head) + "|", *("| " + " | ".join(row) + " |" for row in rows)])


def yade():
    rows = []
    for name, threads in (("yade_slab", 1), ("yade_slab_two_threads", 2)):
        of = loaded(name)
        for who, words in ((f"breccia, {threads} threads", "Breccia, ns a link-step"), (f"yade, {threads} threads", "YADE, ns a link-step"),
                           (f"yade / breccia, {threads} threads", "YADE over Breccia")):
            cells = []
            for moment in ("before impact", "during impact"):
                s = of[moment][who]["spread"]
                cells.append("{median:.{d}f} ({min:.{d}f} to {max:.{d}f})".format(d=1 if "/" in who else 0, **s))
            rows.append([f"{words}, {threads} thread{'s' if threads > 1 else ''} ({of['date']})", *cells])
    return table(["", "before impact", "during impact"], rows)


def of_gpu(files, item, bond, rate):
    """Whole steps, by size: `rate` of the two is counted in steps of it a second."""
    rows = []
    for name, benchmark, scene in files:
        of = loaded(name)
        for title, told in sorted(of["benchmarks"][benchmark].items(), key=lambda pair: pair[1].get(item, {"value": 0})["value"]):
            if scene not in title:
                continue
            count = told[item]["value"], told[bond]["value"]
            memory = told.get("peak_arrays_per_element") or told.get("device_memory_per_element")  # with the context, until November 2026
            rows.append([title, f"{count[0]:,.0f}", f"{count[1]:,.0f}", spread(told["step"]),
                         f"{(count[0] if rate == item else count[1]) / told['step']['value'] / 1e3:.2g}",
                         f"{memory['value'] / 1e3:.1f}" if memory and count[0] > 5e5 else "", of["breccia"].get("commit", "")])
    return table(["scene", item, bond, "us a step", f"10^9 {rate[:-1]}-steps/s", "kB an element on the GPU", "commit"], rows)


def gpu_dem():
    return of_gpu([("h200_slabs", "slabs", "slabs"), ("h200_most", "most_slabs", "slabs")], "elements", "links", "links")


def gpu_fdem():
    return of_gpu([("h200_triangles", "triangles", "plate"), ("h200_largest_plate", "largest_plate", "plate")], "triangles", "joints", "triangles")


def ranks():
    rows = []
    for name, where in (("h200_x4_weak_slabs", "H200 each"), ("h200_x4_weak_plate", "H200 each"), ("h200_x4_strong_plate", "H200 each"),
                        ("xeon_weak", "core each")):
        alone = {}
        for one in loaded(name):
            kind, count = one["benchmark"], one["ranks"]
            steps, scene = one["result"]["steps"]["step"], one["result"]["scene"]["elements"]["value"]
            alone.setdefault(kind, steps["value"])
            share = alone[kind] / steps["value"] / (count if kind.startswith("strong") else 1)
            rows.append([kind, f"{count}, {where}", f"{scene:,.0f}", spread(steps), f"{100 * share:.0f} %"])
    return table(["benchmark", "ranks", "elements or triangles in all", "us a step", "efficiency"], rows)


def cases():
    with open(ROOT / "docs/results/cases.csv", newline="") as file:
        rows = sorted(csv.DictReader(file), key=lambda row: (row["method"], row["case"]))
    made = [[f"[{row['case']}](../cases/{row['case']}/README.md)", row["method"], f"{int(row['items']):,}", f"{int(row['bonds']):,}", f"{int(row['steps']):,}",
             f"{float(row['processor_s']):.1f}"] for row in rows]
    return table(["case", "method", "elements or triangles", "links or joints", "steps", "processor time, s"], made)


TABLES = {"yade": yade, "gpu_dem": gpu_dem, "gpu_fdem": gpu_fdem, "ranks": ranks, "cases": cases}


def measured(case, program):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        before = os.times()
        done = subprocess.run([program, "run", str(case), "--threads", "1", "-q", "-o", str(out)], check=False, cwd=ROOT)
        after = os.times()
        if done.returncode != 0:
            raise SystemExit(f"{case}: exit code {done.returncode}")
        of = json.loads((out / "summary.json").read_text())
    models = [of["model"]] if "model" in of else [part["model"] for part in of.values() if isinstance(part, dict) and "model" in part]
    count = lambda kinds: sum(int(model.get(kind, 0)) for model in models for kind in kinds)
    return {"case": case.parent.name, "method": of["method"] if isinstance(of["method"], str) else "+".join(of["method"]),
            "items": count(("elements", "triangles", "tetrahedra")), "bonds": count(("links", "joints")), "steps": of["steps"],
            "processor_s": round(sum(after[2:4]) - sum(before[2:4]), 2), "hash": of["state_hash"], "commit": of["breccia"]["commit"], "cpu": of["machine"]["cpu"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--record", type=pathlib.Path, required=True)
    parser.add_argument("--program", default=str(ROOT / "build/release/breccia"))
    parser.add_argument("cases", nargs="*", type=pathlib.Path)
    options = parser.parse_args()
    kept = {}
    if options.record.exists():
        with open(options.record, newline="") as file:
            kept = {row["case"]: row for row in csv.DictReader(file)}
    for case in options.cases or sorted((ROOT / "cases").glob("*/small.toml")):
        row = measured(case.resolve(), options.program)
        kept[row["case"]] = row
        print(row["case"], row["steps"], row["processor_s"], row["hash"], flush=True)
        with open(options.record, "w", newline="") as file:
            writer = csv.DictWriter(file, FIELDS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(kept[name] for name in sorted(kept))
    return 0


if __name__ == "__main__":
    sys.exit(main())
