#!/usr/bin/env python3
"""Compiles the CUDA sources of a configured build folder by nvcc: check_cuda_compile.py BUILD. Sources of a folder go together, as
CMake does it for host code (for CUDA not before version 3.31): a third of the time goes into headers."""
import concurrent.futures
import json
import os
import pathlib
import shlex
import subprocess
import sys

build = pathlib.Path(sys.argv[1]).resolve()
groups = {}
for entry in json.loads((build / "compile_commands.json").read_text()):
    words = shlex.split(entry["command"])
    if "cu" not in words:
        continue
    flags = [word for k, word in enumerate(words[:-4]) if word not in ("-MD", "-MT", "-MF", "-x", "cu", "-c") and words[k - 1] not in ("-MT", "-MF")]
    source = pathlib.Path(entry["file"])
    groups.setdefault((tuple(flags), source.parent), []).append(source)

folder = build / "together"
folder.mkdir(exist_ok=True)
jobs = []
for (flags, parent), sources in groups.items():
    parts = (len(sources) + 7) // 8
    for part in range(parts):
        mine = sources[part * len(sources) // parts:(part + 1) * len(sources) // parts]
        path = folder / f"{parent.name}_{len(jobs)}.cu"
        path.write_text("".join(f'#include "{source}"\n' for source in mine))
        # g++ reads the host's half and writes no object: a third less time, and nothing here links them.
        jobs.append([sum(source.stat().st_size for source in mine), *flags, "-Xcompiler=-fsyntax-only", "-x", "cu", "-c", str(path), "-o", str(path.with_suffix(".o"))])
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
