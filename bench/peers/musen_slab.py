"""The slab of cases/rc_slab in MUSEN: its scene as text, and a run of windows of steps.

Usage: musen_slab.py CMUSEN FOLDER [--device gpu|cpu] [--threads N] [--steps N] [--windows N] [--copies N] [--still] [--whole] [--energy]

FOLDER holds elements.csv and links.csv as `breccia bench --paced` exports them, and dt.txt, the time step in s. The elements
are those of Breccia: same places, radii, masses, velocity; held ones are a million million times as heavy. Every link of
Breccia becomes a solid bond of the model Elastic: a round beam of the smaller end's radius, with moments, that breaks at
once by its axial and bending or its shear and twisting stress. Only spheres without a bond touch, after Hertz and Mindlin.

MUSEN prints a line whenever it saves. It saves after each window, next to nothing; the time from line to line counts, less that
of a save. The first window goes before. The last line says all as JSON.
"""
import argparse
import json
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

from lammps_slab import COHESION, SHEAR, SPEED, TENSION, YOUNG, rows

HELD = 1e12
PITCH = 2.0  # of copies, m
NEVER = 1e30
SAVES = 21
# how many values follow the number of a meaning
COUNTS = {"2": 1, "12": 3, "15": 3, "16": 3, "18": 1, "20": 3, "31": 4, "36": 9, "37": 1, "42": 3, "43": 1, "45": 3}


def read(folder):
    elements = [{k: v if k == "group" else float(v) for k, v in row.items()} for row in rows(folder / "elements.csv")]
    links = [(int(row["a"]), int(row["b"])) for row in rows(folder / "links.csv")]
    return elements, links


def kind(element):
    """Key of the material, one for each density. @returns key, density in kg/m3"""
    density = element["mass"] / (4 / 3 * math.pi * element["radius"]**3)
    if element["fixed"]:
        return "HELD", 4000 * HELD
    return ("STEEL" if element["group"] == "steel" else "CONCRETE"), density


def write_scene(path, elements, links, given):
    """The scene in MUSEN's words: lines of numbers, each with the number of its meaning before it."""
    shift = [(PITCH * (c % round(math.sqrt(given.copies))), PITCH * (c // round(math.sqrt(given.copies)))) for c in range(given.copies)]
    strength = (NEVER, NEVER) if given.whole else (TENSION, COHESION)
    materials = {"BOND": 2400.0}
    ends = []  # of each bond: distance and diameter
    for a, b in links:
        p, q = elements[a], elements[b]
        ends.append((2 * min(p["radius"], q["radius"]), math.dist((p["x"], p["y"], p["z"]), (q["x"], q["y"], q["z"]))))
    with open(path, "w") as out:
        number = 0
        for right, back in shift:
            for e in elements:
                key, density = kind(e)
                materials.setdefault(key, density)
                down = -SPEED if e["group"] == "impactor" and not given.still else 0
                out.write(f"0 {number} 1 1 5 {e['radius']:.17g} {e['radius']:.17g} 23 {key} 24 0 1e+300 2 0 12 {e['x'] + right:.17g} "
                          f"{e['y'] + back:.17g} {e['z']:.17g} 15 0 0 {down} 16 0 0 0 31 1 0 0 0\n")
                number += 1
        for copy in range(given.copies):
            first = copy * len(elements)
            for (a, b), (diameter, length) in zip(links, ends):
                out.write(f"0 {number} 1 9 5 {a + first} {b + first} {diameter:.17g} {length:.17g} 23 BOND 24 0 1e+300 2 0 20 0 0 0\n")
                number += 1
        far = 2 + PITCH * max(max(s) for s in shift)
        out.write(f"22 -2 -2 -2 {far:g} {far:g} 2\n28 0 0 0 0 0 0 0 0 0 0\n29 0\n30 0\n")
        for key, density in materials.items():
            out.write(f"32 {key} {key.lower()} 0 {density:.17g} 2 1 3 1 7 {YOUNG:g} 8 {strength[0]:g} 9 {strength[1]:g} "
                      f"10 {YOUNG / (2 * SHEAR) - 1:g} 13 0.1\n")
        for key in materials:
            for other in materials:
                out.write(f"33 {key} {other} 200 1 201 0.5 202 0\n")


def simulation(folder, given, dt, steps, windows):
    """The job that runs: it saves after each window, and takes half a step more."""
    save_nothing = "" if given.energy else "SELECTIVE_SAVING_P 0 0 0 0 0 0 0\nSELECTIVE_SAVING_SB 0 0 0\n"
    return f"""JOB
SOURCE_FILE {folder}/scene.mdem
RESULT_FILE {folder}/run_{steps}.mdem
COMPONENT SIMULATOR
SIMULATOR_TYPE {given.device.upper()}
MODEL_PP ModelPPHertzMindlin
MODEL_SB ModelSBElastic
MODEL_SB_PARAMS CONSIDER_BREAKAGE {0 if given.whole else 1}
CONNECTED_PP_CONTACT NO
SIMULATION_STEP {dt!r}
SAVING_STEP {steps * dt!r}
END_TIME {(windows * steps + 0.5) * dt!r}
EXT_ACCEL 0 0 0
VARIABLE_TIME_STEP NO
{save_nothing}"""


def script(folder, given, dt):
    """The jobs: text into a scene; windows of one step, which are almost all saving; the run; the scene at its end into text."""
    return f"""JOB
SOURCE_FILE {folder}/scene.txt
RESULT_FILE {folder}/scene.mdem
COMPONENT IMPORT_FROM_TEXT
{simulation(folder, given, dt, 1, SAVES)}{simulation(folder, given, dt, given.steps, given.windows + 1)}JOB
SOURCE_FILE {folder}/run_{given.steps}.mdem
RESULT_FILE {folder}/end.txt
COMPONENT EXPORT_TO_TEXT
TIME_INTERVAL {((given.windows + 1) * given.steps - 0.5) * dt!r} 1
TEXT_EXPORT_PRECISION 12
TEXT_EXPORT_OBJECTS {"YES" if given.energy else "NO"} YES NO
{"" if given.energy else "TEXT_EXPORT_TD_BOND NO NO NO NO NO NO NO"}
"""


def run(command):
    """Runs MUSEN. @returns times of the lines that it prints at each save [s], all lines"""
    process = subprocess.Popen(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    saves, said = [], []
    for line in process.stdout:
        said.append(line)
        if line.startswith("Current time"):
            saves.append(time.perf_counter())
    if process.wait() != 0:
        raise SystemExit(f"MUSEN ended with {process.returncode}:\n" + "".join(said[-15:]))
    return saves, said


def objects(path):
    """Spheres and bonds of a text: their constant words, and their values at the last time by the number of the meaning."""
    with open(path) as lines:
        for line in lines:
            words = line.split()
            if words[:1] != ["0"] or words[2:4] not in (["1", "1"], ["1", "9"]):
                continue
            constant = 12 if words[3] == "1" else 14  # words up to the interval in which it is active, with its two ends
            values, place = {}, constant
            while place < len(words):
                count = COUNTS[words[place]]
                values[words[place]] = [float(w) for w in words[place + 1:place + 1 + count]]
                place += 1 + count
            yield words[:constant], values


def bonds_left(path):
    """Bonds that are whole at the end: the interval in which they are active does not end."""
    return sum(constant[3] == "9" and float(constant[-1]) > 1e299 for constant, _ in objects(path))


def energies(path, elements):
    """Of the end, in J: motion of spheres that are not held, and strain of bonds, bending and twist taken as bending."""
    motion, strain, places = 0.0, 0.0, []
    for constant, values in objects(path):
        if constant[3] == "1":
            e = elements[len(places) % len(elements)]
            places.append(values["12"])
            if e["fixed"] == 0:
                square = sum(v * v for v in values["15"]) + 0.4 * e["radius"]**2 * sum(w * w for w in values["16"])
                motion += 0.5 * e["mass"] * square
        elif float(constant[-1]) > 1e299:
            a, b, radius, length = int(constant[5]), int(constant[6]), float(constant[7]) / 2, float(constant[8])
            axis = [q - p for p, q in zip(places[a], places[b])]
            along = sum(f * x for f, x in zip(values["20"], axis)) / math.hypot(*axis)
            square, section = sum(f * f for f in values["20"]), math.pi * radius**2
            strain += length / 2 * (along**2 / (YOUNG * section) + (square - along**2) / (SHEAR * section)
                                    + values["43"][0]**2 / (YOUNG * section * radius**2 / 4))
    return {"motion": motion, "strain": strain, "at_start": 0.5 * SPEED**2 * sum(e["mass"] for e in elements if e["group"] == "impactor")}


def main():
    options = argparse.ArgumentParser()
    options.add_argument("program")
    options.add_argument("folder", type=pathlib.Path)
    options.add_argument("--device", choices=("gpu", "cpu"), default="gpu")
    options.add_argument("--threads", type=int, default=1, help="of the CPU; on a GPU they search")
    options.add_argument("--steps", type=int, default=2000, help="of a window")
    options.add_argument("--windows", type=int, default=5)
    options.add_argument("--copies", type=int, default=1, help="slabs side by side")
    options.add_argument("--still", action="store_true", help="the rock stands still")
    options.add_argument("--whole", action="store_true", help="bonds do not break")
    options.add_argument("--energy", action="store_true", help="saves all, and tells the energy at the end")
    given = options.parse_args()
    dt = float((given.folder / "dt.txt").read_text())
    elements, links = read(given.folder)
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        write_scene(folder / "scene.txt", elements, links, given)
        (folder / "script.txt").write_text(script(folder, given, dt))
        saves, said = run([given.program, f"-threads={given.threads}", f"-script={folder / 'script.txt'}"])
        text = "".join(said)
        if len(saves) != SAVES + given.windows + 1 or "Error" in text:
            raise SystemExit("MUSEN did not take the steps:\n" + text[-3000:])
        save = statistics.median(b - a for a, b in zip(saves, saves[1:SAVES]))  # and one step
        counted = {name: int(line.split(":")[1]) for line in said for name in ("particles", "solid bonds")
                   if line.startswith(f"Total number of {name}")}
        result = {"program": f"MUSEN, {given.device.upper()}" + (f", {given.threads} threads" if given.device == "cpu" else ""),
                  "elements": counted["particles"], "links": counted["solid bonds"], "links_at_end": bonds_left(folder / "end.txt"),
                  "steps": given.steps * given.windows, "us_of_a_save": 1e6 * save,
                  "us_a_step": [1e6 * (b - a - save) / (given.steps - 1) for a, b in zip(saves[SAVES:], saves[SAVES + 1:])]}
        if given.energy:
            result["energy"] = energies(folder / "end.txt", elements)
    print(json.dumps(result))


if __name__ == "__main__":
    sys.exit(main())
