#!/usr/bin/env python3
"""Holds #include lines to the direction of the layers, and files to one job.

The benchmarks in bench, beside src, may include every layer and no layer includes them.
The key to writing the constants of a run, core/set_up.hpp, is for the folders `setup` and the benchmarks.
Folders `setup`, and files that CMakeLists.txt (br_kernels) leaves to the host's compiler, run no loops and include no header that
does: their text would stand for nvcc's, too, and walk over arrays of the GPU. Runs of the host (host_run.cpp) loop over arrays of the host.

Usage: check_includes.py [SOURCE_FOLDER]   (default: src beside this script's folder)
Exit status 0 if all is well, 1 with a line for each violation.
"""
import pathlib
import re
import sys

ALLOWED = {
    "exec": set(),
    "math": {"exec"},
    "core": {"exec", "math"},
    "domain": {"exec", "math", "core"},
    "dem": {"exec", "math", "core", "domain"},
    "fdem_shared": {"exec", "math", "core", "domain"},
    "fdem": {"exec", "math", "core", "domain", "fdem_shared"},
    "fdem3": {"exec", "math", "core", "domain", "fdem_shared", "fdem"},
    "coupled": {"exec", "math", "core", "domain", "dem", "fdem_shared", "fdem", "fdem3"},
    "io": {"exec", "math", "core"},
    "prepare": {"exec", "math", "core", "io", "dem", "fdem_shared", "fdem", "fdem3", "coupled"},
    "run": {"exec", "math", "core", "domain", "io", "dem", "fdem_shared", "fdem", "fdem3", "coupled", "prepare"},
    "report": {"exec", "math", "core", "io"},
    "api": {"exec", "math", "core", "io", "run"},
    "laboratory": {"exec", "math", "core", "domain", "io", "dem", "fdem_shared", "fdem", "fdem3", "coupled", "prepare", "run", "report"},
    "app": {"exec", "math", "core", "domain", "io", "dem", "fdem_shared", "fdem", "fdem3", "coupled", "prepare", "run", "report", "laboratory"},
}
ALLOWED["bench"] = set(ALLOWED)
LONGEST = 500
KEY = "core/set_up.hpp"
LOOPS = {"exec/for_each.hpp", "exec/fold_sum.hpp", "exec/launch.hpp", "domain/owned.hpp"}
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')


def has_loops(header):
    """Whether a header includes one of LOOPS itself."""
    return header.is_file() and any(found.group(1) in LOOPS for found in map(INCLUDE.match, header.read_text().splitlines()) if found)


def left_to_host(source):
    """Sources that g++ compiles in a CUDA build, too, of libraries with kernels."""
    build = source.parent / "CMakeLists.txt"
    for name, hosts in re.findall(r"^br_kernels\((\w+)([^)]*)\)", build.read_text() if build.is_file() else "", re.M):
        for path in (source / name).rglob("*.cpp"):
            if any(f"/{path.as_posix()}".endswith(f"/{host}.cpp") for host in hosts.split() if host != "host_run"):
                yield path


def violations(source):
    hosts = set(left_to_host(source))
    for path in sorted([*source.rglob("*"), *(source.parent / "bench").rglob("*")]):
        if path.suffix not in (".hpp", ".cpp"):
            continue
        inside = path.relative_to(source if path.is_relative_to(source) else source.parent)
        layer = inside.parts[0]
        if layer not in ALLOWED:
            yield f"{path}: {layer} is not a layer; allowed are {', '.join(ALLOWED)}"
            continue
        lines = path.read_text().splitlines()
        if len(lines) > LONGEST:
            yield f"{path}: {len(lines)} lines; over {LONGEST} a file has two jobs"
        for number, line in enumerate(lines, 1):
            found = INCLUDE.match(line)
            if not found:
                continue
            if found.group(1) == KEY and "setup" not in inside.parts and layer != "bench":
                yield f"{path}:{number}: constants of a run are written in setup alone; read World::given"
            loops = found.group(1) in LOOPS or has_loops(source / found.group(1))
            if loops and layer != "exec" and ("setup" in inside.parts or path in hosts):
                yield f"{path}:{number}: a host's compiler makes this where arrays lie on a GPU: loops stand beside the steps"
            target = found.group(1).split("/")[0]
            if target in ALLOWED and target != layer and target not in ALLOWED[layer]:
                yield f"{path}:{number}: {layer} must not see {target}"


def main():
    source = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent / "src"
    found = list(violations(source))
    print("\n".join(found) if found else "includes point one way")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
