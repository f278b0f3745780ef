#!/usr/bin/env python3
"""Concretes of `breccia materials` calibrated anew with damped links and without local damping, for docs/trials-concrete.md.

    scripts/damped_library.py [--concretes C20,C30] [--packings 5,6,7] [--elements 600,1200,2400] [--only TEXT] [--binary build/release/breccia] [--device cpu] [--jobs 1] [--record FILE]

Keys of each (`SETS`) stand in the place of the library's, whose other keys stay. They were found on packings 1 to 4, which are not recorded. Specimens of `breccia test`, of C30
beams of reinforced_tests.py as well (elements 3900 to 15600). --only: tests with it in their name. Results are in out/damped_library/; called again, only what is missing is
run. --record replaces lines of these runs in FILE (docs/results/damped_library.csv).
"""
import argparse
import math
import pathlib
import re
import statistics

import keyed_specimens
import published_runs
import reinforced_tests
from library_tables import newman, targets_of

ROOT = pathlib.Path(__file__).resolve().parent.parent
OUT = ROOT / "out" / "damped_library"
SETS = {"C20": (30.57, 0.1778, 1.709, 31.22), "C30": (33.93, 0.1771, 2.419, 43.61), "C40": (36.70, 0.1743, 3.025, 60.85), "C60": (41.30, 0.1670, 3.750, 110.5),
        "C100": (48.56, 0.1474, 4.340, 205.5)}  # young [GPa], poisson, tensile_strength, cohesion [MPa]
ALIKE = {"slip_wear": "0.3", "link_damping": "0.3"}
SPECIMENS = ("compression_prism", "tension", "tension_notched", "brazilian", "bending_thirds", "bending", "platens_prism", "platens_cube", "compression_cube", "triaxial_5", "triaxial_20",
             "triaxial_50", "triaxial_100", "triaxial_200", "oedometer")
OF_SIZES = SPECIMENS[:3]  # also with other than 1,200 elements
BEAMS = {"shear": (3900, 7800, 15600), "bending": (3900, 7800, 15600), "stirrups": (3900, 15600)}
PRISMS = {3900: 600, 7800: 1200, 15600: 2400}  # elements of a prism whose elements are as large as those of a beam
RECORD = ["concrete", "elements", "test", "specimen", "commit", "hash", "quantity", "value"]


def keys(concrete):
    young, poisson, tension, cohesion = SETS[concrete]
    given = {"young": f'"{young:.4g} GPa"', "poisson": f"{poisson:.4g}", "tensile_strength": f'"{tension:.4g} MPa"', "cohesion": f'"{cohesion:.4g} MPa"', **ALIKE}
    return [part for key, value in given.items() for part in ("--set", f"material.c30.{key}={value}")]


def run(concrete, elements, test, packing, given):
    keyed_specimens.make(OUT / f"{concrete}-{elements}-{test}-{packing}", concrete, keys(concrete), test, elements, packing, given)


def collected():
    """A line for each quantity of each finished run."""
    for folder, summary, found in keyed_specimens.finished(OUT, at=2):
        concrete, elements, test, packing = folder.name.split("-")
        for quantity, value in found.items():
            yield dict(zip(RECORD, (concrete, elements, test, packing, summary["breccia"]["commit"], summary["state_hash"], quantity, f"{value:.9g}")))


# ---------------------------------------------------------------- tables

def gathered(lines, packing="specimen", concrete="concrete"):
    """{(concrete, elements, test, quantity): {packing: value}}; a disc has at least 2,400 elements, and stands with those of the prism here."""
    found = {}
    for one in lines:
        if one[packing].isdigit() and math.isfinite(float(one["value"])):
            elements = 1200 if (one["test"], one["elements"]) == ("brazilian", "2400") else int(one["elements"])
            found.setdefault((one[concrete], elements, one["test"], one["quantity"]), {})[one[packing]] = float(one["value"])
    return found


def spread(values, digits):
    return f"{statistics.mean(values):.{digits}f}" + (f" +- {statistics.stdev(values):.{digits}f}" if len(values) > 1 else "")


def bold(text, wrong):
    return re.sub(r"^(\S+(?: %)?)", r"**\1**", text) if wrong else text


def targets(lines):
    """What is asked for beside what is shown, over sizes of elements."""
    found = gathered(lines)
    asked = [("E (3 %), GPa", "young", "compression_prism", "young", 1, 3), ("nu (10 %)", "poisson", "compression_prism", "poisson", 3, 10), ("f_c (5 %), MPa", "compression", "compression_prism", "strength", 1, 5),
             ("f_t (5 %), MPa", "tension", "tension", "strength", 2, 5), ("G_F (10 %), J/m2", "fracture_energy", "tension_notched", "fracture_energy", 0, 10)]
    out = ["| elements in the prism | " + " | ".join(head for head, *_ in asked) + " | n |", "|---" * (len(asked) + 2) + "|"]
    for concrete in SETS:
        for elements in sorted({key[1] for key in found if key[0] == concrete and key[2] == "tension"}):
            cells, counts = [], []
            for _, target, test, quantity, digits, allowed in asked:
                values = list(found.get((concrete, elements, test, quantity), {}).values())
                counts.append(len(values))
                if not values:
                    cells.append("")
                    continue
                off = 100 * (statistics.mean(values) / targets_of(concrete)[target] - 1)
                cells.append(f"{spread(values, digits)}, " + bold(f"{off:+.1f} %", abs(off) > allowed))
            out.append(f"| {concrete}, {elements:,} | " + " | ".join(cells) + " | " + ", ".join(str(n) for n in dict.fromkeys(counts)) + " |")
    return "\n".join(out)


def others(lines, library):
    """What no target asks for, with what the library shows on the same packings in brackets."""
    here, there = gathered(lines), gathered(library, concrete="material")

    def value(of, concrete, test, quantity, over):
        up, down = of.get((concrete, 1200, test, quantity), {}), of.get((concrete, 1200, over, "strength"), {}) if over else None
        return {packing: number / (down[packing] if over else 1.0) for packing, number in up.items() if not over or packing in down}

    def cell(concrete, test, quantity, digits, over=None, wanted=(-math.inf, math.inf)):
        new = value(here, concrete, test, quantity, over)
        if not new:
            return ""
        old = [number for packing, number in value(there, concrete, test, quantity, over).items() if packing in new]
        text = bold(spread(list(new.values()), digits), not wanted[0] <= round(statistics.mean(new.values()), digits) <= wanted[1])
        return text + (f" ({statistics.mean(old):.{digits}f})" if old else "") + (f" (n = {len(new)})" if len(new) < 3 else "")

    def confined(concrete, pressure):
        text, f_c = cell(concrete, f"triaxial_{pressure}", "strength", 0), here.get((concrete, 1200, "compression_prism", "strength"), {})
        strength = here.get((concrete, 1200, f"triaxial_{pressure}", "strength"), {})
        rule = [strength[packing] / newman(f_c[packing], pressure) for packing in strength if packing in f_c]
        return text + (f", {100 * (statistics.mean(rule) - 1):+.0f} %" if rule and pressure <= 20 else "")

    rows = [("disc of 2,400 elements over f_t (1.0 to 1.15)", lambda c: cell(c, "brazilian", "strength", 2, "tension", (1.0, 1.15))),
            ("beam under two lines of load over f_t (1.66)", lambda c: cell(c, "bending_thirds", "strength", 2, "tension", (1.58, 1.74))),
            ("notched beam, J/m2", lambda c: cell(c, "bending", "fracture_energy", 0)),
            ("strain at f_c, 1e-3", lambda c: cell(c, "compression_prism", "peak_strain", 2)),
            ("left of f_c at 3 times that strain (0.1 to 0.2)", lambda c: cell(c, "compression_prism", "residual", 3, None, (0.1, 0.2))),
            ("the same, rough platens (0.1 to 0.2)", lambda c: cell(c, "platens_prism", "residual", 3, None, (0.1, 0.2))),
            ("rough prism over smooth prism (1.0 to 1.05)", lambda c: cell(c, "platens_prism", "strength", 2, "compression_prism", (1.0, 1.05))),
            ("rough cube over rough prism (1.15 to 1.30)", lambda c: cell(c, "platens_cube", "strength", 2, "platens_prism", (1.15, 1.30))),
            ("smooth cube over smooth prism (1.0)", lambda c: cell(c, "compression_cube", "strength", 2, "compression_prism")),
            *((f"s1 at {p} MPa, MPa" + ("; over Newman" if p <= 20 else ""), lambda c, p=p: confined(c, p)) for p in (5, 20, 50, 100, 200)),
            ("oedometer: strain at 1 GPa, % (8 to 10)", lambda c: cell(c, "oedometer", "strain_1000", 1)), ("its tangent at 0.8 GPa, GPa", lambda c: cell(c, "oedometer", "tangent_800", 1)),
            ("lateral over axial stress at 1 GPa (0.4 to 0.6)", lambda c: cell(c, "oedometer", "side_ratio", 2, None, (0.4, 0.6)))]
    out = ["| 1,200 elements | " + " | ".join(SETS) + " |", "|---" * (len(SETS) + 1) + "|"]
    for words, of in rows:
        cells = [of(concrete) for concrete in SETS]
        if any(cells):
            out.append(f"| {words} | " + " | ".join(cells) + " |")
    return "\n".join(out)


def beams(lines, reinforced):
    """Beams of C30 over sizes of elements beside formulas for the f_c of prisms with elements as large, and the library's C30 beside the same for its own."""
    here = gathered(lines)
    there = gathered([one | {"test": one["test"].removesuffix(reinforced_tests.LIBRARY), "concrete": "C30"} for one in reinforced if one["test"].endswith(reinforced_tests.LIBRARY)], "seed")
    out = ["| beam of C30 | elements | damped links, kN | over the formula | reactions alone | C30 of the library | over the formula |", "|---" * 7 + "|"]
    names = {"shear": "shear (Niwa et al.)", "bending": "slender (bars yield)", "stirrups": "stirrups (concrete crushes)"}

    def off(load, formula):
        return bold(f"{100 * (load / formula - 1):+.0f} %", abs(load / formula - 1) > 0.15)

    for test, sizes in BEAMS.items():
        for elements in sizes:
            loads = list(here.get(("C30", elements, test, "largest"), {}).values())
            if not loads:
                continue
            f_c = statistics.mean(here["C30", PRISMS[elements], "compression_prism", "strength"].values())
            formula = 1e-3 * {"shear": reinforced_tests.shear_niwa, "stirrups": reinforced_tests.crushing, "bending": lambda f_c: reinforced_tests.flexure(0.006, f_c)}[test](f_c)
            before = list(there.get(("C30", elements, test, "largest"), {}).values())
            out.append(f"| {names[test]} | {elements:,} | {spread(loads, 1)}" + (f" (n = {len(loads)})" if len(loads) < 3 else "") + f" | {off(statistics.mean(loads), formula)} | "
                       f"{spread(list(here['C30', elements, test, 'reaction'].values()), 1)} | {spread(before, 1)} | {off(statistics.mean(before), reinforced_tests.against(test + reinforced_tests.LIBRARY, elements))} |")
    return "\n".join(out) if len(out) > 2 else ""


def markdown(lines, library, reinforced, what):
    """`targets`, `others`, `beams`."""
    return {"targets": lambda: targets(lines), "others": lambda: others(lines, library), "beams": lambda: beams(lines, reinforced)}[what]()


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--concretes", default=",".join(SETS))
    p.add_argument("--packings", default="5,6,7")
    p.add_argument("--elements", default="600,1200,2400")
    p.add_argument("--only", default="")
    p.add_argument("--binary", type=pathlib.Path, default=ROOT / "build/release/breccia")
    p.add_argument("--device", default="cpu")
    p.add_argument("--jobs", type=int, default=1)
    p.add_argument("--record", type=pathlib.Path)
    given = p.parse_args()
    OUT.mkdir(parents=True, exist_ok=True)
    sizes = [int(word) for word in given.elements.split(",")]
    tests = [(test, n) for test in SPECIMENS for n in sizes if n == 1200 or test in OF_SIZES] + [(test, n) for test, of in BEAMS.items() for n in sizes if n in of]
    jobs = [(concrete, elements, test, int(packing), given) for packing in given.packings.split(",") for concrete in given.concretes.split(",")
            for test, elements in tests if given.only in test and (elements not in keyed_specimens.BEAMS or concrete == "C30")]
    published_runs.run_all(given.jobs, run, jobs)
    records = list(collected())
    print(targets(records))
    if given.record:
        published_runs.merge_record(given.record, RECORD, records, RECORD[:4])


if __name__ == "__main__":
    main()
