#!/usr/bin/env python3
"""Cases with one mistake (what `check` passes, `run` may not refuse), absurd numbers (nothing that is
no finite number may be written), disks that are full, and long outputs (linear in time)."""

import json
import os
import random
import re
import shutil
import sys
import time

from common import Attack, CASES, EXIT_CODES, HERE, arguments, breccia, checkpoints, resume, run, state_hash


def mistake(text, random_):
    """One slip of a writer: a letter, a word, a line, a number, a unit."""
    lines = text.splitlines()
    at = random_.choice([k for k, line in enumerate(lines) if line.strip()])
    line = lines[at]
    kind = random_.randrange(7)
    place = random_.randrange(len(line))
    if kind == 0:
        line = line[:place] + line[place + 1:]
    elif kind == 1:
        line = line[:place] + random_.choice('abcxyz019.-"[]=') + line[place:]
    elif kind == 2:
        line = line[:place] + line[place + 1:place + 2] + line[place:place + 1] + line[place + 2:]
    elif kind == 3:
        lines[at:at + 1] = []
        return "\n".join(lines) + "\n"
    elif kind == 4:
        lines.insert(at, line)
        return "\n".join(lines) + "\n"
    elif kind == 5:
        line = re.sub(r"-?\d+(\.\d+)?", random_.choice(["0", "-1", "1e9", "1e-9", "nan", "7"]), line, count=1)
    else:
        line = re.sub(r"\b(mm|MPa|GPa|deg|ms)\b", random_.choice(["m", "s", "Pa", "kg", "mN"]), line)
    lines[at] = line
    return "\n".join(lines) + "\n"


def typos(options):
    result = 0
    for case in options.case:
        attack = Attack(f"case with a mistake, {case}", "cases")
        random_ = random.Random(options.seed)
        shutil.copy(os.path.join(HERE, "pierced.inp"), attack.folder)
        with open(CASES[case]) as file:
            text = file.read()
        passed = 0
        while attack.runs < options.runs and time.time() - attack.begun < options.seconds / (4 * len(options.case)):
            path = attack.path("case.toml")
            with open(path, "w") as file:
                file.write(mistake(text, random_))
            attack.runs += 1
            code, told = breccia("check", path)
            attack.expect(code in EXIT_CODES, f"check ends with {code}: {told[-300:]}")
            if code != 0:
                attack.expect("case.toml" in told or re.search(r"line \d+", told), f"no place in: {told[-300:]}")
                continue
            passed += 1
            ran, why = breccia("run", path, "-o", attack.path("r"), "--force", "--threads", "1", "-q",
                               "--steps", "2", "--set", "output.frames=0", "--set", "output.pictures=false")
            if ran != 0 and ran != 4 and not attack.expect(ran not in (2, 7), f"check passes: {why[-300:]}"):
                with open(path) as file, open(f"finding.{case}.{attack.runs}.toml", "w") as kept:
                    kept.write(file.read())
            attack.expect(ran in EXIT_CODES, f"run ends with {ran}: {why[-300:]}")
        attack.note = f"({passed} passed by check)"
        result |= attack.end()
    return result


def absurd(options):
    attack = Attack("absurd numbers", "runs")
    settings = {"dem": ["material.c30.density", "material.c30.young", "material.c30.softening",
                        "material.c30.cohesion", "time.safety", "time.end"],
                "fdem": ["material.rock.density", "material.rock.young", "material.rock.joint.tension",
                         "material.rock.joint.energy_open", "time.safety", "time.end"],
                "fdem3": ["material.rock.density", "material.rock.young", "material.rock.joint.tension",
                          "material.rock.joint.energy_open", "material.rock.damping", "time.end"],
                "bolted": ["bolt.bolt.segment", "bolt.bolt.diameter", "bolt.bolt.spacing", "bolt.bolt.young",
                           "bolt.bolt.yield", "bolt.bolt.bond_stiffness", "bolt.bolt.bond_strength",
                           "support.high.servo.area", "support.high.servo.speed", "load.water.viscosity",
                           "load.water.bulk", "load.water.aperture"],
                "bolted_3d": ["bolt.bolt.segment", "bolt.bolt.diameter", "bolt.bolt.young", "bolt.bolt.yield",
                              "bolt.bolt.bond_stiffness", "bolt.bolt.bond_strength", "bolt.bolt.bedding", "bolt.bolt.grout",
                              "bolt.rib.radius", "bolt.rib.area"],
                "fluids": ["load.anfo.explosive." + key for key in ("a", "b", "r1", "r2", "omega", "energy", "charge")],
                "coupled": ["coupling.friction", "bond.border.range", "bond.border.tensile_strength",
                            "bond.border.energy_open", "tetrahedra.material.rock.young",
                            "spheres.material.c30.density"]}
    numbers = ["0", "-1", "5e-324", "1e-300", "1e30", "1e300", "1.7976931348623157e308", "nan", "inf", "-0.0"]
    for case, keys in settings.items():
        for key in keys:
            for number in numbers:
                if attack.runs >= options.runs or time.time() - attack.begun > options.seconds / 4:
                    break
                shutil.rmtree(attack.path("r"), ignore_errors=True)  # a refused run leaves the one before
                code, text = run(case, attack.path("r"), 10, "--force", "--set", f"{key}={number}")
                attack.runs += 1
                attack.expect(code in EXIT_CODES, f"{key}={number}: {code}: {text[-300:]}")
                for name in ("summary.json", "history.csv"):
                    if os.path.exists(attack.path("r", name)):
                        with open(attack.path("r", name)) as file:
                            attack.expect(not re.search(r"\b(nan|inf|NaN|Infinity)\b", file.read()),
                                          f"{key}={number}: {name}")
    return attack.end()


def full(options):
    """RLIMIT_FSIZE, as a quota or a disk that ends: exit code 3, and a checkpoint to go on with."""
    import resource
    attack = Attack("disk full", "limits")
    run("dem", attack.path("good"), 60)
    good = state_hash(attack.path("good"))
    for k in range(1, 1 + min(options.runs, 24)):
        if time.time() - attack.begun > options.seconds / 4:
            break
        limit = 1 << 8 + k // 2
        code, text = run("dem", attack.path("r"), 60, "--force", preexec_fn=lambda: resource.setrlimit(
            resource.RLIMIT_FSIZE, (limit, limit)))
        attack.runs += 1
        attack.expect(code in (0, 3), f"{limit} bytes: {code}: {text[-300:]}")
        if code != 0 and checkpoints(attack.path("r")):
            told, why = resume(attack.path("r"), "--steps", "60")
            attack.expect(told == 0 and state_hash(attack.path("r")) == good, f"resume: {told}: {why[-300:]}")
    return attack.end()


def long(options):
    """Ten times the frames, or rows, may take no more than fourteen times as long."""
    result = 0
    small = 1000 if options.runs >= 1000 else 100
    cases = {"frames": (small, 8.4e-9, [CASES["fdem"]], "output.frames={count}", "elements.pvd", "DataSet"),
             "rows": (100 * small, 1e-6, [os.path.join(HERE, "rows.toml"), "--set", "time.max_step=1e-6"],
                      "output.history=1e-6", "history.csv", "\n")}
    for unit, (few, step, words, every, name, mark) in cases.items():
        attack = Attack(f"long outputs: {unit}", unit)
        taken = []
        for count in (few, 10 * few):
            begun = os.times().children_user
            code, text = breccia("run", words[0], "-o", attack.path("r"), "--force", "--threads", "1", "-q", *words[1:],
                                 "--set", f"time.end={count * step}", "--set", every.format(count=count),
                                 "--set", "output.pictures=false", "--set", "checkpoint.steps=0", timeout=600)
            attack.expect(code == 0, f"{code}: {text[-300:]}")
            taken.append(os.times().children_user - begun)
            with open(attack.path("r", name)) as file:
                written = file.read().count(mark)
            attack.expect(written > 0.85 * count, f"{written} of {count} {unit} in {name}")
            attack.runs += written
        attack.expect(taken[1] < 14 * taken[0] + 0.5, f"{taken} s")
        attack.note = f"({taken[0]:.1f} and {taken[1]:.1f} s)"
        result |= attack.end()
    return result


PARTS = {"typos": typos, "absurd": absurd, "full": full, "long": long}


def main():
    parser = arguments(__doc__, 100)
    parser.add_argument("--part", choices=PARTS, help="only this one")
    parser.add_argument("--case", nargs="+", choices=list(CASES), default=list(CASES), help="mistakes in these alone")
    options = parser.parse_args()
    if options.part is not None:
        options.seconds *= {"typos": 4, "absurd": 4, "full": 4, "long": 1}[options.part]
        return PARTS[options.part](options)
    return typos(options) | absurd(options) | full(options) | long(options)


if __name__ == "__main__":
    sys.exit(main())
