#!/usr/bin/env python3
"""On a GPU: allocation k fails, once or from then on; the device is lost at call k; a bit of an array flips. The run
ends with an exit code that the program states, a run that ends well has the hash of an undisturbed one, and what it left can be resumed
on the device. Of flipped bits it is told how many changed the result without a word, with and without an audit of steps; where every step is
audited, none may. A build with -DBR_CUDA=ON and its target `attack` are needed: BRECCIA_BUILD names its folder."""

import collections
import concurrent.futures
import json
import os
import random
import shutil
import sys
import time

import common
from common import Attack, CASES, EXIT_CODES, arguments, breccia, checkpoints, resume, run, state_hash, tool

STEPS = 60
LIBRARY = tool("libattack_device_faults.so")


def disturbed(attack, case, name, fault, *more, steps=STEPS):
    folder = attack.path(name)
    code, text = run(case, folder, steps, "--set", "checkpoint.steps=20", *more, env={"LD_PRELOAD": LIBRARY, **fault})
    return folder, code, text


def counts(attack, case, *more, steps=STEPS):
    """Allocations, calls and graphs of an undisturbed run, and its hash."""
    count = attack.path("count")
    folder, code, text = disturbed(attack, case, "good", {"GPU_FAULT_COUNT": count}, "--force", *more, steps=steps)
    if code != 0:
        sys.exit(f"an undisturbed run of {case} on the device ends with {code}: {text[-600:]}")
    if not os.path.exists(count):
        sys.exit(f"{LIBRARY} was not loaded into {common.PROGRAM}")
    with open(count) as file:
        numbers = [int(word) for word in file.read().split()]
    if numbers[0] == 0:
        sys.exit(f"{LIBRARY} sees no call of the driver: it stands before CUDA's static runtime alone")
    return numbers, state_hash(folder)


def survive(attack, case, fault, good, number):
    name = f"run_{number}"
    what = f"{case}: " + " ".join(f"{key}={value}" for key, value in fault.items())
    folder, code, text = disturbed(attack, case, name, fault)
    attack.expect(code in EXIT_CODES, f"{what}: ends with {code}: {text[-300:]}")
    if code == 0:
        attack.expect(state_hash(folder) == good, f"{what}: another hash, exit code 0")
    for path in checkpoints(folder):
        told, why = breccia("info", path)
        attack.expect(told == 0, f"{what}: {path}: {told}: {why}")
    if code != 0 and checkpoints(folder):
        told, why = resume(folder, "--steps", str(STEPS))
        attack.expect(told == 0 and state_hash(folder) == good, f"{what}: resume ends with {told}: {why[-300:]}")
    shutil.rmtree(folder, ignore_errors=True)
    return code


def flipped(attack, case, fault, good, number, audit):
    """What a flipped bit did: told by an exit code, without effect, or another result and no word."""
    folder, code, text = disturbed(attack, case, f"flip_{audit}_{number}", fault, "--set", f"audit.every={audit}")
    same = code == 0 and state_hash(folder) == good
    what = f"{case}: audit {audit}, " + " ".join(f"{key}={value}" for key, value in fault.items())
    attack.expect(code in EXIT_CODES, f"{what}: ends with {code}: {text[-300:]}")
    attack.expect(code != 0 or same or audit != 1, f"{what}: another result, and no word")
    shutil.rmtree(folder, ignore_errors=True)
    return f"told by {code}" if code != 0 else "no effect" if same else "no word"


def together(options, attack, faults, work):
    """What work() says of each fault, as many at once as asked for, until time is up."""
    def one(item):
        if time.time() - attack.begun > options.seconds:
            return None
        return work(*item)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        outcomes = [outcome for outcome in pool.map(one, enumerate(faults)) if outcome is not None]
    attack.runs = len(outcomes)
    return json.dumps({str(outcome): n for outcome, n in sorted(collections.Counter(outcomes).items(), key=str)})


def failing(options, case, drawn, kind):
    attack = Attack({"alloc": "allocation k on the device fails", "lost": "device lost at call k"}[kind] + f", {case}", "indices")
    (allocations, calls, *_), good = counts(attack, case)
    if kind == "alloc":
        faults = [{"GPU_FAULT_ALLOC": str(k), **stays} for stays in ({}, {"GPU_FAULT_STAYS": "1"}) for k in range(1, allocations + 1)]
    else:
        faults = [{"GPU_FAULT_LOST": str(k)} for k in range(1, calls + 1)]
    possible = len(faults)
    faults = drawn.sample(faults, min(options.runs, possible))
    told = together(options, attack, faults, lambda number, fault: survive(attack, case, fault, good, number))
    attack.note = f"of {possible}; exit codes {told}"
    return attack.end()


def flips(options, case, drawn, audit):
    attack = Attack(f"bit flips, audit of 1 step in {audit}, {case}" if audit else f"bit flips, {case}", "flips")
    words = ("--set", f"audit.every={audit}")
    (_, _, graphs, kernels, _), good = counts(attack, case, *words)
    attack.expect(good == counts(attack, case)[1], "an audited run has another hash")
    before = counts(attack, case, *words, steps=1)[0][3]  # kernels of set-up and of output: no more than these
    if graphs > 0:
        name, first, last = "GPU_FAULT_FLIP", 1, graphs
    else:
        name, first, last = "GPU_FAULT_FLIP_KERNEL", before, kernels - before
    faults = [{name: str(drawn.randint(first, last)), "GPU_FAULT_SEED": str(k)} for k in range(options.runs)]
    told = together(options, attack, faults, lambda number, fault: flipped(attack, case, fault, good, number, audit))
    attack.note = f"{last - first + 1} {'graphs' if graphs > 0 else 'kernels'}; {told}"
    return attack.end()


def main():
    parser = arguments(__doc__, 100)
    parser.add_argument("--jobs", type=int, default=8)
    parser.add_argument("--device", default="cuda", help="as --device of the program")
    parser.add_argument("--part", choices=("alloc", "lost", "flips"), help="only this one")
    parser.add_argument("--case", choices=list(CASES), help="only this one")
    options = parser.parse_args()
    common.DEVICE += ["--device", options.device]
    drawn = random.Random(options.seed)
    parts = [options.part] if options.part else ["alloc", "lost", "flips"]
    cases = [options.case] if options.case else list(CASES)
    options.seconds /= len(cases) * sum(3 if part == "flips" else 1 for part in parts)
    result = 0
    for case in cases:
        for part in parts:
            if part != "flips":
                result |= failing(options, case, drawn, part)
            for audit in (0, 4, 1) if part == "flips" else ():
                result |= flips(options, case, drawn, audit)
    return result


if __name__ == "__main__":
    raise SystemExit(main())
