#!/usr/bin/env python3
"""How a case scales over MPI ranks: a table of speed-up, communication, imbalance and migration.

Usage: scale_ranks.py CASE [--ranks 1,2,4,8,16,32] [--steps N] [--threads N] [--breccia PROGRAM] [--mpirun PROGRAM]
                      [--set KEY=VALUE]...
Speed-up counts the wall time of the steps alone, without set-up and output. Communication is the share of rank 0's stages in which
ranks hear from each other; waited is the share that ranks wait, of the busiest, on average, and of the idlest. Every line must
show the same hash.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

WAITING = ("halo", "travel", "time_step")  # stages in which ranks hear from each other


def measure(options, ranks, folder):
    command = [options.breccia, "run", options.case, "-o", folder, "--force", "-q", "--steps", str(options.steps),
               "--threads", str(options.threads), "--no-progress",
               "--set", "output.frames=0", "--set", "output.history=1e9", "--set", "checkpoint.wall=1e9"]
    for text in options.set:
        command += ["--set", text]
    if ranks > 1:
        command = [options.mpirun, "-n", str(ranks)] + command
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                       OMPI_MCA_rmaps_base_oversubscribe="1")
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
    with open(os.path.join(folder, "summary.json")) as file:
        return json.load(file)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case")
    parser.add_argument("--ranks", default="1,2,4,8,16,32")
    parser.add_argument("--steps", type=int, default=500)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--breccia", default="build/release/breccia")
    parser.add_argument("--mpirun", default="mpirun")
    parser.add_argument("--set", action="append", default=[])
    options = parser.parse_args()
    print(f"{options.case}, {options.steps} steps, {options.threads} threads a rank, {os.cpu_count()} processors")
    print("ranks    loop s   speed-up  efficiency  communication  waited: least  mean  most  migration  imbalance  copies  sharings  hash")
    first = hashes = None
    with tempfile.TemporaryDirectory() as folder:
        for ranks in map(int, options.ranks.split(",")):
            s = measure(options, ranks, folder)
            loop, stages, domain = s["wall_s"]["loop"], s["stages_s"], s.get("domain", {})
            first = first or loop * ranks
            hashes = hashes or s["state_hash"]
            waiting = sum(stages.get(name, 0.0) for name in WAITING) if ranks > 1 else 0.0
            waited = domain.get("waited_s", {})
            shares = "".join(f"{waited.get(which, 0.0) / loop:6.0%}" for which in ("least", "mean", "most"))
            print(f"{ranks:5d} {loop:9.2f} {first / loop:10.2f} {first / loop / ranks:10.0%}"
                  f" {waiting / loop:13.0%}        {shares} {stages.get('migration', 0.0) / loop:10.1%}"
                  f" {domain.get('imbalance', 0.0):10.1%} {domain.get('copies', 0.0):7.1%}"
                  f" {domain.get('sharings', 0):9.0f}  {s['state_hash']}", flush=True)
            if s["state_hash"] != hashes:
                sys.exit("the hash depends on the number of ranks")


if __name__ == "__main__":
    main()
