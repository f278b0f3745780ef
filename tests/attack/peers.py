#!/usr/bin/env python3
"""What files.py asks of checkpoints, asked of LAMMPS and GROMACS: one bit of a restart file is
flipped, and the run goes on from it. Debian's packages are unpacked below build/peers and nothing
is installed."""

import argparse
import collections
import glob
import os
import random
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
FOLDER = os.path.join(HERE, "../../build/peers")
ROOT = os.path.join(FOLDER, "root")
PACKAGES = ("gromacs gromacs-data libgromacs7 libmuparser2v5 libfftw3-single3 libfftw3-double3 "
            "lammps liblammps0 libkim-api2 libopenmpi3").split()
LIBRARIES = [os.path.join(ROOT, "usr/lib/x86_64-linux-gnu"), os.path.join(ROOT, "usr/lib")]
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", GMXLIB=os.path.join(ROOT, "usr/share/gromacs/top"),
                   GMX_MAXBACKUP="-1", LD_LIBRARY_PATH=":".join(LIBRARIES))

# Grains that overlap a little, with the history of their contacts.
LAMMPS_START = """units si
atom_style sphere
newton off
comm_modify vel yes
region box block 0 0.1 0 0.1 0 0.1
create_box 1 box
lattice sc 0.0099
create_atoms 1 box
set type 1 diameter 0.01
set type 1 density 2500
displace_atoms all random 0.0005 0.0005 0.0005 17
"""
LAMMPS_RULES = """neighbor 0.002 bin
pair_style gran/hertz/history 1e7 NULL 50 NULL 0.5 1
pair_coeff * *
timestep 1e-6
fix 1 all nve/sphere
"""
LAMMPS_END = """dump 1 all custom 300 end.txt id x y z vx vy vz omegax omegay omegaz
dump_modify 1 sort id format float %.17g first no
run 300
"""

TOPOLOGY = """[ defaults ]
1 1 no
[ atomtypes ]
AR 18 39.948 0.0 A 0.0062 9.7e-6
[ moleculetype ]
AR 1
[ atoms ]
1 AR 1 AR AR 1 0.0 39.948
[ system ]
argon
[ molecules ]
AR 216
"""
SETTINGS = """integrator = md
dt = 0.002
nsteps = {steps}
nstxout = {steps}
nstvout = {steps}
cutoff-scheme = Verlet
rvdw = 0.9
rcoulomb = 0.9
rlist = 0.9
gen-vel = {begin}
gen-temp = 100
gen-seed = 3
"""


def unpack():
    if os.path.exists(os.path.join(ROOT, "usr/bin/lmp")):
        return
    packages = os.path.join(FOLDER, "packages")
    os.makedirs(packages, exist_ok=True)
    subprocess.run(["apt-get", "download", *PACKAGES], cwd=packages, check=True, stdout=subprocess.DEVNULL)
    for package in glob.glob(packages + "/*.deb"):
        subprocess.run(["dpkg", "-x", package, ROOT], check=True)


def put(name, text):
    with open(os.path.join(FOLDER, name), "w") as file:
        file.write(text)


def content(name):
    with open(os.path.join(FOLDER, name), "rb") as file:
        return file.read()


def run(program, *words):
    try:
        with open(os.path.join(FOLDER, "told.txt"), "wb") as told:
            return subprocess.run([os.path.join(ROOT, "usr/bin", program), *words], cwd=FOLDER, env=ENVIRONMENT,
                                  stdin=subprocess.DEVNULL, stdout=told, stderr=told, timeout=120).returncode
    except subprocess.TimeoutExpired:
        return "hang"


def must(code):
    """Ends the part of a program that does not run here with what it says."""
    if code != 0:
        said = b" ".join(content("told.txt").split()).decode(errors="replace")
        raise RuntimeError(said[said.rfind("Fatal error:") if "Fatal error:" in said else -300:][:300])


def lammps(script):
    put("in.txt", script)
    return run("lmp", "-log", "none", "-in", "in.txt")


def prepare_lammps():
    must(lammps(LAMMPS_START + LAMMPS_RULES + "run 300\nwrite_restart good\n"))
    return "good", "end.txt", lambda file: lammps(f"read_restart {file}\n" + LAMMPS_RULES + LAMMPS_END)


def prepare_gromacs():
    lines = [f"{1 + k:5}AR      AR{1 + k:5}{0.4 * (k % 6) + 0.1:8.3f}{0.4 * (k // 6 % 6) + 0.1:8.3f}"
             f"{0.4 * (k // 36) + 0.1:8.3f}" for k in range(216)]
    put("argon.gro", "argon\n216\n" + "\n".join(lines) + "\n 2.4 2.4 2.4\n")
    put("topol.top", TOPOLOGY)
    for name, steps in (("first", 100), ("whole", 200)):
        put(name + ".mdp", SETTINGS.format(steps=steps, begin="yes"))
        must(run("gmx", "grompp", "-f", name + ".mdp", "-c", "argon.gro", "-p", "topol.top", "-o", name + ".tpr",
                 "-maxwarn", "9"))
    alone = ["-ntmpi", "1", "-ntomp", "1", "-reprod", "-nb", "cpu", "-g", "md.log", "-e", "ener.edr", "-c", "out.gro"]
    must(run("gmx", "mdrun", "-s", "first.tpr", "-cpo", "good.cpt", "-o", "first.trr", *alone))
    return "good.cpt", "end.part0002.trr", lambda file: run(
        "gmx", "mdrun", "-s", "whole.tpr", "-cpi", file, "-noappend", "-o", "end.trr", "-cpo", "more.cpt", *alone)


def outcome(go_on, file, result, wanted=None):
    for old in glob.glob(os.path.join(FOLDER, "end*")):
        os.remove(old)
    code = go_on(file)
    if code == "hang":
        return "hung"
    if code < 0:
        return "ended by a signal"
    if code > 0 or not os.path.exists(os.path.join(FOLDER, result)):
        return "refused"
    return "loaded, same result" if content(result) == wanted else "loaded, another result"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=100, help="flips of each program; default: 100")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    unpack()
    for name, prepare in (("LAMMPS", prepare_lammps), ("GROMACS", prepare_gromacs)):
        try:
            good, result, go_on = prepare()
            must(go_on(good))
        except RuntimeError as error:
            print(f"{name} does not run here: {error}")
            continue
        wanted = content(result)
        if outcome(go_on, good, result, wanted) != "loaded, same result":
            sys.exit(f"{name}: the undamaged file does not give the same result twice")
        drawn, counts = random.Random(options.seed), collections.Counter()
        for _ in range(options.runs):
            damaged = bytearray(content(good))
            damaged[drawn.randrange(len(damaged))] ^= 1 << drawn.randrange(8)
            with open(os.path.join(FOLDER, "damaged.cpt"), "wb") as file:
                file.write(damaged)
            counts[outcome(go_on, "damaged.cpt", result, wanted)] += 1
        print(f"{name}, one bit of {len(damaged)} bytes flipped, {options.runs} files: "
              + ", ".join(f"{n} {what}" for what, n in counts.most_common()), flush=True)


if __name__ == "__main__":
    main()
