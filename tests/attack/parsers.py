#!/usr/bin/env python3
"""Every parser fed with mutants of its corpus, which keeps former findings; --seconds in all."""

import glob
import os
import subprocess
import sys
import zlib

from common import CASES, Attack, HERE, arguments, checkpoints, run, tool

PARSERS = ("case", "gmsh", "abaqus", "tet_gmsh", "tet_abaqus", "stl", "csv", "spheres", "ldpm", "facets", "joints", "vtu",
           "vtkhdf", "png", "film", "recipe", "table", "record", "units", "checkpoint")


def content(path):
    with open(path, "rb") as file:
        return file.read()


def made(parser, attack):
    """Files of a corpus that a run writes."""
    folder = attack.path("r")
    if parser == "case":
        return list(CASES.values())
    if parser in ("checkpoint", "vtkhdf", "png", "record"):
        run("fdem", folder, 100, *(["--set", "output.format=vtkhdf"] if parser == "vtkhdf" else []))
    if parser == "checkpoint":
        return checkpoints(folder)[-1:]
    if parser == "vtkhdf":  # none, where the program is built without HDF5
        return sorted(glob.glob(os.path.join(folder, "fields", "*.hdf")) + glob.glob(os.path.join(folder, "elements.hdf.series")))
    if parser == "png":
        return glob.glob(os.path.join(folder, "pictures", "*.png"))[:1]
    if parser in ("record", "film"):
        path = attack.path("joined")
        with open(path, "wb") as file:
            if parser == "record":
                names = ("summary.json", "history.csv", "fragments.csv", "cracks.csv", "log.jsonl", "case.toml")
                paths = [os.path.join(folder, name) for name in names]
                file.write(b"\n====\n".join(content(p) if os.path.exists(p) else b"" for p in paths))
            else:
                text = content(os.path.join(HERE, "corpus", "recipe", "film.json"))
                file.write(b"breccia-film:%d:%s" % (len(text), zlib.compress(text).hex().encode()))
        return [path]
    return []


def main():
    arguments_ = arguments(__doc__, 0)
    arguments_.add_argument("parser", nargs="*", default=PARSERS, help="only these")
    options = arguments_.parse_args()
    seconds = options.seconds / len(options.parser) if options.seconds < 1e9 else 10
    result = 0
    for parser in options.parser:
        attack = Attack(f"fuzz: {parser}", "inputs")
        corpus = sorted(glob.glob(os.path.join(HERE, "corpus", parser, "*"))) + made(parser, attack)
        if not corpus:
            attack.note = "nothing to begin with"
            result |= attack.end()
            continue
        done = subprocess.run([tool("attack_fuzz"), parser, str(seconds),
                               str(options.seed), *corpus], capture_output=True, text=True,
                              cwd=attack.folder, env=dict(os.environ, TMPDIR=attack.folder))
        if attack.expect(done.returncode == 0, f"ended with {done.returncode}\n{done.stderr}"):
            attack.runs = int(done.stdout)
        else:
            kept = f"finding.{parser}.{options.seed}"
            last = attack.path(f"attack_fuzz.{parser}.last")
            if os.path.exists(last):
                with open(last, "rb") as a, open(kept, "wb") as b:
                    b.write(a.read())
                print(f"the input is kept as {kept}", file=sys.stderr)
        result |= attack.end()
    return result


if __name__ == "__main__":
    sys.exit(main())
