#!/usr/bin/env python3
"""Runs the samples of pages: check_docs.py [--program build/release/breccia] [PAGE ...]; default: docs/quickstart.md, docs/tutorials.

Blocks of a page marked sh, python, toml or cpp are run in their order, in one scratch folder for each page. A comment before a block changes that:
  <!-- check: until=1e-4 -->        runs of the block end at that simulated time  [s]
  <!-- check: file=mine.toml -->    toml: is written to this file and checked; append=FILE adds to one
  <!-- check: skip WHY -->          is not run
  <!-- check: code=9 -->            ends with this exit code
toml without file= or append= is parsed only. Exit code 1 if a sample fails.
"""
import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[1]
BLOCK = re.compile(r"(?:^<!-- check: ([^\n]*?) -->\n)?^```(sh|python|toml|cpp)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
WRAPPER = """#!/bin/sh
if [ "$1" = run ] && [ -n "$BR_UNTIL" ]; then exec {program} "$@" --no-progress --until "$BR_UNTIL"; fi
exec {program} "$@"
"""


def command_of(kind, text, options, folder, number):
    """The command that runs a block; None if there is none."""
    if kind == "sh":
        return ["bash", "-euo", "pipefail", "-c", text]
    if kind == "python":
        (folder / f"block{number}.py").write_text(text)
        return ["/usr/bin/python3", f"block{number}.py"]
    if kind == "cpp":
        (folder / f"block{number}.cpp").write_text(text)
        return ["sh", "-c", f"g++ -std=c++20 -ffp-contract=off -I {ROOT}/src block{number}.cpp -o block{number} && ./block{number}"]
    file = options.get("file") or options.get("append")
    if not file:
        tomllib.loads(text)
        return None
    with open(folder / file, "a" if "append" in options else "w") as out:
        out.write("\n" + text)
    return ["breccia", "check", file]


def run_page(page, program):
    """Numbers of samples that ran, that were skipped, and texts of what failed."""
    ran, skipped, failed = 0, 0, []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "bin").mkdir()
        wrapper = folder / "bin/breccia"
        wrapper.write_text(WRAPPER.format(program=program))
        wrapper.chmod(0o755)
        environment = {**os.environ, "PATH": f"{folder}/bin:{os.environ['PATH']}", "PYTHONPATH": str(program.parent / "python"), "GOMP_SPINCOUNT": "2000"}
        for number, match in enumerate(BLOCK.finditer(page.read_text())):
            mark, kind, text = match[1] or "", match[2], match[3]
            if mark.startswith("skip "):
                skipped += 1
                continue
            options = dict(part.split("=", 1) for part in mark.split())
            if unknown := set(options) - {"until", "file", "append", "code"}:
                failed.append(f"{page}: block {number + 1}: no mark {unknown}")
                continue
            ran += 1
            environment["BR_UNTIL"] = options.get("until", "")
            try:
                command = command_of(kind, text, options, folder, number)
                done = command and subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300)
            except (tomllib.TOMLDecodeError, subprocess.TimeoutExpired) as error:
                failed.append(f"{page}: block {number + 1} ({kind}): {error}")
                continue
            if done and done.returncode != int(options.get("code", 0)):
                failed.append(f"{page}: block {number + 1} ({kind}) ended with {done.returncode}\n{text}{done.stdout[-1500:]}{done.stderr[-1500:]}")
    return ran, skipped, failed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/breccia")
    parser.add_argument("pages", nargs="*", type=pathlib.Path)
    arguments = parser.parse_args()
    pages = arguments.pages or [ROOT / "docs/quickstart.md", *sorted((ROOT / "docs/tutorials").glob("*.md"))]
    total, left, problems = 0, 0, []
    for page in pages:
        begin = time.monotonic()
        ran, skipped, failed = run_page(page, arguments.program.resolve())
        total, left, problems = total + ran, left + skipped, problems + failed
        print(f"{page.name:20} {ran:3} run {skipped:3} skipped {len(failed):3} failed  {time.monotonic() - begin:5.1f} s", flush=True)
    print(f"{total} samples run, {left} skipped, {len(problems)} failed")
    print("\n\n".join(problems))
    return 1 if problems or not total else 0


if __name__ == "__main__":
    sys.exit(main())
