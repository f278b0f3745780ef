"""What the attacks share: the program, small runs of it, their hashes, and one row of the table."""

import argparse
import glob
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
BUILD = os.environ.get("BRECCIA_BUILD", os.path.join(HERE, "..", "..", "build", "release"))
PROGRAM = os.environ.get("BRECCIA", os.path.join(BUILD, "breccia"))
TOOLS = os.path.join(BUILD, "tests", "attack")
CASES = {name: os.path.join(HERE, name + ".toml") for name in ("dem", "fdem", "fdem3", "bolted", "bolted_3d", "fluids", "coupled")}
DEVICE = []  # words that choose the device of `run` and `resume`
HANG = 60  # seconds after which a small run hangs
COLUMNS = "{:<34} {:>9} {:>9} {:>7}  {}"
EXIT_CODES = {0, 2, 3, 4, 5, 7, 8, 9, 10}  # those that the program states


class Attack:
    """A folder for the attack and its row. Findings are printed as they come."""

    def __init__(self, name, unit):
        self.name, self.unit = name, unit
        self.runs = self.findings = 0
        self.note = ""
        self.begun = time.time()
        self.folder = tempfile.mkdtemp(prefix="attack_", dir=memory_folder())

    def path(self, *parts):
        return os.path.join(self.folder, *parts)

    def expect(self, holds, what):
        if not holds:
            self.findings += 1
            print(f"FINDING {self.name}: {what}", file=sys.stderr, flush=True)
        return holds

    def end(self):
        """Prints the row; the exit code is 1 if something was found."""
        shutil.rmtree(self.folder, ignore_errors=True)
        note = f"{time.time() - self.begun:.0f} s {self.note}"
        print(COLUMNS.format(self.name, self.runs, self.findings, self.unit, note), flush=True)
        return 1 if self.findings else 0


def tool(name):
    """What the target `attack` builds; without it no attack would reach the program."""
    path = os.path.join(TOOLS, name)
    if not os.path.exists(path):
        sys.exit(f"{path} is missing: cmake --build {os.path.normpath(BUILD)} --target attack")
    return path


def memory_folder():
    """A disk in memory, if there is one of some size (that of a container is small)."""
    if not os.access("/dev/shm", os.W_OK):
        return None
    about = os.statvfs("/dev/shm")
    return "/dev/shm" if about.f_bavail * about.f_frsize > 4e9 else None


def arguments(about, runs):
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("--runs", type=int, default=runs, help=f"default: {runs}")
    parser.add_argument("--seconds", type=float, default=1e9, help="end after so much time")
    parser.add_argument("--seed", type=int, default=1)
    return parser


def breccia(*words, **more):
    """Runs the program to its end; a run that hangs has the code 'hang'."""
    timeout = more.pop("timeout", HANG)
    environment = dict(os.environ, GOMP_SPINCOUNT="2000", **more.pop("env", {}))
    try:
        done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, errors="replace",
                              timeout=timeout, env=environment, **more)
        return done.returncode, done.stdout + done.stderr
    except subprocess.TimeoutExpired:
        return "hang", ""


def run_words(case, folder, steps):
    return ["run", CASES.get(case, case), "-o", folder, "--threads", "1", "--no-progress",
            "--steps", str(steps), "--set", "output.frames=1", "--set", "output.width=64",
            "--set", "output.height=64", *DEVICE]


def run(case, folder, steps=100, *more, **how):
    return breccia(*run_words(case, folder, steps), *more, **how)


def resume(folder, *more, **how):
    return breccia("resume", folder, "--threads", "1", "--no-progress", *DEVICE, *more, **how)


def state_hash(folder):
    return told(folder, "state_hash")


def status(folder):
    return told(folder, "status")


def told(folder, key):
    """What summary.json says, if it is there."""
    try:
        with open(os.path.join(folder, "summary.json")) as file:
            return json.load(file).get(key)
    except (OSError, ValueError):
        return None


def checkpoints(folder):
    return sorted(glob.glob(os.path.join(folder, "checkpoints", "*.br")))
