#!/usr/bin/env python3
"""Every parser fed with mutants of its corpus, which keeps former findings; --seconds in all."""

import glob
import os
import subprocess
import sys

from common import Attack, HERE, arguments, checkpoints, run, tool

PARSERS = ("case", "gmsh", "abaqus", "tet_gmsh", "tet_abaqus", "stl", "csv", "spheres", "ldpm", "joints", "vtu", "units",
           "checkpoint")


def main():
    options = arguments(__doc__, 0).parse_args()
    seconds = min(options.seconds, 1e6) / len(PARSERS) if options.seconds < 1e9 else 10
    result = 0
    for parser in PARSERS:
        attack = Attack(f"fuzz: {parser}", "inputs")
        corpus = sorted(glob.glob(os.path.join(HERE, "corpus", parser, "*")))
        if parser == "checkpoint":
            run("fdem", attack.path("r"))
            corpus = checkpoints(attack.path("r"))[-1:]
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
