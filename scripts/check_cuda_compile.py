#!/usr/bin/env python3
"""Compiles the CUDA sources of a configured build folder by nvcc down to PTX: check_cuda_compile.py BUILD. Sources of a library go together, much
as CMake does it for host code (for CUDA not before version 3.31): half of the time would go into headers.

The device's half alone takes half the time. nvcc's front end reads all of a file for it, host functions and their instances, too, as
these say which kernels there are; what stands in `#if !defined(__CUDA_ARCH__)` is what a build without CUDA compiles."""
import concurrent.futures
import json
import os
import pathlib
import shlex
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parents[1] / "src"
build = pathlib.Path(sys.argv[1]).resolve()
groups = {}
for entry in json.loads((build / "compile_commands.json").read_text()):
    words = shlex.split(entry["command"])
    if "cu" not in words:
        continue
    flags = [word for k, word in enumerate(words[:-4]) if word not in ("-MD", "-MT", "-MF", "-x", "cu", "-c") and words[k - 1] not in ("-MT", "-MF")]
    source = pathlib.Path(entry["file"])
    groups.setdefault((tuple(flags), source.relative_to(root).parts[0]), []).append(source)

folder = build / "together"
folder.mkdir(exist_ok=True)
jobs = []
for (flags, library), sources in groups.items():
    parts = (len(sources) + 23) // 24
    for part in range(parts):
        mine = sources[part * len(sources) // parts:(part + 1) * len(sources) // parts]
        path = folder / f"{library}_{len(jobs)}.cu"
        path.write_text("".join(f'#include "{source}"\n' for source in mine))
        jobs.append([sum(source.stat().st_size for source in mine), *flags, "-x", "cu", "-ptx", str(path), "-o", str(path.with_suffix(".ptx"))])
jobs = [job for _, *job in sorted(jobs, key=lambda job: -job[0])]  # the largest first, so that no core waits at the end


def compiled(job):
    return job, subprocess.run(job, cwd=build, capture_output=True, text=True)


wrong = 0
with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    for job, done in pool.map(compiled, jobs):
        if done.returncode:
            wrong += 1
            print(shlex.join(job), done.stdout, done.stderr, sep="\n")
print(f"{sum(len(sources) for sources in groups.values())} files with kernels in {len(jobs)} groups, {wrong} of which do not compile")
sys.exit(1 if wrong or not jobs else 0)
