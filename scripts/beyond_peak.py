#!/usr/bin/env python3
"""Concretes as the library had them while turns wore their links (`keyed_specimens.WORN`), with other keys, in prisms pressed to three times the strain of their peak and in specimens of `breccia test`, for docs/trials-concrete.md.

    scripts/beyond_peak.py [--group alone] [--packings 5,6,7] [--elements 600] [--only TEXT] [--binary build/release/breccia] [--jobs 1] [--record docs/results/beyond_peak.csv]

Groups: `alone`, keys of that C30 changed one by one; `beside`, likewise beside turn_wear = 0 and half of its cohesion; `drawn`, eleven keys at once, 60 sets by a Latin hypercube, all of 600
elements; `calibrated`, sets whose T and C were found so that prisms of 1,200 elements (packings 1 to 4) show f_c and f_t of their concrete (--elements 600,1200,2400); `compaction`, C30 without turn_wear whose links yield earlier; `early`, likewise all five, with other bounds on friction,
from which the keys of the library were taken (--packings 5,6). --only: sets with it in their
name. Runs are in out/beyond_peak/; called again, only what is missing is run. --record replaces lines of these runs in that file.
"""
import argparse
import csv
import json
import math
import pathlib
import random
import re
import statistics
import subprocess

import keyed_specimens
import library_runs
import published_runs
from library_tables import newman, targets_of

ROOT = pathlib.Path(__file__).resolve().parent.parent
OUT = ROOT / "out" / "beyond_peak"
RECORD = ["group", "set", "elements", "test", "specimen", "commit", "hash", "quantity", "value"]
CASE_KEYS = ("use", "end", "range", "size_ratio", "local_damping", "height")  # of the specimen, all others of the material
CORNER = {"criterion": "corner", "cohesion": 9.078e6, "friction_angle": 0.1745}
ALONE = {"as it is": {}, "turn_wear 0": {"turn_wear": 0.0}, "turn_wear 0.01": {"turn_wear": 0.01}, "turn_wear 0.03": {"turn_wear": 0.03}, "slip_wear 0": {"slip_wear": 0.0}, "slip_wear 0.1": {"slip_wear": 0.1},
         "slip_wear 1": {"slip_wear": 1.0}, "slip_wear 0, turn_wear 0": {"slip_wear": 0.0, "turn_wear": 0.0}, "mu_b 3": {"broken_friction": 3.0}, "mu_b 3, eta_b 3": {"broken_friction": 3.0, "broken_rolling_limit": 3.0},
         "s_M 1.2 MPa": {"rolling_cap": 1.2e6}, "s_M 10 MPa": {"rolling_cap": 10e6}, "eta 0.5, s_M 30 MPa": {"rolling_limit": 0.5, "rolling_cap": 30e6}, "beta_r 0.25": {"rolling_stiffness": 0.25},
         "beta_r 4": {"rolling_stiffness": 4.0}, "link_damping 1, its time 0.4": {"link_damping": 1.0, "link_damping_time": 0.4}, "local damping 0.3": {"local_damping": 0.3}, "local damping 0.05": {"local_damping": 0.05},
         "Y_b none": {"crushing_strength": 0.0}, "Y_b 30 MPa": {"crushing_strength": 30e6}, "G_F twice": {"fracture_energy": 282.0}, "G_F four times": {"fracture_energy": 564.0}, "phi_i 10 deg": {"friction_angle": 0.1745},
         "phi_i 45 deg": {"friction_angle": 0.785}, "s_F 10 MPa": {"friction_cap": 10e6}, "C 15 MPa": {"cohesion": 15e6}, "a corner, C 9.1 MPa": CORNER, "range 1.25": {"range": 1.25}, "range 1.7": {"range": 1.7},
         "size_ratio 1.2": {"size_ratio": 1.2}, "size_ratio 3": {"size_ratio": 3.0}, "prism 0.1 m high": {"height": 0.1}, "prism 0.4 m high": {"height": 0.4}, "no knee": {"knee_strength": 0.0}, "nu 0.12": {"poisson": 0.12},
         "fabric even": {"fabric": "even"}, "fabric packed": {"fabric": "packed"}}
HALF = {"turn_wear": 0.0, "cohesion": 22e6}
BESIDE = {"nothing else": {}, "slip_wear 0": {"slip_wear": 0.0}, "slip_wear 0.03": {"slip_wear": 0.03}, "slip_wear 0.1": {"slip_wear": 0.1}, "slip_wear 1": {"slip_wear": 1.0}, "turn_wear 0.01": {"turn_wear": 0.01}, "turn_wear 0.003": {"turn_wear": 0.003},
          "C 15 MPa": {"cohesion": 15e6}, "C 30 MPa": {"cohesion": 30e6}, "T 2.1 MPa": {"tensile_strength": 2.1e6}, "T 2.8 MPa": {"tensile_strength": 2.8e6}, "mu_b 0.3": {"broken_friction": 0.3}, "mu_b 1": {"broken_friction": 1.0},
          "mu_b 2": {"broken_friction": 2.0}, "eta_b 0.3": {"broken_rolling_limit": 0.3}, "eta_b 3": {"broken_rolling_limit": 3.0}, "s_M 1.2 MPa": {"rolling_cap": 1.2e6}, "s_M 5 MPa": {"rolling_cap": 5e6},
          "eta 0.5, s_M 9.4 MPa, eta_b 0.25": {"rolling_limit": 0.5, "rolling_cap": 9.4e6, "broken_rolling_limit": 0.25}, "phi_i 10 deg": {"friction_angle": 0.1745}, "phi_i 20 deg": {"friction_angle": 0.349}, "phi_i 40 deg": {"friction_angle": 0.698},
          "s_F 2.5 MPa": {"friction_cap": 2.5e6}, "s_F 7 MPa": {"friction_cap": 7e6}, "smooth, s_F 11 MPa": {"friction_bound": "smooth", "friction_cap": 11e6}, "G_F twice": {"fracture_energy": 282.0}, "knee 0.1": {"knee_strength": 0.1},
          "knee 0.4": {"knee_strength": 0.4}, "no knee": {"knee_strength": 0.0}, "nu 0.12": {"poisson": 0.12}, "nu 0.22": {"poisson": 0.22}, "beta_r 0.5": {"rolling_stiffness": 0.5}, "beta_r 2": {"rolling_stiffness": 2.0},
          "range 1.3": {"range": 1.3}, "range 1.6": {"range": 1.6}, "size_ratio 1.3": {"size_ratio": 1.3}, "size_ratio 3": {"size_ratio": 3.0}, "Y_b none": {"crushing_strength": 0.0}, "Y_b 30 MPa": {"crushing_strength": 30e6},
          "Y_c 40 MPa": {"compaction_strength": 40e6}, "link_damping 0.1": {"link_damping": 0.1}, "link_damping 1, its time 0.4": {"link_damping": 1.0, "link_damping_time": 0.4}, "link_damping_time 1": {"link_damping_time": 1.0},
          "a corner, C 9.1 MPa": CORNER, "a corner, C 6 MPa": CORNER | {"cohesion": 6e6}, "fabric even": {"fabric": "even"}, "local damping 0.3": {"local_damping": 0.3}, "local damping 0.05": {"local_damping": 0.05}}
# Keys that are drawn: on a line or by their logarithm, between two ends; and what a slope is by.
DRAWN = {"turn_wear": (False, 0.0, 0.01), "slip_wear": (True, 0.02, 0.5), "cohesion": (True, 8e6, 35e6), "rolling_cap": (True, 1e6, 5e6), "friction_angle": (False, 0.17, 0.7), "friction_cap": (True, 2e6, 6e6), "broken_friction": (True, 0.4, 1.5),
         "broken_rolling_limit": (True, 0.3, 2.0), "poisson": (False, 0.12, 0.2), "tensile_strength": (False, 2.1e6, 2.8e6), "knee_strength": (False, 0.1, 0.4)}
BY = {"turn_wear": lambda v: 100 * v, "friction_angle": lambda v: math.log(math.tan(v))}


def drawn(count=60):
    """Each key has one value in each of `count` parts of its range."""
    rng, columns = random.Random(7), {}
    for key, (logarithm, low, high) in DRAWN.items():
        order = list(range(count))
        rng.shuffle(order)
        shares = [(i + rng.random()) / count for i in order]
        columns[key] = [float(f"{low * (high / low) ** share if logarithm else low + (high - low) * share:.4g}") for share in shares]
    sets = {f"{i:02d}": {key: columns[key][i] for key in DRAWN} for i in range(count)}
    return {name: keys | {"turn_wear": keys["turn_wear"] if keys["turn_wear"] >= 0.002 else 0.0} for name, keys in sets.items()}


SPECIMENS = ("prism", "triaxial_5", "tension", "triaxial_20", "platens_prism", "tension_notched")
WHOLE = (*SPECIMENS, "platens_cube", "compression_cube", "compression_prism", "brazilian", "bending_thirds", "oedometer", "triaxial_50", "triaxial_100")


def kept(use, end, tension, cohesion, **keys):
    """A calibrated set: its concrete, how long its prism is pressed [ms], T and C [MPa]."""
    return {"use": use, "end": end, "tensile_strength": round(tension * 1e6, 3), "turn_wear": 0.0, **keys, "cohesion": round(cohesion * 1e6, 3)}


CALIBRATED = {"C30 turn_wear 0": kept("C30", 12.0, 2.432, 30.47), "C30 turn_wear 0.004": kept("C30", 12.0, 2.432, 30.53, turn_wear=0.004),
              "C30 turn_wear 0, slip_wear 0.1": kept("C30", 12.0, 2.384, 17.29, slip_wear=0.1), "C30 turn_wear 0, eta_b 0.3, mu_b 0.3": kept("C30", 12.0, 2.432, 30.47, broken_rolling_limit=0.3, broken_friction=0.3),
              "C30 turn_wear 0, link_damping_time 1": kept("C30", 12.0, 2.415, 26.88, link_damping_time=1.0), "C30 turn_wear 0, Y_c 40 MPa": kept("C30", 12.0, 2.432, 29.81, compaction_strength=40.2e6),
              "C30 turn_wear 0, Y_c 25 MPa": kept("C30", 12.0, 2.433, 29.70, compaction_strength=25e6),
              "C30 turn_wear 0, Y_c 40 MPa, slip_wear 0.1, link_damping_time 1": kept("C30", 12.0, 2.370, 16.53, slip_wear=0.1, compaction_strength=40.2e6, link_damping_time=1.0),
              "C20 turn_wear 0": kept("C20", 11.0, 1.719, 21.13), "C40 turn_wear 0": kept("C40", 14.0, 3.049, 39.40), "C60 turn_wear 0": kept("C60", 17.0, 3.790, 62.74), "C100 turn_wear 0": kept("C100", 21.0, 4.380, 111.8),
              "C60 turn_wear 0, Y_c 72 MPa": kept("C60", 17.0, 3.790, 63.01, compaction_strength=72e6), "C100 turn_wear 0, Y_c 114 MPa": kept("C100", 21.0, 4.380, 110.5, compaction_strength=114.3e6)}
COMPACTION = {"Y_c 70.6 MPa": {}, "Y_c 30 MPa": {"compaction_strength": 30e6}, "Y_c 20 MPa": {"compaction_strength": 20e6}, "Y_c 12 MPa": {"compaction_strength": 12e6},
              "Y_c 20 MPa, H_c 0.7": {"compaction_strength": 20e6, "compaction_slope": 0.7}, "Y_c 12 MPa, H_c 0.7": {"compaction_strength": 12e6, "compaction_slope": 0.7}, "Y_c 20 MPa, H_c 0.1": {"compaction_strength": 20e6, "compaction_slope": 0.1}}
GRADE = {"C20": 28, "C30": 38, "C40": 48, "C60": 68, "C100": 108}  # f_c [MPa]


def early():
    """Sets without turn_wear: how early links yield under pressure (Y_c over f_c, H_c), and how friction is bounded (sharp, or smooth with s_F over f_c)."""
    sets = {}

    def add(name, grade, share, times, **keys):
        first = CALIBRATED[f"{grade} turn_wear 0"]
        sets[f"{grade}, {name}"] = first | keys | {"end": times * first["end"], "cohesion": round(share * first["cohesion"] * 1e-6, 2) * 1e6}

    def yields(grade, over):
        return round(over * GRADE[grade], 1) * 1e6

    for grade in GRADE:
        for over in YIELDS:
            for slope in SLOPES:
                add(f"Y_c {over:g} f_c, H_c {slope:g}", grade, 0.85, 1.5, compaction_strength=yields(grade, over), compaction_slope=slope)
    pores = {"compaction_strength": 13e6, "compaction_slope": 0.5}
    for name, share, keys in (("", 0.85, {}), ("C 20 MPa", 0.65, {}), ("s_F 4.4 MPa", 0.75, {"friction_cap": 4.4e6}), ("s_F 5.3 MPa", 0.65, {"friction_cap": 5.3e6}), ("slip_wear 0.15", 0.65, {"slip_wear": 0.15}),
                              ("slip_wear 0.6", 1.2, {"slip_wear": 0.6}), ("nu 0.16", 0.7, {"poisson": 0.16}), ("H_c 0.7", 0.85, {"compaction_slope": 0.7}), ("smooth, s_F 8 MPa", 0.7, {"friction_bound": "smooth", "friction_cap": 8e6}),
                              ("Y_b 6 MPa", 0.85, {"crushing_strength": 6e6})):
        add("Y_c 13 MPa" + (name and f", {name}"), "C30", share, 1.5, **pores | keys)
    pores = {"compaction_strength": 65e6, "compaction_slope": 0.4}
    for name, share, keys in (("", 0.85, {}), ("C 67 MPa", 0.6, {}), ("s_F 12.5 MPa", 0.7, {"friction_cap": 12.5e6}), ("s_F 7.5 MPa", 0.9, {"friction_cap": 7.5e6}), ("slip_wear 0.1", 0.6, {"slip_wear": 0.1})):
        add("Y_c 65 MPa" + (name and f", {name}"), "C100", share, 1.5, **pores | keys)

    def smooth(name, grade, bound, over, share, slope=0.5, **keys):
        add(f"smooth, s_F {bound:g} f_c, Y_c {over:g} f_c" + (name and f", {name}"), grade, share, 1.4, friction_bound="smooth", friction_cap=round(bound * GRADE[grade], 2) * 1e6, compaction_strength=yields(grade, over), compaction_slope=slope, **keys)

    for grade, bounds, overs, share in (("C20", (0.21, 0.3), (0.2, 0.35), 0.6), ("C30", (0.17, 0.21, 0.26), (0.25, 0.45), 0.65), ("C40", (0.13, 0.18, 0.23), (0.35, 0.55), 0.65), ("C60", (0.08, 0.12, 0.17), (0.4, 0.6), 0.65),
                                        ("C100", (0.06, 0.1, 0.15), (0.5, 0.8), 0.65)):
        for bound in bounds:
            for over in overs:
                smooth("", grade, bound, over, share)
    for name, share, keys in (("slip_wear 0.2", 0.55, {"slip_wear": 0.2}), ("slip_wear 0.5", 0.8, {"slip_wear": 0.5}), ("mu_b 0.4, eta_b 0.5", 0.65, {"broken_friction": 0.4, "broken_rolling_limit": 0.5}), ("phi_i 20 deg", 0.7, {"friction_angle": "20 deg"}),
                              ("phi_i 40 deg", 0.6, {"friction_angle": "40 deg"})):
        smooth(name, "C30", 0.21, 0.35, share, **keys)
    smooth("phi_i 20 deg", "C100", 0.1, 0.6, 0.75, friction_angle="20 deg")
    smooth("phi_i 40 deg", "C100", 0.1, 0.6, 0.6, friction_angle="40 deg")
    smooth("H_c 0.4", "C100", 0.1, 0.4, 0.6, slope=0.4)
    return sets


YIELDS, SLOPES = (0.2, 0.35, 0.6, 1.06), (0.4, 0.55)  # Y_c over f_c, H_c
GROUPS = {"alone": (ALONE, SPECIMENS[:3]), "beside": ({name: HALF | keys for name, keys in BESIDE.items()}, SPECIMENS), "drawn": (drawn(), SPECIMENS), "calibrated": (CALIBRATED, WHOLE),
          "compaction": ({name: {"turn_wear": 0.0, "cohesion": 30e6} | keys for name, keys in COMPACTION.items()}, (*SPECIMENS[:4], "oedometer", "triaxial_100")),
          "early": (early(), (*SPECIMENS[:2], "triaxial_20", "triaxial_50", "triaxial_100", "oedometer", "platens_prism", "platens_cube"))}


# ---------------------------------------------------------------- runs

def text_of(value):
    return f'"{value}"' if isinstance(value, str) else repr(value)


def material(keys):
    return "".join(f"{key} = {text_of(value)}\n" for key, value in keys.items() if key not in CASE_KEYS)


def pack(keys, count):
    return f'pack = {{ count = {count}, size_ratio = {keys.get("size_ratio", 2.0)}, compactness = 0.56 }}\n'


def prism(keys, elements, seed):
    """Between smooth ends, 0.6/s, to 0.75 % of strain, or as long as `end` says, ms."""
    height = keys.get("height", 0.2)
    layer = height / 2 - 2 * (0.75 * library_runs.AREA * 0.2 * 0.56 / (math.pi * elements)) ** (1 / 3)
    text = (f'breccia = 1\nmethod = "dem3d"\ntitle = "trial"\nseed = {seed}\nlocal_damping = {keys.get("local_damping", 0.0)}\n\n[time]\nend = {keys.get("end", 13.0) * 1e-3}\n\n[output]\nframes = 0\nhistory = {5e-3 / 0.6 / 1000}\n'
            f'fields = false\npictures = false\n\n[energy]\nstop = 0.1\n\n[search]\nmargin = 0.5\n\n[links]\nrange = {keys.get("range", 1.443)}\n\n[contact]\nlaw = "linear"\n'
            f'\n[material.c30]\nuse = "{keys.get("use", "C30")}"\nrate = "none"\n{material(keys)}[[body]]\nname = "specimen"\nshape = "box"\nmaterial = "c30"\nsize = [0.1, 0.1, {height}]\n'
            + pack(keys, round(elements * height / 0.2)))
    for name, low, high, speed in (("top", layer, 1.0, -0.5 * 0.6 * height), ("bottom", -1.0, -layer, 0.5 * 0.6 * height)):
        text += f'\n[[support]]\nname = "{name}"\nmin = [-1.0, -1.0, {low}]\nmax = [1.0, 1.0, {high}]\nfix = ["z"]\nvelocity = [0.0, 0.0, {speed}]\nramp = {0.1 * 5e-3 / 0.6}\n'
    return text + library_runs.probes()


def sample(keys):
    """A case from which `breccia test` takes the material, links and the packing."""
    return (f'breccia = 1\nmethod = "dem3d"\n[time]\nend = 1e-3\n[links]\nrange = {keys.get("range", 1.443)}\n[contact]\nlaw = "linear"\n[material.c30]\nuse = "{keys.get("use", "C30")}"\n{material(keys)}'
            f'[[body]]\nname = "b"\nmaterial = "c30"\nsize = [0.1, 0.1, 0.1]\n' + pack(keys, 300))


def run(group, name, test, elements, packing, given):
    keys = GROUPS[group][0][name]
    keys, folder = keyed_specimens.WORN[keys.get("use", "C30")] | keys, OUT / f"{group}-{name}-{test}-{elements}-{packing}".replace(" ", "_")
    if keyed_specimens.summary_of(folder):
        return
    case = OUT / f"{folder.name}.toml"
    case.write_text(prism(keys, elements, packing) if test == "prism" else sample(keys))
    if test == "prism":
        command = ["run", case, "-o", folder, "--threads", 1, "--force", "--no-progress"]
    else:
        command = ["test", case, "--material", "c30", "--only", test, "--seeds", 1, "--first-seed", packing, "--elements", elements, "--jobs", 1, "--threads", 1, "-o", folder]
        command += ["--damping", keys["local_damping"]] if "local_damping" in keys else []
    done = subprocess.run([str(part) for part in (given.binary, *command)], stdout=subprocess.DEVNULL)
    if done.returncode not in (0, 9):
        raise SystemExit(f"{folder.name} ended with {done.returncode}")
    summary = keyed_specimens.summary_of(folder)
    numbers = library_runs.of_prism(folder) if test == "prism" else keyed_specimens.shown(folder)
    (folder / "numbers.json").write_text(json.dumps([dict(zip(RECORD, (group, name, elements, test, packing, summary["breccia"]["commit"], summary["state_hash"], quantity, f"{value:.6g}")))
                                                     for (quantity, _), value in numbers.items() if quantity in KEPT[test]]))


KEPT = {"prism": ("strength", "peak_strain", "left_2", "residual"), "tension": ("strength", "poisson"), "tension_notched": ("fracture_energy",), "platens_prism": ("strength", "residual")}
KEPT |= {f"triaxial_{pressure}": ("strength", "peak_strain") for pressure in (5, 20, 50, 100, 200)} | {"oedometer": ("strain_100", "strain_1000", "tangent_300", "tangent_800", "side_ratio"), "compression_prism": ("strength", "young", "poisson", "residual")}
KEPT |= {test: ("strength",) for test in ("platens_cube", "compression_cube", "brazilian", "bending_thirds", "bending")}


# ---------------------------------------------------------------- tables

def numbers_of(lines, group):
    """{set: {quantity: {packing: value}}} with what is made of two specimens of one packing."""
    found = {}
    for one in lines:
        if one["group"] == group and math.isfinite(float(one["value"])):
            found.setdefault(one["set"], {}).setdefault((one["test"], one["quantity"]), {})[one["specimen"]] = float(one["value"])
    for of in found.values():
        f_c = of.get(("prism", "strength"), {})
        for pressure in (5, 20):
            s1 = of.get((f"triaxial_{pressure}", "strength"), {})
            of[f"slope_{pressure}", ""] = {packing: (s1[packing] - f_c[packing]) / pressure for packing in s1 if packing in f_c}
        strain, rough = of.get(("prism", "peak_strain"), {}), of.get(("platens_prism", "strength"), {})
        of["strain_over", ""] = {packing: strain[packing] / f_c[packing] for packing in f_c}
        of["rough_over", ""] = {packing: rough[packing] / f_c[packing] for packing in rough if packing in f_c}
    return found


COLUMNS = (("f_c, MPa", ("prism", "strength"), 1, None), ("strain there, 1e-3", ("prism", "peak_strain"), 2, None), ("left at 3 times it (0.1 to 0.2)", ("prism", "residual"), 3, (0.1, 0.2)),
           ("5 MPa add (4 to 5)", ("slope_5", ""), 1, (4.0, 5.0)), ("f_t, MPa", ("tension", "strength"), 2, None))
MORE = (("20 MPa add", ("slope_20", ""), 2, None), ("rough over smooth prism (1.0 to 1.05)", ("rough_over", ""), 2, (1.0, 1.05)), ("left, rough (0.1 to 0.2)", ("platens_prism", "residual"), 2, (0.1, 0.2)), ("G_F, J/m2", ("tension_notched", "fracture_energy"), 0, None))


PRESSED = (("20 MPa add", ("slope_20", ""), 2, None), ("s1 at 100 MPa, MPa", ("triaxial_100", "strength"), 0, None), ("oedometer: strain at 0.1 GPa, %", ("oedometer", "strain_100"), 2, None), ("at 1 GPa, %", ("oedometer", "strain_1000"), 1, None))


def cell(of, digits, wanted):
    values = list(of.values())
    if not values:
        return ""
    mean = statistics.mean(values)
    text = f"{mean + 0.0 if abs(mean) >= 0.5 * 10**-digits else 0.0:.{digits}f}"
    text = text if not wanted or wanted[0] <= float(text) <= wanted[1] else f"**{text}**"
    return text + (f" +- {statistics.stdev(values):.{digits}f}" if len(values) > 1 else "")


def one_by_one(lines, group):
    found, columns = numbers_of(lines, group), COLUMNS + {"beside": MORE, "compaction": PRESSED}.get(group, ())
    out = ["| " + " | ".join(("600 elements", "n", *(column[0] for column in columns))) + " |", "|---" * (len(columns) + 2) + "|"]
    for name in GROUPS[group][0]:
        if name in found:
            out.append("| " + " | ".join((name, str(len(found[name]["prism", "strength"])), *(cell(found[name].get(of, {}), digits, wanted) for _, of, digits, wanted in columns))) + " |")
    return "\n".join(out)


def strain_misfit(grade, value):
    """Of a strain at f_c [1e-3], over EN 1992-1-1's."""
    return f"{100 * (value / min(0.7 * GRADE[grade] ** 0.31, 2.8) - 1):+.0f} %"


def newman_misfit(found, pressure):
    s1, f_c = found.get((f"triaxial_{pressure}", "strength"), {}), found["prism", "strength"]
    return f"{100 * (statistics.mean(s1.values()) / newman(statistics.mean(f_c.values()), pressure) - 1):+.0f}" if s1 else ""


def grid(lines):
    """Sets of `early` over Y_c and H_c."""
    found = numbers_of(lines, "early")
    out = ["| f_c, MPa; strain there over EN 1992-1-1; left at 3 times it; 5 MPa add | " + " | ".join(f"Y_c {over:g} f_c" for over in YIELDS) + " |", "|---" * (len(YIELDS) + 1) + "|"]
    for grade in GRADE:
        for slope in SLOPES:
            cells = []
            for over in YIELDS:
                of = found[f"{grade}, Y_c {over:g} f_c, H_c {slope:g}"]
                mean = {key: statistics.mean(of[key].values()) for key in (("prism", "strength"), ("prism", "peak_strain"), ("prism", "residual"), ("slope_5", ""))}
                f_c, strain, left, added = mean.values()
                cells.append(f"{f_c:.1f}; {strain_misfit(grade, strain)}; {left:.2f}; {added:.1f}")
            out.append(f"| {grade}, H_c {slope:g} | " + " | ".join(cells) + " |")
    return "\n".join(out)


def bounds(lines):
    """The other sets of `early`."""
    found = numbers_of(lines, "early")
    out = ["| 600 elements, n = 2 | f_c, MPa | strain there over EN 1992-1-1 | left at 3 times it | 5 MPa add | 5, 20, 50, 100 MPa over Newman, % | oedometer: strain at 1 GPa, % | rough over smooth prism; left, rough | rough cube over rough prism |", "|---" * 9 + "|"]
    for name in GROUPS["early"][0]:
        if name not in found or re.search(r"Y_c [\d.]+ f_c, H_c [\d.]+$", name) and "smooth" not in name:
            continue
        of = found[name]
        cubes, prisms = of.get(("platens_cube", "strength"), {}), of.get(("platens_prism", "strength"), {})
        over = {packing: cubes[packing] / prisms[packing] for packing in cubes if packing in prisms}
        rough = cell(of["rough_over", ""], 2, None) + "; " + cell(of.get(("platens_prism", "residual"), {}), 2, None) if prisms else ""
        pressed = ", ".join(newman_misfit(of, pressure) or "-" for pressure in (5, 20, 50, 100))
        out.append("| " + " | ".join((name, cell(of["prism", "strength"], 1, None), strain_misfit(name.split(",")[0], statistics.mean(of["prism", "peak_strain"].values())), cell(of["prism", "residual"], 3, (0.1, 0.2)), cell(of["slope_5", ""], 1, (4.0, 5.0)),
                                      pressed, cell(of.get(("oedometer", "strain_1000"), {}), 1, None), rough.removesuffix("; "), cell(over, 2, None))) + " |")
    return "\n".join(out)


def inverse(matrix):
    size = len(matrix)
    rows = [row[:] + [float(i == j) for j in range(size)] for i, row in enumerate(matrix)]
    for i in range(size):
        pivot = max(range(i, size), key=lambda r: abs(rows[r][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        rows[i] = [value / rows[i][i] for value in rows[i]]
        for r in range(size):
            if r != i:
                rows[r] = [a - rows[r][i] * b for a, b in zip(rows[r], rows[i])]
    return [row[size:] for row in rows]


def fitted(points):
    """Slopes and their standard errors by least squares, [(places, value)]; the first place is 1."""
    size = range(len(points[0][0]))
    spread = inverse([[sum(x[i] * x[j] for x, _ in points) for j in size] for i in size])
    slopes = [sum(spread[i][j] * sum(x[j] * y for x, y in points) for j in size) for i in size]
    left = sum((y - sum(a * b for a, b in zip(x, slopes))) ** 2 for x, y in points) / (len(points) - len(slopes))
    return slopes, [math.sqrt(spread[i][i] * left) for i in size]


def slopes(lines):
    found, sets = numbers_of(lines, "drawn"), GROUPS["drawn"][0]
    rows = (("f_c", ("prism", "strength"), True), ("f_t", ("tension", "strength"), True), ("G_F", ("tension_notched", "fracture_energy"), True), ("strain at f_c over f_c", ("strain_over", ""), True),
            ("what 5 MPa add", ("slope_5", ""), True), ("what 20 MPa add", ("slope_20", ""), True), ("left at 3 times the strain of the peak", ("prism", "residual"), False), ("left, rough", ("platens_prism", "residual"), False),
            ("rough over smooth prism", ("rough_over", ""), False))
    heads = {"turn_wear": "turn_wear, each 0.01", "slip_wear": "slip_wear", "cohesion": "C", "rolling_cap": "s_M", "friction_angle": "tan phi_i", "friction_cap": "s_F", "broken_friction": "mu_b", "broken_rolling_limit": "eta_b", "poisson": "nu",
             "tensile_strength": "T", "knee_strength": "s"}
    out = ["| slope of | " + " | ".join(heads.values()) + " |", "|---" * (len(heads) + 1) + "|"]
    for words, of, logarithm in rows:
        names = [name for name in sets if found.get(name, {}).get(of)]
        places = [[BY.get(key, math.log)(sets[name][key]) for key in DRAWN] for name in names]
        middle = [statistics.mean(column) for column in zip(*places)]
        means = [statistics.mean(found[name][of].values()) for name in names]
        slope, error = fitted([([1.0] + [a - b for a, b in zip(place, middle)], math.log(mean) if logarithm else mean) for place, mean in zip(places, means)])
        cells = [(f"**{s:+.2f}**" if abs(s) > 3 * e else f"{s:+.2f}") + f" +- {e:.2f}" if logarithm else (f"**{s:+.3f}**" if abs(s) > 3 * e else f"{s:+.3f}") + f" +- {e:.3f}" for s, e in zip(slope[1:], error[1:])]
        out.append(f"| {words} | " + " | ".join(cells) + " |")
    return "\n".join(out)


def calibrated(lines, which):
    """Sets of one concrete beside what the library has (docs/results/library.csv); 1,200 elements, packings 5 to 7."""
    with open(ROOT / "docs/results/library.csv", newline="") as file:
        old = [one for one in csv.DictReader(file) if one["specimen"] in "567" and one["elements"] == "1200" or one["test"] == "brazilian" and one["elements"] == "2400" and one["specimen"] in "567"]
    old = [{"set": one["material"], "test": "prism" if one["test"] == "prism_long" else one["test"], **{key: one[key] for key in ("specimen", "quantity", "value")}} for one in old]
    found = {}
    for one in [*old, *(one for one in lines if one["group"] == "calibrated" and one["elements"] == "1200")]:
        if math.isfinite(float(one["value"])):
            found.setdefault(one["set"], {}).setdefault((one["test"], one["quantity"]), {})[one["specimen"]] = float(one["value"])
    sets = [name for name in CALIBRATED if name in found and (CALIBRATED[name]["use"] == which or which == "all")]
    sets = [which, *sets] if which != "all" else sorted((name for name in sets if name.endswith("turn_wear 0") or name[:3] in ("C60", "C10")), key=lambda name: int(name[1:].split()[0]))

    def over(test, below, quantity="strength"):
        def of(name):
            up, down = found[name].get((test, quantity), {}), found[name].get((below, "strength"), {})
            return {packing: up[packing] / down[packing] for packing in up if packing in down}
        return of

    def number(test, quantity="strength"):
        return lambda name: found[name].get((test, quantity), {})

    def added(pressure):
        def of(name):
            s1, f_c = found[name].get((f"triaxial_{pressure}", "strength"), {}), found[name].get(("prism", "strength"), {})
            return {packing: (s1[packing] - f_c[packing]) / pressure for packing in s1 if packing in f_c}
        return of

    def confined(pressure):
        def of(name):
            s1, f_c = found[name].get((f"triaxial_{pressure}", "strength"), {}), found[name].get(("prism", "strength"), {})
            return f"{cell(s1, 0, None)}, {100 * (statistics.mean(s1.values()) / newman(statistics.mean(f_c.values()), pressure) - 1):+.0f} %" if s1 and f_c else ""
        return of

    def against(test, target, digits):
        def of(name):
            values, asked = found[name].get((test, "strength"), {}), targets_of(CALIBRATED.get(name, {}).get("use", name))[target]
            return f"{cell(values, digits, None)}, {100 * (statistics.mean(values.values()) / asked - 1):+.1f} %" if values else ""
        return of

    def keys(name):
        keys = CALIBRATED.get(name)
        return ", ".join(f"{keys[key] / 1e6:.4g}" for key in ("tensile_strength", "cohesion")) if keys else "as it is"

    def strain(name):
        of = found[name].get(("prism", "peak_strain"), {})
        rule = min(0.7 * targets_of(CALIBRATED.get(name, {}).get("use", name))["compression"] ** 0.31, 2.8)
        return f"{cell(of, 2, None)}, {100 * (statistics.mean(of.values()) / rule - 1):+.0f} %" if of else ""

    rows = [("T, C [MPa]", keys, None, None), ("E [GPa]", number("compression_prism", "young"), 1, None), ("nu", number("compression_prism", "poisson"), 3, None), ("f_c [MPa]; misfit", against("prism", "compression", 1), None, None), ("f_t [MPa]; misfit", against("tension", "tension", 2), None, None), ("G_F of the notched prism [J/m2]", number("tension_notched", "fracture_energy"), 0, None),
            ("left at 3 times the strain of the peak, of f_c (0.1 to 0.2)", number("prism", "residual"), 3, (0.1, 0.2)), ("the same, rough platens (0.1 to 0.2)", number("platens_prism", "residual"), 2, (0.1, 0.2)),
            ("strain at f_c, 1e-3; EN 1992-1-1", strain, None, None), ("strength that 5 MPa add, over 5 MPa (4 to 5)", added(5), 1, (4.0, 5.0)),
            ("s1 at 5 MPa [MPa]; over Newman", confined(5), None, None), ("at 20 MPa; over Newman", confined(20), None, None), ("at 50 MPa", number("triaxial_50"), 0, None), ("at 100 MPa", number("triaxial_100"), 0, None),
            ("smooth cube over smooth prism (1.0)", over("compression_cube", "prism"), 2, None), ("rough prism over smooth prism (1.0 to 1.05)", over("platens_prism", "prism"), 2, (1.0, 1.05)),
            ("rough cube over rough prism (1.15 to 1.30)", over("platens_cube", "platens_prism"), 2, (1.15, 1.30)), ("disc of 2,400 over f_t (1.0 to 1.15)", over("brazilian", "tension"), 2, (1.0, 1.15)),
            ("plain beam under two lines over f_t (1.66)", over("bending_thirds", "tension"), 2, (1.58, 1.74)), ("oedometer: strain at 0.1 GPa, %", number("oedometer", "strain_100"), 2, None),
            ("at 1 GPa, % (8 to 10)", number("oedometer", "strain_1000"), 1, None), ("lateral over axial stress at 1 GPa (0.4 to 0.6)", number("oedometer", "side_ratio"), 2, (0.4, 0.6))]
    heads = ["of the library" if name == which else name.removeprefix(f"{which} ") for name in sets]
    out = ["| 1,200 elements, n = 3 | " + " | ".join(heads) + " |", "|---" * (len(sets) + 1) + "|"]
    for words, of, digits, wanted in rows:
        cells = [of(name) if digits is None else cell(of(name), digits, wanted) + (f" (n = {len(of(name))})" if 0 < len(of(name)) < 3 else "") for name in sets]
        if any(cells):
            out.append(f"| {words} | " + " | ".join(cells) + " |")
    return "\n".join(out)


def markdown(lines, which):
    """`alone`, `beside`, `compaction`, `slopes`, `calibrated CONCRETE`, `calibrated all`, `early grid`, `early bounds`."""
    if which.startswith("early"):
        return bounds(lines) if which.endswith("bounds") else grid(lines)
    if which.startswith("calibrated"):
        return calibrated(lines, which.removeprefix("calibrated").strip())
    return slopes(lines) if which == "slopes" else one_by_one(lines, which)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--group", default="alone", choices=GROUPS)
    p.add_argument("--packings", default="5,6,7")
    p.add_argument("--elements", default="")
    p.add_argument("--only", default="")
    published_runs.add_options(p, device=False)
    given = p.parse_args()
    OUT.mkdir(parents=True, exist_ok=True)
    sets, tests = GROUPS[given.group]
    sizes = (given.elements or ("1200" if given.group == "calibrated" else "600")).split(",")
    published_runs.run_all(given.jobs, run, [(given.group, name, test, int(elements), int(packing), given) for packing in given.packings.split(",") for elements in sizes for name in sets
                                             if re.search(given.only, name) for test in tests])
    records = [one for path in sorted(OUT.glob("*/numbers.json")) for one in json.loads(path.read_text())]
    records = [{key: str(value) for key, value in one.items()} for one in records]
    if given.record:
        records = published_runs.merge_record(given.record, RECORD, records, RECORD[:5])
    print(markdown(records, {"drawn": "slopes", "calibrated": "calibrated C30"}.get(given.group, given.group)))


if __name__ == "__main__":
    main()
