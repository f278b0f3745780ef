#!/usr/bin/env python3
"""SIGKILL at random instants of a run, alone and as one of three ranks, and SIGSTOP of a rank: what
is resumed ends with the hash of the run that nobody disturbed."""

import os
import random
import shutil
import signal
import subprocess
import sys
import time

import common
from common import Attack, CASES, HANG, PROGRAM, arguments, breccia, checkpoints, resume, run, run_words, state_hash, status

STEPS = 400
INTERVAL = 20  # steps between checkpoints, as the cases say


def ranks_of(launcher):
    """The processes of the program below mpirun, which may have helpers between."""
    below, found = [launcher], []
    while below:
        parent = below.pop()
        try:
            with open(f"/proc/{parent}/task/{parent}/children") as file:
                children = [int(word) for word in file.read().split()]
            for child in children:
                below.append(child)
                if os.readlink(f"/proc/{child}/exe") == os.path.realpath(PROGRAM):
                    found.append(child)
        except OSError:
            pass
    return found


def lives(process):
    """Not one that has ended and that nobody has asked for its exit code."""
    try:
        with open(f"/proc/{process}/stat") as file:
            return file.read().rsplit(")", 1)[1].split()[0] not in "ZX"
    except OSError:
        return False


def end_of(child, folder, stopped):
    """The exit code. A rank that is stopped after the run has ended is awaited by nobody but mpirun."""
    begun = time.time()
    while True:
        try:
            return child.wait(1)
        except subprocess.TimeoutExpired:
            if time.time() - begun > HANG:
                raise
        if stopped and status(folder) == "done" and time.time() - begun > 10:
            for process in filter(lives, stopped):
                os.kill(process, signal.SIGCONT)


def started(case, folder, ranks):
    words = [PROGRAM, *run_words(case, folder, STEPS)]
    if ranks > 1:
        words = ["mpirun", "--oversubscribe", "--allow-run-as-root", "-n", str(ranks), *words,
                 "--set", "domain.patience=3"]
    return subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                            env=dict(os.environ, GOMP_SPINCOUNT="2000"))


def state_of(process):
    """What a process that does not end is at: its state and the call of the kernel that it waits in."""
    try:
        with open(f"/proc/{process}/stat") as stat, open(f"/proc/{process}/wchan") as wchan:
            return f"{process} {stat.read().rsplit(')', 1)[1].split()[0]} {wchan.read()}"
    except OSError:
        return f"{process} gone"


def disturb(attack, case, random_, ranks, stop, longest):
    folder = attack.path("run")
    shutil.rmtree(folder, ignore_errors=True)
    child = started(case, folder, ranks)
    begun = time.time()
    if stop:  # before MPI has started, no rank can know of another
        while not os.path.exists(os.path.join(folder, "summary.json")) and time.time() - begun < HANG:
            time.sleep(0.01)
        longest /= 3
    time.sleep(random_.uniform(0.02, longest))
    targets = ranks_of(child.pid) if ranks > 1 else [child.pid]
    hit = bool(targets) and child.poll() is None
    if not hit:  # the run is over, or a busy machine has not yet begun it
        child.kill()
        child.wait()
        for process in targets:
            if lives(process):
                os.kill(process, signal.SIGKILL)
        return
    target = random_.choice(targets)
    when = time.time() - begun
    os.kill(target, signal.SIGSTOP if stop else signal.SIGKILL)
    try:
        code = end_of(child, folder, targets if stop else [])
    except subprocess.TimeoutExpired:
        if ranks == 1 or any(lives(process) for process in targets):
            left = ", ".join(state_of(process) for process in [child.pid, *targets])
            attack.expect(False, f"{case}: did not end in {HANG} s after the signal to {target} at {when:.2f} s of "
                                 f"{longest:.1f}, {len(checkpoints(folder))} checkpoints; mpirun and ranks: {left}")
            for process in ranks_of(child.pid) + [child.pid]:
                os.kill(process, signal.SIGKILL)
            child.wait()
            return
        attack.launcher += 1  # all ranks have ended; Open MPI 4.1.4 sometimes misses one that dies while MPI starts
        child.kill()
        code = child.wait()
    for process in targets:
        if ranks > 1 and lives(process):
            time.sleep(1)
            attack.expect(not lives(process), f"rank {process} is left behind")
    attack.runs += 1
    attack.live += code != 0
    for path in checkpoints(folder):
        told, text = breccia("info", path)
        attack.expect(told == 0, f"{path}: info ends with {told}: {text}")
    if not checkpoints(folder):
        attack.early += 1
        return
    newest = int(os.path.basename(checkpoints(folder)[-1]).split("_")[1].split(".")[0])
    attack.expect(newest % INTERVAL == 0 or code == 0 or stop or ranks > 1,
                  f"a checkpoint of step {newest}")
    if code != 0:
        told, text = resume(folder, "--steps", str(STEPS))
        attack.expect(told == 0, f"{case}: resume ends with {told}: {text}")
    attack.resumed += 1
    attack.expect(state_hash(folder) == attack.hash, f"{case}: hash {state_hash(folder)}")
    left = [name for name in os.listdir(folder) if name.endswith(".tmp")]
    attack.expect(not left, f"left behind: {left}")


def main():
    parser = arguments(__doc__, 20)
    parser.add_argument("--device", help="as --device of the program; then without ranks")
    options = parser.parse_args()
    if options.device:
        common.DEVICE += ["--device", options.device]
    result = 0
    random_ = random.Random(options.seed)
    kinds = [("kill -9", 1, False, options.runs), ("kill -9 of one of 3 ranks", 3, False, options.runs // 4),
             ("SIGSTOP of one of 3 ranks", 3, True, options.runs // 10)]
    for name, ranks, stop, runs in kinds:
        if ranks > 1 and (options.device or shutil.which("mpirun") is None):
            continue
        for case in CASES:
            attack = Attack(f"{name}, {case}", "trials")
            attack.live = attack.early = attack.resumed = attack.launcher = 0
            begun = time.time()
            code, text = run(case, attack.path("good"), STEPS)
            attack.expect(code == 0, f"undisturbed: {code}: {text}")
            attack.hash = state_hash(attack.path("good"))
            if ranks > 1:  # ranks take longer to start, and on a busy machine to run
                begun = time.time()
                attack.expect(started(case, attack.path("ranks"), ranks).wait() == 0, "undisturbed ranks fail")
                attack.expect(state_hash(attack.path("ranks")) == attack.hash, "undisturbed ranks: another hash")
            longest = max(0.05, 1.2 * (time.time() - begun))
            while attack.runs < max(1, runs // len(CASES)) and time.time() - attack.begun < options.seconds / (3 * len(CASES)):
                disturb(attack, case, random_, ranks, stop, longest)
            attack.note = f"({attack.live} hit a live run, {attack.early} before a checkpoint, {attack.resumed} compared" + \
                          (f"; {attack.launcher} times mpirun hung when all ranks had ended)" if attack.launcher else ")")
            result |= attack.end()
    return result


if __name__ == "__main__":
    sys.exit(main())
