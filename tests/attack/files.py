#!/usr/bin/env python3
"""Damaged checkpoints (none may be loaded) and forged ones, digests right (none may crash)."""

import itertools
import os
import subprocess
import sys
import time

from common import Attack, CASES, arguments, breccia, checkpoints, run, tool


def main():
    options = arguments(__doc__, 2000).parse_args()
    result = 0
    for case in CASES:
        for kind in ("damaged", "forged", "forged model"):
            attack = Attack(f"{kind}, {case}", "files")
            run(case, attack.path("r"))
            breccia("prepare", os.path.join(os.path.dirname(__file__), case + ".toml"), "-o",
                    attack.path("m.br"))
            good = (checkpoints(attack.path("r")) or ["none"])[-1]
            model = attack.path("m.br")
            words = {"damaged": ["damaged", good], "forged": ["forged", model, good],
                     "forged model": ["forged", model, model]}[kind]
            # A forged file costs a process and twenty steps, a damaged one the reading alone.
            runs, at_once = options.runs, 500
            if kind != "damaged":
                runs, at_once = max(1, runs // 10), 50
            counts = []
            for part in range(-(-runs // at_once)):
                if part and time.time() - attack.begun > options.seconds / (3 * len(CASES)):
                    break
                seed = options.seed + 1000 * part
                done = subprocess.run([tool("attack_files"), *words,
                                       str(min(at_once, runs - part * at_once)), str(seed)],
                                      capture_output=True, text=True,
                                      env=dict(os.environ, TMPDIR=attack.folder))
                if done.stderr:
                    sys.stderr.write(f"{kind}, {case}, seed {seed}: {done.stderr}")
                told = [int(word) for word in done.stdout.split()]
                if not attack.expect(len(told) > 3, f"attack_files ended with {done.returncode}"):
                    break
                counts = [a + b for a, b in itertools.zip_longest(counts, told, fillvalue=0)]
            if counts:
                attack.runs = counts[0]
                attack.findings += sum(counts[1:] if kind == "damaged" else counts[3:])
                if kind != "damaged":
                    attack.note = f"({counts[1]} refused, {counts[2]} ran)"
            result |= attack.end()
    return result


if __name__ == "__main__":
    sys.exit(main())
