#!/usr/bin/env python3
"""Compiles the CUDA sources of a configured build folder by nvcc down to PTX: check_cuda_compile.py BUILD. Sources of a library go together, much
as CMake does it for host code (for CUDA not before version 3.31): half of the time would go into headers.

The device's half alone takes half the time. nvcc's front end reads all of a file for it, host functions and their instances, too, as
these say which kernels there are; what stands in `#if !defined(__CUDA_ARCH__)` is what a build without CUDA compiles. But for the host's half nvcc
writes all of a file anew, templates that nobody uses included, and g++ refuses some of what it writes (a loop over a list in braces in a template).
So a few sources that include nearly all headers go through both halves; g++ reads them and makes no object."""
import concurrent.futures
import functools
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parents[1] / "src"
build = pathlib.Path(sys.argv[1]).resolve()
entries = []
for entry in json.loads((build / "compile_commands.json").read_text()):
    words = shlex.split(entry["command"])
    if "cu" not in words:
        continue
    flags = [word for k, word in enumerate(words[:-4]) if word not in ("-MD", "-MT", "-MF", "-x", "cu", "-c") and words[k - 1] not in ("-MT", "-MF")]
    entries.append((tuple(flags), pathlib.Path(entry["file"])))


@functools.cache
def headers_of(file):
    """Headers of ours that a file includes, by others, too."""
    own = {root / name for name in re.findall(r'^#include "([^"]+)"', file.read_text(), re.MULTILINE) if (root / name).exists()}
    return own.union(*map(headers_of, own))


def widest(sources, share):
    """The fewest of these sources that include this share of the lines of all headers, nearly."""
    left = set().union(*map(headers_of, sources))
    lines = {header: header.read_text().count("\n") for header in left}
    enough, chosen = (1 - share) * sum(lines.values()), []
    while sum(lines[header] for header in left) > enough:
        chosen.append(max(sources, key=lambda source: sum(lines[header] for header in headers_of(source) & left)))
        left -= headers_of(chosen[-1])
    return chosen


whole = widest([source for _, source in entries], 0.95)
groups = {}
for flags, source in entries:
    groups.setdefault((flags, source.relative_to(root).parts[0], source in whole), []).append(source)

folder = build / "together"
folder.mkdir(exist_ok=True)
jobs = []
for (flags, library, both_halves), sources in groups.items():
    parts = (len(sources) + 23) // 24
    for part in range(parts):
        mine = sources[part * len(sources) // parts:(part + 1) * len(sources) // parts]
        path = folder / f"{library}_{len(jobs)}.cu"
        path.write_text("".join(f'#include "{source}"\n' for source in mine))
        made = ["-Xcompiler=-fsyntax-only", "-c", str(path), "-o", str(path.with_suffix(".o"))] if both_halves else ["-ptx", str(path), "-o", str(path.with_suffix(".ptx"))]
        jobs.append([sum(source.stat().st_size for source in mine) * (1 + both_halves), *flags, "-x", "cu", *made])
jobs = [job for _, *job in sorted(jobs, key=lambda job: -job[0])]  # the largest first, so that no core waits at the end


def compiled(job):
    return job, subprocess.run(job, cwd=build, capture_output=True, text=True)


wrong = 0
with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    for job, done in pool.map(compiled, jobs):
        if done.returncode:
            wrong += 1
            print(shlex.join(job), done.stdout, done.stderr, sep="\n")
print(f"{len(entries)} files with kernels in {len(jobs)} groups, {wrong} of which do not compile; {len(whole)} of these files with the host's half")
sys.exit(1 if wrong or not jobs else 0)
