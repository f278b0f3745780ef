#!/usr/bin/env python3
"""Writes the gallery of the cases and the table of their checks, from result folders of their small versions.

    scripts/build_gallery.py FOLDER [--results DIR] [--run] [--only NAME ...] [--program build/release/breccia]

--run     makes what DIR lacks: DIR/<case>, of cases/<case>/small.toml, one thread each
FOLDER    gets gallery.md and checks.md, with picture, film (640 pixels wide; needs ffmpeg) and report of each result; without a result a case shows
          the picture in its folder. Exit code 1 if a run or a check fails.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[1]


def shown(value):
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def made(program, result, folder, name):
    """Lines about the files that are drawn of a result."""
    lines = []
    picture = folder / f"{name}.png"
    subprocess.run([program, "render", result, "-o", picture], check=True, stdout=subprocess.DEVNULL)
    lines.append(f"![{name}]({name}.png)")
    report = folder / f"{name}.html"
    subprocess.run([program, "report", result, "-o", report], check=True, stdout=subprocess.DEVNULL)
    links = [f"[report]({name}.html), {report.stat().st_size / 1e6:.1f} MB"]
    if shutil.which("ffmpeg"):
        subprocess.run([program, "render", result, "-o", folder / f"{name}.mp4", "--width", "640"], check=True, stdout=subprocess.DEVNULL)
        links.append(f"[film]({name}.mp4)")
    return lines, links


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "build/gallery")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/breccia")
    parser.add_argument("--run", action="store_true")
    parser.add_argument("--only", nargs="*")
    arguments = parser.parse_args()
    program, folder, problems = arguments.program.resolve(), arguments.folder, []
    folder.mkdir(parents=True, exist_ok=True)
    gallery = ["# Gallery", "", "The cases that come with Breccia. Pictures, films and reports are of their small versions, which a laptop runs in seconds to minutes,",
               "where these were run as the pages were built; otherwise the picture is that of the case's page.", ""]
    checks = ["# Checks of the cases", "", "Written from the results of the small cases when these pages were built: each check is a key of the case file, so that any run repeats it.", "",
              "| case | check | value | expected | tolerance | unit | |", "|---|---|---|---|---|---|---|"]
    checked = 0
    cases = [case for case in sorted((ROOT / "cases").iterdir()) if (case / "small.toml").exists() and (not arguments.only or case.name in arguments.only)]
    for case in cases:
        name, result = case.name, arguments.results / case.name
        if arguments.run and not (result / "summary.json").exists():
            done = subprocess.run([program, "run", case / "small.toml", "-o", result, "--threads", "1", "--no-progress", "--force"], capture_output=True, text=True)
            if done.returncode:
                problems.append(f"{name}: the run ended with {done.returncode}\n{done.stderr[-500:]}")
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        drawn = {case.name: pool.submit(made, program, arguments.results / case.name, folder, case.name)
                 for case in cases if (arguments.results / case.name / "summary.json").exists()}
    for case in cases:
        name = case.name
        title = tomllib.loads((case / "small.toml").read_text()).get("title") or tomllib.loads((case / "case.toml").read_text()).get("title", name)
        result = arguments.results / name
        gallery += [f"## {title}", ""]
        links = [f"[the case](../../cases/{name}/README.md)", f"[file](../../cases/{name}/small.toml)"]
        if name in drawn:
            summary = json.loads((result / "summary.json").read_text())
            lines, more = drawn[name].result()
            gallery += [*lines, ""]
            links += more
            gallery += [f"{summary['steps']:,} steps, state hash `{summary['state_hash']}`.", "", "```sh",
                        f"breccia run cases/{name}/small.toml && breccia report out/{name}_small", "```", ""]
            for check in summary.get("checks", []):
                checked += 1
                passed = check.get("passed", check.get("pass"))
                checks.append(f"| {name} | {check['name']} | {shown(check['value'])} | {shown(check['expected'])} | {shown(check['tolerance'])} | {check.get('unit', '-') or '-'} | {'pass' if passed else '**fails**'} |")
                if not passed:
                    problems.append(f"{name}: {check['name']} fails")
        elif (case / "picture.png").exists():
            gallery += [f"![{title}](../../cases/{name}/picture.png)", ""]
        gallery += [" · ".join(links), ""]
        # files that the links need, where the site's other pages do not
        if not (folder / f"../../cases/{name}").resolve().exists():
            (folder / f"../../cases/{name}").resolve().mkdir(parents=True)
        for file in ("small.toml", "picture.png"):
            source, target = case / file, (folder / f"../../cases/{name}/{file}").resolve()
            if source.exists() and target != source.resolve():
                shutil.copyfile(source, target)
    if not checked:
        checks.append("| no case was run | | | | | | |")
    (folder / "gallery.md").write_text("\n".join(gallery))
    (folder / "checks.md").write_text("\n".join(checks) + "\n")
    print(f"{folder}/gallery.md, {checked} checks, {len(problems)} problems")
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
