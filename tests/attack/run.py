#!/usr/bin/env python3
"""All attacks, one table. `--quick`: a minute, for each change; else for a night (--hours)."""

import argparse
import concurrent.futures
import os
import subprocess
import sys

from common import COLUMNS, HERE

QUICK = {  # some 5 to 15 s each
    "files.py": ["--runs", "250"],
    "parsers.py": ["--seconds", "7"],
    "kills.py": ["--runs", "4", "--seconds", "18"],
    "faults.py": ["--every", "199", "--seconds", "12"],
    "power_cut.py": ["--runs", "8", "--seconds", "6"],
    "cases.py": ["--runs", "15", "--seconds", "16"],
    "commands.py": [],
}
WHOLE = {  # and the share of the night
    "files.py": (["--runs", "50000"], 0.1),
    "parsers.py": ([], 0.25),
    "kills.py": (["--runs", "2000"], 0.25),
    "faults.py": ([], 0.25),
    "power_cut.py": (["--runs", "1000"], 0.05),
    "cases.py": (["--runs", "5000"], 0.1),
    "commands.py": ([], 0.0),
}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--hours", type=float, default=8)
    parser.add_argument("--seed", default="1")
    parser.add_argument("--jobs", type=int, default=1, help="attacks beside each other, each for as much longer")
    parser.add_argument("only", nargs="*", help="files of attacks; default: all")
    options = parser.parse_args()
    print(COLUMNS.format("attack", "runs", "findings", "of", "time"), flush=True)
    names = options.only or list(QUICK)
    beside = max(1, min(options.jobs, len(names)))

    def attack(name):
        words = QUICK[name]
        if not options.quick:
            words, share = WHOLE[name]
            words = words + ["--seconds", str(min(1, share * beside) * options.hours * 3600)]
        return subprocess.run([sys.executable, os.path.join(HERE, name), *words, "--seed", options.seed]).returncode

    with concurrent.futures.ThreadPoolExecutor(beside) as pool:
        result = any(list(pool.map(attack, names)))
    return 1 if result else 0


if __name__ == "__main__":
    sys.exit(main())
