#!/usr/bin/env python3
"""On a GPU: allocation k fails, once or from then on; the device is lost at call k; a bit of an array flips. The run
ends with an exit code that the program states, a run that ends well has the hash of an undisturbed one, and what it left can be resumed
on the device. Of flipped bits it is told how many changed the result without a word, with and without an audit of steps."""

import collections
import concurrent.futures
import json
import os
import random
import shutil

from common import Attack, EXIT_CODES, TOOLS, arguments, breccia, checkpoints, resume, run, state_hash

STEPS = 60
GPU = ("--device", "cuda")
LIBRARY = os.path.join(TOOLS, "libattack_device_faults.so")


def disturbed(attack, case, name, steps, fault, *more):
    folder = attack.path(name)
    code, text = run(case, folder, steps, "--set", "checkpoint.steps=20", *GPU, *more, env={"LD_PRELOAD": LIBRARY, **fault})
    return folder, code, text


def counts(attack, case):
    """Allocations, calls and graphs of an undisturbed run, and its hash."""
    count = attack.path("count")
    folder, code, text = disturbed(attack, case, "good", STEPS, {"GPU_FAULT_COUNT": count})
    attack.expect(code == 0, f"undisturbed: {code}: {text[-300:]}")
    with open(count) as file:
        return [int(word) for word in file.read().split()], state_hash(folder)


def survive(attack, case, fault, good, number):
    name = f"run_{number}"
    what = " ".join(f"{key}={value}" for key, value in fault.items())
    folder, code, text = disturbed(attack, case, name, STEPS, fault)
    attack.expect(code in EXIT_CODES, f"{what}: ends with {code}: {text[-300:]}")
    if code == 0:
        attack.expect(state_hash(folder) == good, f"{what}: another hash, exit code 0")
    for path in checkpoints(folder):
        told, why = breccia("info", path)
        attack.expect(told == 0, f"{what}: {path}: {told}: {why}")
    if code != 0 and checkpoints(folder):
        told, why = resume(folder, "--steps", str(STEPS), *GPU)
        attack.expect(told == 0 and state_hash(folder) == good, f"{what}: resume ends with {told}: {why[-300:]}")
    shutil.rmtree(folder, ignore_errors=True)
    return code


def flipped(attack, case, fault, good, number, audit):
    """What a flipped bit did: told by an exit code, without effect, or another result and no word."""
    folder, code, _ = disturbed(attack, case, f"flip_{audit}_{number}", STEPS, fault, "--set", f"audit.every={audit}")
    same = code == 0 and state_hash(folder) == good
    attack.expect(code in EXIT_CODES, f"flip {number}: ends with {code}")
    shutil.rmtree(folder, ignore_errors=True)
    return f"told by {code}" if code != 0 else "no effect" if same else "no word"


def main():
    parser = arguments(__doc__, 100)
    parser.add_argument("--jobs", type=int, default=8)
    options = parser.parse_args()
    drawn = random.Random(options.seed)
    result = 0
    for case in ("dem", "fdem"):
        faults = {}
        for kind in ("allocation k on the device fails", "device lost at call k"):
            attack = Attack(f"{kind}, {case}", "indices")
            (allocations, calls, _, _), good = counts(attack, case)
            if kind.startswith("allocation"):
                faults = [{"GPU_FAULT_ALLOC": str(k), **stays} for k in range(1, allocations + 1) for stays in ({}, {"GPU_FAULT_STAYS": "1"})]
                drawn.shuffle(faults)
                faults = faults[:2 * options.runs]
            else:
                faults = [{"GPU_FAULT_LOST": str(k)} for k in sorted(drawn.sample(range(1, calls + 1), min(options.runs, calls)))]
            with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
                codes = collections.Counter(pool.map(lambda item: survive(attack, case, item[1], good, item[0]), enumerate(faults)))
            attack.runs = len(faults)
            total = allocations if kind.startswith("allocation") else calls
            attack.note = f"of {total}; exit codes " + json.dumps({str(code): n for code, n in sorted(codes.items(), key=str)})
            result |= attack.end()
        for audit in (0, 4):
            attack = Attack(f"bit flips in state, audit 1 in {audit}, {case}" if audit else f"bit flips in state, {case}", "flips")
            (_, _, graphs, _), good = counts(attack, case)
            _, code, text = disturbed(attack, case, "sound", STEPS, {}, "--set", f"audit.every={audit}")
            attack.expect(code == 0, f"undisturbed: {code}: {text[-300:]}")
            faults = [{"GPU_FAULT_FLIP": str(drawn.randint(1, max(graphs, 1))), "GPU_FAULT_SEED": str(k)} for k in range(options.runs)]
            with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
                outcomes = collections.Counter(pool.map(lambda item: flipped(attack, case, item[1], good, item[0], audit), enumerate(faults)))
            attack.runs = len(faults)
            attack.note = f"{graphs} graphs; " + json.dumps(dict(outcomes))
            result |= attack.end()
    return result


if __name__ == "__main__":
    raise SystemExit(main())
