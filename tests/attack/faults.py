#!/usr/bin/env python3
"""Every call on a file and every allocation of a small run fails once (or from then on): the run
ends with an exit code that the program states, checkpoints verify, and it can be done again."""

import os
import shutil
import sys
import time

from common import (Attack, CASES, EXIT_CODES, arguments, breccia, checkpoints, resume, run,
                    state_hash, tool)

STEPS = 12
INTERVAL = ("--set", "checkpoint.steps=4")
LIBRARY = tool("libattack_faults.so")
ERRNOS = {"EIO": 5, "ENOSPC": 28, "EACCES": 13, "EMFILE": 24, "EINTR": 4}


def survive(attack, case, what, expected_hash, extra):
    folder = attack.path("run")
    shutil.rmtree(folder, ignore_errors=True)
    environment = dict(LD_PRELOAD=LIBRARY, FAULT_BELOW=attack.folder, **extra)
    code, text = run(case, folder, STEPS, *INTERVAL, env=environment)
    attack.runs += 1
    attack.codes[code] = attack.codes.get(code, 0) + 1
    attack.expect(code in EXIT_CODES, f"{what}: ends with {code}: {text[-300:]}")
    attack.expect("fault of the program itself" not in text, f"{what}: {text[-300:]}")
    for path in checkpoints(folder):
        told, why = breccia("info", path)
        attack.expect(told == 0, f"{what}: {path}: {told}: {why}")
    if code == 0 and state_hash(folder) is not None:
        attack.expect(state_hash(folder) == expected_hash, f"{what}: another hash, exit code 0")
    if code != 0 and checkpoints(folder):
        told, why = resume(folder, "--steps", str(STEPS))
        attack.expect(told == 0 and state_hash(folder) == expected_hash,
                      f"{what}: resume ends with {told}: {why[-300:]}")


def main():
    parser = arguments(__doc__, 10**9)
    parser.add_argument("--every", type=int, default=1, help="only each N-th index")
    parser.add_argument("--share", default="0/1", help="I/N: the I-th of N parts, for N processes")
    options = parser.parse_args()
    share, shares = (int(word) for word in options.share.split("/"))
    begun = time.time()
    part = 0
    result = 0
    for case in CASES:
        for kind in ("CALL", "ALLOC"):
            part += 1
            attack = Attack(f"{'file call' if kind == 'CALL' else 'allocation'} k fails, {case}", "indices")
            attack.codes = {}
            count = attack.path("count")
            code, text = run(case, attack.path("good"), STEPS, *INTERVAL,
                             env=dict(LD_PRELOAD=LIBRARY, FAULT_BELOW=attack.folder, FAULT_COUNT=count))
            attack.expect(code == 0, f"undisturbed: {code}: {text}")
            good = state_hash(attack.path("good"))
            with open(count) as file:
                total = int(file.read().split()[0 if kind == "CALL" else 1])
            names = list(ERRNOS)
            for k in range(1 + options.seed % options.every + share * options.every, total + 1,
                           options.every * shares):
                if attack.runs >= options.runs or time.time() - begun > options.seconds * part / (2 * len(CASES)):
                    break
                name = names[k % len(names)] if options.every > 1 else names[k % 2]
                extra = {f"FAULT_{kind}": str(k), "FAULT_ERRNO": str(ERRNOS[name])}
                if (k // options.every) % 3 == 2 and name != "EINTR":  # a call that no end of signals breaks off is tried for ever
                    extra["FAULT_STAYS"] = "1"
                survive(attack, case, f"{kind} {k} {name} {extra.get('FAULT_STAYS', '')}", good, extra)
            attack.note = f"of {total}, up to {k}; exit codes {dict(sorted(attack.codes.items(), key=str))}"
            result |= attack.end()
    return result


if __name__ == "__main__":
    sys.exit(main())
