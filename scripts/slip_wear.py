#!/usr/bin/env python3
"""C30 as the library had it before its links were damped (`keyed_specimens.LOCAL_C30`), with a smaller slip_wear, in specimens of `breccia test` and beams of reinforced_tests.py, for docs/trials-concrete.md.

    scripts/slip_wear.py [--packings 1,2,3] [--elements 1200] [--only TEXT] [--binary build/release/breccia] [--device cpu] [--jobs 1] [--record FILE]

T and C of each set were found by secants with local damping of 0.3, so that prism and tension of packings 1 to 3 (1,200 elements) show what that C30 shows on these packings within 1 %; all other
keys are its own. --only: tests with it in their name. Results are in out/slip_wear/; called again, only what is missing is run. --record replaces lines of these runs in FILE (docs/results/slip_wear.csv).
"""
import argparse
import math
import pathlib
import re
import statistics

import keyed_specimens
import published_runs
import reinforced_tests
from library_tables import newman

ROOT = pathlib.Path(__file__).resolve().parent.parent
OUT = ROOT / "out" / "slip_wear"
SETS = {(1.0, 30): (2.606, 37.86), (0.5, 30): (2.478, 30.59), (0.3, 30): (2.419, 25.56), (0.3, 20): (2.433, 35.44), (0.1, 30): (2.397, 17.85)}  # slip_wear, phi_i [degrees]: T, C [MPa]
SPECIMENS = ("tension", "compression_prism", "tension_notched", "brazilian", "bending_thirds", "platens_prism", "platens_cube", "triaxial_5", "triaxial_20")
BEAMS = (("shear", 3900), ("shear", 7800), ("shear", 15600), ("stirrups", 3900), ("stirrups", 15600), ("bending", 3900))
PRISMS = {3900: 38.6, 7800: 38.0, 15600: 37.3}  # f_c of that C30, with elements as large as those of beams  [MPa]
RECORD = ["slip_wear", "friction_angle", "elements", "test", "specimen", "commit", "device", "hash", "quantity", "value"]


def keys(of):
    tension, cohesion = SETS[of]
    given = keyed_specimens.LOCAL_C30 | {"slip_wear": of[0], "friction_angle": f'"{of[1]} deg"', "tensile_strength": f"{tension}e6", "cohesion": f"{cohesion}e6"}
    return [part for key, value in given.items() for part in ("--set", f"material.c30.{key}={value}")]


def stem(of, test, elements, packing):
    return f"{of[0]:g}_{of[1]}-{test}-{elements}-{packing}"


def run(of, test, elements, packing, given):
    keyed_specimens.make(OUT / stem(of, test, elements, packing), "C30", keys(of), test, elements, packing, given)


def collected():
    """A line for each quantity of each finished run."""
    for folder, summary, found in keyed_specimens.finished(OUT, at=1):
        of, test, elements, packing = folder.name.split("-")
        for quantity, value in found.items():
            yield dict(zip(RECORD, (*of.split("_"), elements, test, packing, summary["breccia"]["commit"], summary["machine"]["device"], summary["state_hash"], quantity, f"{value:.9g}")))


# ---------------------------------------------------------------- tables

def gathered(lines, packings):
    """{(set, test, elements, quantity): {packing: value}}"""
    found = {}
    for one in lines:
        value = float(one["value"])
        if one["specimen"].isdigit() and int(one["specimen"]) in packings and math.isfinite(value):
            of = float(one["slip_wear"]), int(one["friction_angle"])
            found.setdefault((of, one["test"], int(one["elements"]), one["quantity"]), {})[one["specimen"]] = value
    return found


def cell(values, digits, wanted=(-math.inf, math.inf), unit=1.0):
    if not values:
        return ""
    mean = statistics.mean(values) / unit
    text = f"{mean:.{digits}f}" if wanted[0] <= round(mean, digits) <= wanted[1] else f"**{mean:.{digits}f}**"
    return text + (f" +- {statistics.stdev(values) / unit:.{digits}f}" if len(values) > 1 else " (n = 1)") + (f" (n = {len(values)})" if len(values) == 2 else "")


def markdown(lines, which):
    """@param which  packings, as "1 2 3" """
    found = gathered(lines, {int(word) for word in which.split()})
    sets = sorted({key[0] for key in found}, key=lambda of: (-of[0], -of[1]))

    def values(of, test, quantity="strength", elements=1200):
        return list(found.get((of, test, elements, quantity), {}).values())

    def over(of, test, below, digits, wanted):
        """Packing by packing."""
        up, down = (found.get((of, name, 1200, "strength"), {}) for name in (test, below))
        return cell([up[packing] / down[packing] for packing in up if packing in down], digits, wanted)

    def beam(of, test, elements):
        loads = values(of, test, "largest", elements)
        if not loads:
            return ""
        off = 100 * (statistics.mean(loads) / reinforced_tests.against(test + reinforced_tests.LIBRARY, elements, PRISMS[elements]) - 1)
        return cell(loads, 1) + (f", **{off:+.0f} %**" if abs(off) > 15 else f", {off:+.0f} %")

    def triaxial(of, pressure):
        strength, f_c = values(of, f"triaxial_{pressure}"), values(of, "compression_prism")
        return f"{cell(strength, 1)}, {100 * (statistics.mean(strength) / newman(statistics.mean(f_c), pressure) - 1):+.0f} %" if strength and f_c else ""

    names = {"shear": "beam in shear", "stirrups": "beam with stirrups", "bending": "slender beam"}
    rows = [("T, C [MPa]", lambda of: ", ".join(f"{key:.4g}" for key in SETS[of])),
            ("f_t; f_c [MPa]", lambda of: "; ".join((cell(values(of, "tension"), 2), cell(values(of, "compression_prism"), 1)))),
            *((f"{names[test]}, {elements:,} [kN]; misfit", lambda of, test=test, elements=elements: beam(of, test, elements)) for test, elements in BEAMS),
            ("disc of 2,400 over f_t (1.0 to 1.15)", lambda of: over(of, "brazilian", "tension", 2, (1.0, 1.15))),
            ("plain beam over f_t, two lines of load (1.66)", lambda of: over(of, "bending_thirds", "tension", 2, (1.58, 1.74))),
            ("rough cube over rough prism (1.15 to 1.30)", lambda of: over(of, "platens_cube", "platens_prism", 2, (1.15, 1.30))),
            ("rough prism over smooth prism (1.0 to 1.05)", lambda of: over(of, "platens_prism", "compression_prism", 2, (1.0, 1.05))),
            ("left of f_c at 3 times the strain of its peak (0.1 to 0.2)", lambda of: cell(values(of, "compression_prism", "residual"), 3, (0.1, 0.2))),
            ("G_F of the notched prism [J/m2] (141)", lambda of: cell(values(of, "tension_notched", "fracture_energy"), 0, (127, 155))),
            ("s1 at 5 MPa [MPa]; over Newman", lambda of: triaxial(of, 5)), ("at 20 MPa; over Newman", lambda of: triaxial(of, 20))]
    out = ["| slip_wear, phi_i | " + " | ".join(f"{of[0]:g}, {of[1]}" + (" (C30_local)" if of == (1.0, 30) else "") for of in sets) + " |", "|---" * (len(sets) + 1) + "|"]
    for words, of_set in rows:
        cells = [of_set(of) for of in sets]
        if any(cells):
            out.append(f"| {words} | " + " | ".join(cells) + " |")
    return "\n".join(out)


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--packings", default="1,2,3")
    p.add_argument("--elements", type=int, default=1200)
    p.add_argument("--only", default="")
    published_runs.add_options(p)
    given = p.parse_args()
    OUT.mkdir(parents=True, exist_ok=True)
    jobs = [(of, test, elements, int(packing), given) for packing in given.packings.split(",") for of in SETS
            for test, elements in (*((name, given.elements) for name in SPECIMENS), *BEAMS) if re.search(given.only, test)]
    published_runs.run_all(given.jobs, run, jobs)
    records = list(collected())
    print(markdown(records, given.packings.replace(",", " ")))
    if given.record:
        published_runs.merge_record(given.record, RECORD, records, RECORD[:5])


if __name__ == "__main__":
    main()
