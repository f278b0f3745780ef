#!/usr/bin/env python3
"""Writes the page of measured speeds from the files that `breccia bench --json` left: reference_speed.py bench/results."""
import json
import pathlib
import sys


def number(value):
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.4g}"


def main(folder):
    print("# Measured speeds\n\nWritten from `bench/results`: every number of every benchmark as it was measured, with the least and the largest of its repetitions. What they mean, and"
          " what was tried: [how fast Breccia is](../../bench/notes/README.md).\n")
    rows = 0
    for file in sorted(folder.glob("*.json")):
        of = json.loads(file.read_text())
        if not isinstance(of, dict) or "benchmarks" not in of:
            continue
        machine, made = of["machine"], of["breccia"]
        print(f"## {file.stem}\n\n{machine.get('gpu') or machine.get('cpu')}, {machine.get('device')}, {machine.get('threads')} threads; Breccia"
              f" {' '.join(filter(None, [made['version'], made.get('commit')]))}, {made['build']['compiler']}.\n\n| benchmark | of | quantity | value | least to largest | unit |\n|---|---|---|---|---|---|")
        for benchmark, scenes in of["benchmarks"].items():
            for scene, quantities in scenes.items():
                for quantity, told in quantities.items():
                    if isinstance(told, dict) and "value" in told:
                        span = "" if told["min"] == told["max"] else f"{number(told['min'])} to {number(told['max'])}"
                        print(f"| {benchmark} | {scene} | {quantity} | {number(told['value'])} | {span} | {told['unit']} |")
                        rows += 1
        print()
    return 0 if rows > 20 else 1


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
