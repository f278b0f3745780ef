#!/usr/bin/env python3
"""Weak and strong scaling over MPI ranks: a table of times, efficiency, waiting, copies and memory.

Usage: scale_bench.py weak_slabs|weak_plate|strong_slabs|strong_plate... [--ranks 1,2,4,8,16] [--device cuda] [--threads N]
                      [--elements N] [--window-steps N] [--repeat N] [--json FILE] [--breccia PROGRAM] [--mpirun PROGRAM] [--apart]
Each line is `mpirun -n R breccia bench NAME`. A step is the median of seven windows (least to most); with --repeat the rank counts
take turns, and the run of the least median counts. Efficiency is t(1)/t(R) for weak, t(1)/(R t(R)) for strong benchmarks; the first
rank count of the list stands for one. Waited and memory are of the idlest, on average, and of the busiest rank. A strong benchmark
must end with the same hash on any number of ranks, and any benchmark with the same one when repeated.
With --apart R programs of one rank run side by side and know nothing of each other: their efficiency is what processors, caches and
memory of the machine leave of R times one, and no job of R ranks can be better than that.
"""
import argparse
import concurrent.futures
import json
import os
import statistics
import subprocess
import sys
import tempfile


def measure(options, name, ranks, file):
    command = [options.breccia, "bench", name, "--device", options.device, "--json", file]
    if options.threads:
        command += ["--threads", str(options.threads)]
    if options.elements:
        command += ["--elements", str(options.elements)]
    if options.window_steps:
        command += ["--window-steps", str(options.window_steps)]
    if ranks > 1:
        command = [options.mpirun, "-n", str(ranks)] + command
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                       OMPI_MCA_rmaps_base_oversubscribe="1")
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
    with open(file) as text:
        return json.load(text)["benchmarks"][name]


def apart(options, name, count, folder):
    """Median steps of programs that run side by side, ascending.  [us]"""
    files = [os.path.join(folder, f"apart{i}.json") for i in range(count)]
    with concurrent.futures.ThreadPoolExecutor(count) as programs:
        results = programs.map(lambda file: measure(options, name, 1, file), files)
        return sorted(result["steps"]["step"]["value"] for result in results)


def apart_table(options, name, folder, kept):
    print(f"\n{name}, programs side by side, {os.cpu_count()} processors")
    print("programs   us a step: least   median     most  efficiency")
    counts = [int(text) for text in options.ranks.split(",")]
    best = {}
    for _ in range(options.repeat):
        for count in counts:
            steps = apart(options, name, count, folder)
            kept.append({"benchmark": name, "programs": count, "steps": steps})
            if count not in best or statistics.median(steps) < statistics.median(best[count]):
                best[count] = steps
    for count in counts:
        middle = statistics.median(best[count])
        print(f"{count:8d} {best[count][0]:18.1f} {middle:8.1f} {best[count][-1]:8.1f}"
              f" {statistics.median(best[counts[0]]) / middle:11.0%}", flush=True)


def value(entry, which="value"):
    return entry[which] if entry else 0.0


def line(name, ranks, result, first):
    step = result["steps"]["step"]
    rank_facts = result.get("ranks", {})
    waited = rank_facts.get("waited")
    memory = result["memory of a rank"]
    held = memory.get("device", memory["peak_resident"])
    gain = first["step"] / step["value"]
    efficiency = gain if name.startswith("weak") else gain * first["ranks"] / ranks
    shares = "".join(f"{value(waited, which):6.0%}" for which in ("min", "value", "max"))
    sizes = "".join(f"{held[which]:7.2f}" for which in ("min", "value", "max"))
    spread = f"{step['value']:.1f} ({step['min']:.1f} to {step['max']:.1f})"
    return (f"{ranks:5d} {result['scene']['elements']['value']:10.0f} {spread:>32} {efficiency:11.0%}      {shares}"
            f" {value(rank_facts.get('copies')):7.1%} {value(rank_facts.get('imbalance')):10.1%} {value(rank_facts.get('sharings')):9.0f}"
            f"    {sizes} {result['scene']['setup']['value']:8.1f}  {result['state']['hash']}")


def table(options, name, folder, kept):
    print(f"\n{name}, {options.device}, {os.cpu_count()} processors")
    print("ranks   elements        us a step (least to most)  efficiency waited: least mean most  copies  imbalance  sharings"
          "  GB a rank: least mean most  setup s  hash")
    counts = [int(text) for text in options.ranks.split(",")]
    best, hashes = {}, {}
    for _ in range(options.repeat):
        for ranks in counts:
            result = measure(options, name, ranks, os.path.join(folder, "bench.json"))
            kept.append({"benchmark": name, "ranks": ranks, "device": options.device, "result": result})
            if ranks not in best or result["steps"]["step"]["value"] < best[ranks]["steps"]["step"]["value"]:
                best[ranks] = result
            case = ranks if name.startswith("weak") else "all"
            if hashes.setdefault(case, result["state"]["hash"]) != result["state"]["hash"]:
                sys.exit(f"{name} on {ranks} ranks: hash {result['state']['hash']}, before {hashes[case]}")
            if options.repeat == 1:
                show(name, ranks, best, counts)
    if options.repeat > 1:
        for ranks in counts:
            show(name, ranks, best, counts)


def show(name, ranks, best, counts):
    first = {"ranks": counts[0], "step": best[counts[0]]["steps"]["step"]["value"]}
    print(line(name, ranks, best[ranks], first), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="+")
    parser.add_argument("--ranks", default="1,2,4,8,16")
    parser.add_argument("--device", default="cpu")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--elements", type=int)
    parser.add_argument("--window-steps", type=int)
    parser.add_argument("--repeat", type=int, default=1)
    parser.add_argument("--json")
    parser.add_argument("--breccia", default="build/release/breccia")
    parser.add_argument("--mpirun", default="mpirun")
    parser.add_argument("--apart", action="store_true")
    options = parser.parse_args()
    kept = []
    with tempfile.TemporaryDirectory() as folder:
        for name in options.names:
            (apart_table if options.apart else table)(options, name, folder, kept)
    if options.json:
        with open(options.json, "w") as file:
            json.dump(kept, file, indent=1)


if __name__ == "__main__":
    main()
