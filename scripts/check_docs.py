#!/usr/bin/env python3
"""Runs the samples of pages: check_docs.py [--program build/release/breccia] [PAGE ...]; default: every page of the repository.

Every block between fences names its language: sh, python, toml and cpp are run in their order, in one scratch folder for each page, in which
cases, scripts, bench and build/release/breccia are those of the repository; csv and text are shown only. A comment before a block changes that:
  <!-- check: until=1e-4 -->        runs of the block end at that simulated time  [s]
  <!-- check: file=mine.toml -->    toml: is written to this file and checked; append=FILE adds to one
  <!-- check: camera -->            toml: a film of a small run is made with this camera
  <!-- check: dry -->               sh: cases are checked in place of run, sweep, test and calibrate, and each command, option, script and preset must exist
  <!-- check: skip WHY -->          is not run; of sh the grammar is checked
  <!-- check: code=9 -->            ends with this exit code
Of other toml all keys must be keys of a case. Commands that stand indented in place of between fences are an error. Exit code 1 if a sample fails.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import time
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[1]
BLOCK = re.compile(r"(?:^<!-- check: ([^\n]*?) -->\n)?^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
INDENTED = re.compile(r"^ {4}(?:build/release/)?(?:breccia|scripts/|bench/|cmake|mpirun|python3|sudo|docker|\[\[)[^\n]*", re.MULTILINE)
SHOWN_ONLY = ("text", "csv")
WRAPPER = """#!/bin/sh
if [ "$1" = run ] && [ -n "$BR_UNTIL" ]; then exec {program} "$@" --no-progress --until "$BR_UNTIL"; fi
exec {program} "$@"
"""


def unknown_keys(table, schema, path=""):
    """Keys of a piece of a case that no case has; where there are several methods, of the one that knows most of them."""
    if "oneOf" in schema:
        return min((unknown_keys(table, one, path) for one in schema["oneOf"]), key=len)
    unknown = []
    for name, value in table.items():
        named = schema.get("additionalProperties") if isinstance(schema.get("additionalProperties"), dict) else None
        below = schema.get("properties", {}).get(name, named)
        if below is None:
            unknown.append(path + name)
            continue
        if isinstance(value, list) and value and isinstance(value[0], dict):
            for item in value:
                unknown += unknown_keys(item, below.get("items", {}), f"{path}{name}.")
        elif isinstance(value, dict):
            unknown += unknown_keys(value, below, f"{path}{name}.")
    return unknown


def options_in(words):
    return [word.split("=")[0] for word in words if re.fullmatch(r"--?[a-z][\w-]*(=.*)?", word)]


def dry_problem(words, folder, environment):
    """What is wrong with a command, without doing its work; empty: nothing."""
    if words[0] == "mpirun":
        words = words[3:]
    if words[0].endswith("breccia") and words[1] in ("run", "sweep", "test", "calibrate"):
        sets = [word for k, word in enumerate(words) if word == "--set" or words[k - 1] == "--set"]
        done = subprocess.run(["breccia", "check", words[2], *sets], cwd=folder, env=environment, capture_output=True, text=True)
        if done.returncode:
            return done.stdout + done.stderr
        words = words[:2] + [word for word in words[3:] if word != "--set"]
    if words[0].endswith("breccia"):
        command = words[1:3] if words[1] == "mesh" else words[1:2]
        done = subprocess.run(["breccia", *command, "--help"], cwd=folder, env=environment, capture_output=True, text=True)
        known, where = done.stdout if done.returncode == 0 else "", "breccia " + " ".join(command)
        if not known:
            return f"{where} is no command"
    elif words[0].startswith(("scripts/", "bench/", "packaging/")):
        script = ROOT / words[0]
        if not os.access(script, os.X_OK):
            return f"{words[0]} is no script"
        known, where = script.read_text(), words[0]
    elif words[0] == "cmake" and "--preset" in words:
        presets = json.loads((ROOT / "CMakePresets.json").read_text())
        kind = "workflowPresets" if "--workflow" in words else "buildPresets" if "--build" in words else "configurePresets"
        name = words[words.index("--preset") + 1]
        return "" if name in [preset["name"] for preset in presets[kind]] else f"{name} is no {kind}"
    elif words[0] == "cmake":
        return ""
    else:
        return f"{words[0]}: what is this?"
    missing = [option for option in options_in(words[1:]) if option not in known]
    return f"{where} knows no {' '.join(missing)}" if missing else ""


def dry_run(text, folder, environment):
    """Problems of a block of commands."""
    problems = []
    for line in text.replace("\\\n", " ").split("\n"):
        words = shlex.split(line, comments=True)
        while words:
            end = words.index("&&") if "&&" in words else len(words)
            if problem := dry_problem(words[:end], folder, environment):
                problems.append(f"{' '.join(words[:end])}: {problem}")
            words = words[end + 1:]
    return "\n".join(problems)


def camera_command(text, folder):
    """Makes a film of a small run with a camera."""
    sys.path.insert(0, str(ROOT / "tests/program"))
    from two_balls import case_with

    (folder / "camera.toml").write_text(text)
    (folder / "balls.toml").write_text(case_with("output = { frames = 4, pictures = false }"))
    return "breccia run balls.toml -q --threads 1 && breccia render out/balls -o film.gif --size 64x64 --camera camera.toml"


def command_of(kind, text, options, folder, number, schema):
    """The command that runs a block; None if there is none. @throws ValueError if it can be seen that it is wrong"""
    if kind == "sh":
        return ["bash", "-euo", "pipefail", "-c", text]
    if kind == "python":
        (folder / f"block{number}.py").write_text(text)
        return ["/usr/bin/python3", f"block{number}.py"]
    if kind == "cpp":
        (folder / f"block{number}.cpp").write_text(text)
        return ["sh", "-c", f"g++ -std=c++20 -ffp-contract=off -I {ROOT}/src block{number}.cpp -o block{number} && ./block{number}"]
    file = options.get("file") or options.get("append")
    if "camera" in options:
        return ["bash", "-euc", camera_command(text, folder)]
    if not file:
        if unknown := unknown_keys(tomllib.loads(text), schema):
            raise ValueError(f"no case has the keys {', '.join(unknown)}")
        return None
    with open(folder / file, "a" if "append" in options else "w") as out:
        out.write("\n" + text)
    return ["breccia", "check", file]


def write_wrapper(folder, program):
    """Writes the program that samples call. Once and before any thread starts a process: a process that is forked while the file is
    open for writing holds it open, and the system refuses to run it until then ("text file busy")."""
    wrapper = folder / "breccia"
    wrapper.write_text(WRAPPER.format(program=program))
    wrapper.chmod(0o755)
    return wrapper


def run_page(page, wrapper, program, schema):
    """Numbers of samples that ran, that were skipped, and texts of what failed."""
    ran, skipped, failed = 0, 0, []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for name in ("cases", "scripts", "bench", "src", "examples"):
            (folder / name).symlink_to(ROOT / name)
        (folder / "build/release").mkdir(parents=True)
        (folder / "build/release/breccia").symlink_to(wrapper)
        environment = {**os.environ, "PATH": f"{wrapper.parent}:{os.environ['PATH']}", "PYTHONPATH": str(program.parent / "python"), "GOMP_SPINCOUNT": "2000"}
        page_text = page.read_text()
        for line in INDENTED.findall(BLOCK.sub("", page_text)):
            failed.append(f"{page}: a sample that no fence shows: {line.strip()}")
        for number, match in enumerate(BLOCK.finditer(page_text)):
            mark, kind, text = match[1] or "", match[2], match[3]
            if kind not in ("sh", "python", "toml", "cpp", *SHOWN_ONLY):
                failed.append(f"{page}: block {number + 1} has the language {kind!r}; sh, python, toml, cpp, text or csv")
                continue
            if mark.startswith("skip "):
                skipped += 1
                if kind == "sh" and (wrong := subprocess.run(["bash", "-n"], input=text, capture_output=True, text=True)).returncode:
                    failed.append(f"{page}: block {number + 1}: {wrong.stderr}")
                continue
            if kind in SHOWN_ONLY:
                continue
            options = dict((*part.split("=", 1), "")[:2] for part in mark.split())
            if unknown := set(options) - {"until", "file", "append", "code", "dry", "camera"}:
                failed.append(f"{page}: block {number + 1}: no mark {unknown}")
                continue
            ran += 1
            environment["BR_UNTIL"] = options.get("until", "")
            if "dry" in options:
                if problem := dry_run(text, folder, environment):
                    failed.append(f"{page}: block {number + 1}: {problem}")
                continue
            try:
                command = command_of(kind, text, options, folder, number, schema)
                done = command and subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300)
            except (ValueError, subprocess.TimeoutExpired) as error:
                failed.append(f"{page}: block {number + 1} ({kind}): {error}")
                continue
            if done and done.returncode != int(options.get("code", 0)):
                failed.append(f"{page}: block {number + 1} ({kind}) ended with {done.returncode}\n{text}{done.stdout[-1500:]}{done.stderr[-1500:]}")
    return ran, skipped, failed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/breccia")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="pages at once")
    parser.add_argument("pages", nargs="*", type=pathlib.Path)
    arguments = parser.parse_args()
    listed = subprocess.run(["git", "ls-files", "*.md"], cwd=ROOT, check=True, capture_output=True, text=True).stdout.split()
    pages = arguments.pages or [ROOT / name for name in listed if name != "CHANGELOG.md"]
    schema = json.loads(subprocess.run([arguments.program, "keys", "--schema"], check=True, capture_output=True, text=True).stdout)
    total, left, problems = 0, 0, []

    program = arguments.program.resolve()
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        wrapper = write_wrapper(pathlib.Path(folder), program)

        def timed(page):
            begin = time.monotonic()
            return *run_page(page, wrapper, program, schema), time.monotonic() - begin

        results = list(zip(pages, pool.map(timed, pages)))
    for page, (ran, skipped, failed, taken) in results:
        total, left, problems = total + ran, left + skipped, problems + failed
        if not ran and not skipped and not failed:
            continue
        name = page.resolve().relative_to(ROOT).as_posix() if page.resolve().is_relative_to(ROOT) else page.name
        print(f"{name:40} {ran:3} run {skipped:3} skipped {len(failed):3} failed  {taken:5.1f} s", flush=True)
    print(f"{total} samples run, {left} skipped, {len(problems)} failed")
    print("\n\n".join(problems))
    return 1 if problems or not total else 0


if __name__ == "__main__":
    sys.exit(main())
