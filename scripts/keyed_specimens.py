#!/usr/bin/env python3
"""Specimens of `breccia test` and beams of reinforced_tests.py of a concrete of `breccia materials` with other keys, for scripts that compare such concretes."""
import csv
import json
import pathlib
import subprocess

import reinforced_tests

# Concretes as the library had them while turns wore their links (`turn_wear`), all that differs: tables that still compare with them say so.
WORN = {name: {"young": young * 1e9, "poisson": poisson, "tensile_strength": round(tension * 1e6), "cohesion": round(cohesion * 1e6), "friction_cap": round(bound * 1e6), "turn_wear": 0.1, "compaction_strength": round(pores * 1e6), "compaction_slope": 0.4}
        for name, young, poisson, tension, cohesion, bound, pores in (("C20", 30.57, 0.1778, 1.709, 31.22, 2.6, 52.0), ("C30", 33.93, 0.1771, 2.419, 43.61, 3.529, 70.6), ("C40", 36.7, 0.1743, 3.025, 60.85, 4.46, 89.2),
                                                                      ("C60", 41.3, 0.167, 3.75, 110.5, 6.32, 126.3), ("C100", 48.56, 0.1474, 4.34, 205.5, 10.0, 200.6))}
# C30 as the library had it before its links were damped, calibrated with local damping of 0.3: tables that still compare with it are "C30_local".
LOCAL_C30 = {key: str(value) for key, value in WORN["C30"].items()} | {"young": '"33.5 GPa"', "poisson": "0.1846", "tensile_strength": '"2.606 MPa"', "cohesion": '"37.86 MPa"', "slip_wear": "1.0", "link_damping": "0.0"}
ROOT = pathlib.Path(__file__).resolve().parent.parent
BEAMS = (3900, 7800, 15600)  # elements of beams; a notched beam of `breccia test` is called "bending", too


def make(folder, concrete, keys, test, elements, packing, given):
    """Runs a test, or a beam, unless its folder has a finished one."""
    if summary_of(folder):
        return
    if test + reinforced_tests.LIBRARY in reinforced_tests.TESTS and elements in BEAMS:
        case = folder.parent / f"{folder.name}.toml"
        case.write_text(reinforced_tests.TESTS[test + reinforced_tests.LIBRARY](packing, elements))
        command = ["run", case, "-o", folder, "--force", "--no-progress", *keys]
    else:
        command = ["test", ROOT / "cases/rc_slab/case.toml", "--material", "c30", "--set", f"material.c30.use={concrete}", *keys, "--only", test, "--seeds", 1, "--first-seed", packing,
                   "--elements", elements, "--jobs", 1, "-o", folder]
    done = subprocess.run([str(part) for part in (given.binary, *command, "--threads", 1, "--device", given.device)], stdout=subprocess.DEVNULL)
    if done.returncode not in (0, 9):
        raise SystemExit(f"{folder.name} ended with {done.returncode}")


def summary_of(folder):
    """Of a beam, or of the one specimen of a test; None where it has not ended."""
    found = [*folder.glob("summary.json"), *folder.glob("runs/*/summary.json")]
    return json.loads(found[0].read_text()) if found else None


def shown(folder):
    """{(quantity, unit): value} of the one specimen of a test."""
    with open(folder / "specimens.csv", newline="") as file:
        return {(one["quantity"], one["unit"]): float(one["value"]) for one in csv.DictReader(file)}


def finished(out, at):
    """Folder, summary and {quantity: value} of each finished run in a folder; at: which part of a run's name, between dashes, is its test."""
    for folder in sorted(path for path in out.iterdir() if path.is_dir()):
        summary = summary_of(folder)
        if not summary or summary["status"] in ("interrupted", "running"):
            continue
        if not (folder / "specimens.csv").exists():
            yield folder, summary, reinforced_tests.measured(folder.name.split("-")[at] + reinforced_tests.LIBRARY, folder)
            continue
        yield folder, summary, {quantity: value for (quantity, _), value in shown(folder).items()}
