#!/usr/bin/env python3
"""On a GPU: allocation k fails, once or from then on; the device is lost at call k; a bit of an array flips. The run
ends with an exit code that the program states, a run that ends well has the hash of an undisturbed one, and what it left can be resumed
on the device. Of flipped bits it is told how many changed the result without a word, with and without an audit of steps; where every step is
audited, none may. A build with -DBR_CUDA=ON and its target `attack` are needed: BRECCIA_BUILD names its folder. Allocations fail in
processes that call the program's main again and again, since a start on the device costs many times a run: so what a failed run leaves to the
next one shows, too, and no array may stay. A run that does not end as it should is tried again in a process of its own."""

import collections
import concurrent.futures
import json
import os
import queue
import random
import select
import shutil
import subprocess
import sys
import threading
import time

import common
from common import Attack, CASES, EXIT_CODES, arguments, breccia, checkpoints, resume, run, run_words, state_hash, tool

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


class Server:
    """A process that runs the program's main as often as it is asked to; one that ends is begun anew."""

    def __init__(self, gpu):
        self.environment = dict(os.environ, GOMP_SPINCOUNT="2000", LD_PRELOAD=LIBRARY, GPU_FAULT_SERVE="1")
        if gpu is not None:
            self.environment["CUDA_VISIBLE_DEVICES"] = gpu
        self.process = None

    def call(self, log, words, k=0, stays=0):
        """Exit code, allocations and arrays that were not freed; these are None if the process has ended by it."""
        if self.process is None:
            self.process = subprocess.Popen([common.PROGRAM], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=self.environment)
        self.process.stdin.write("\t".join([f"{k} {stays} {log}", *words]) + "\n")
        self.process.stdin.flush()
        if not select.select([self.process.stdout], [], [], common.HANG)[0]:
            self.end(kill=True)
            return "hang", None, None
        answer = self.process.stdout.readline().split()
        if answer:
            return tuple(int(word) for word in answer)
        return self.end(), None, None

    def end(self, kill=False):
        process, self.process = self.process, None
        if process is None:
            return None
        if kill:
            process.kill()
        process.stdin.close()
        process.stdout.close()
        return process.wait()


def served(server, attack, case, k, stays, good, alive, folder):
    """The exit code of a run whose allocation k fails, and what is wrong about it."""
    log = folder + ".log"
    code, taken, left = server.call(log, [*run_words(case, folder, STEPS), "--set", "checkpoint.steps=20"], k, stays)
    if code not in EXIT_CODES:
        return code, f"ends with {code}"
    if taken is not None and taken < k:
        code = "not reached"
        return code, "" if state_hash(folder) == good else "another hash without a failure"
    if code == 0:
        return code, "" if state_hash(folder) == good else "another hash, exit code 0"
    if left is not None and left > alive:
        return code, f"{left - alive} arrays are not freed"
    kept = checkpoints(folder)
    for path in kept:
        told, *_ = server.call(log, ["info", path])
        if told != 0:
            return code, f"{path}: {told}"
    if kept:
        told, *_ = server.call(log, ["resume", folder, "--threads", "1", "--no-progress", *common.DEVICE, "--steps", str(STEPS)])
        if told != 0 or state_hash(folder) != good:
            with open(log) as file:
                return code, f"resume ends with {told}: {file.read()[-300:]}"
    return code, ""


def allocations(options, case, drawn, deadline):
    """Every allocation of a run fails, once and from then on. A file of --keep holds those that were done."""
    attack = Attack(f"allocation k on the device fails, {case}", "indices")
    (first, *_), good = counts(attack, case)
    probe = Server(options.gpus[0])
    words = [*run_words(case, attack.path("probe"), STEPS), "--force", "--set", "checkpoint.steps=20"]
    taken = [probe.call(attack.path("probe.log"), words) for _ in range(3)]
    probe.end()
    if not attack.expect(all(answer[0] == 0 for answer in taken), f"{case}: undisturbed runs of one process: {taken}"):
        return attack.end()
    number, alive = max(answer[1] for answer in taken), taken[-1][2]
    attack.expect(alive <= taken[0][2], f"{case}: arrays that are not freed by undisturbed runs of one process: {taken}")
    faults = [(k, stays) for stays in (0, 1) for k in range(1, number + 1)]
    possible = len(faults)
    drawn.shuffle(faults)
    kept = os.path.join(options.keep, f"alloc_{case}.txt") if options.keep else os.devnull
    codes = {}
    if options.keep and os.path.exists(kept):
        with open(kept) as file:
            rows = [line.rstrip("\n").split("\t") for line in file if line.endswith("\n")]
        codes = {(int(row[0]), int(row[1])): row[2] for row in rows}
        for row in rows:
            attack.expect(row[3] == "", f"{case}: k = {row[0]}, stays = {row[1]} (earlier): {row[3]}")
    todo = queue.SimpleQueue()
    for fault in [fault for fault in faults if fault not in codes][:options.runs]:
        todo.put(fault)
    lock = threading.Lock()

    def work(number):
        server = Server(options.gpus[number % len(options.gpus)])
        while time.time() < deadline:
            try:
                k, stays = todo.get_nowait()
            except queue.Empty:
                break
            folder = attack.path(f"run_{number}")
            code, wrong = served(server, attack, case, k, stays, good, alive, folder)
            shutil.rmtree(folder, ignore_errors=True)
            with lock:
                if wrong:
                    wrong = f"in a process that goes on: {wrong}"
                    fault = {"GPU_FAULT_ALLOC": str(k), **({"GPU_FAULT_STAYS": "1"} if stays else {})}
                    before = attack.findings
                    survive(attack, case, fault, good, f"again_{number}")
                    if attack.findings == before:
                        wrong += "; not in one of its own"
                    attack.expect(False, f"{case}: k = {k}, stays = {stays}: {wrong}")
                    server.end(kill=True)
                codes[(k, stays)] = str(code)
                file.write(f"{k}\t{stays}\t{code}\t{' '.join(wrong.split())}\n")
                file.flush()
        server.end()

    with open(kept, "a") as file:
        threads = [threading.Thread(target=work, args=(number,)) for number in range(options.jobs)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    attack.runs = len(codes)
    more = f", {first - number} more in the first run of a process" if first > number else ""
    attack.note = f"of {possible} ({number} allocations{more}); exit codes {json.dumps(dict(sorted(collections.Counter(codes.values()).items())))}"
    return attack.end()


def losses(options, case, drawn):
    attack = Attack(f"device lost at call k, {case}", "indices")
    (_, calls, *_), good = counts(attack, case)
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
    parser.add_argument("--case", choices=list(CASES), nargs="+", default=list(CASES), help="only these")
    parser.add_argument("--gpus", nargs="+", default=[None], help="of allocations: numbers of GPUs, among which the jobs are shared")
    parser.add_argument("--keep", help="of allocations: a folder for what was done, which is left out when called again")
    options = parser.parse_args()
    if options.keep:
        os.makedirs(options.keep, exist_ok=True)
    common.DEVICE += ["--device", options.device]
    drawn = random.Random(options.seed)
    parts = [options.part] if options.part else ["alloc", "lost", "flips"]
    begun, seconds = time.time(), options.seconds
    options.seconds /= len(options.case) * sum(3 if part == "flips" else 1 for part in parts)
    result = 0
    for number, case in enumerate(options.case):
        for part in parts:
            if part == "alloc":  # where it is alone, a case may have what those before it have left of the time
                share = options.seconds if len(parts) > 1 else (begun + seconds - time.time()) / (len(options.case) - number)
                result |= allocations(options, case, drawn, time.time() + share)
            elif part == "lost":
                result |= losses(options, case, drawn)
            else:
                for audit in (0, 4, 1):
                    result |= flips(options, case, drawn, audit)
    return result


if __name__ == "__main__":
    raise SystemExit(main())
