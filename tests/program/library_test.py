"""The library's C30 under pressure: numbers of `breccia test` are those that docs/results/library.csv has of the same packing.

What is run: a triaxial test at 5 MPa and an oedometer of 600 elements; with LIBRARY_TESTS=all in the environment triaxial tests up to 200 MPa and rough platens, too.
"""

import csv
import math
import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["BRECCIA"]
ROOT = pathlib.Path(__file__).resolve().parents[2]
ELEMENTS, PACKING = "600", "5"
TESTS = ["triaxial_5", "oedometer"]
MORE = ["triaxial_20", "triaxial_50", "triaxial_100", "triaxial_200", "platens_prism", "platens_cube"]


def lines_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


class Library(unittest.TestCase):
    def test_c30_under_pressure_shows_what_is_recorded(self):
        recorded = {(one["test"], one["quantity"]): float(one["value"]) for one in lines_of(ROOT / "docs/results/library.csv")
                    if (one["material"], one["elements"], one["specimen"]) == ("C30", ELEMENTS, PACKING)}
        tests = TESTS + (MORE if os.environ.get("LIBRARY_TESTS") == "all" else [])
        with tempfile.TemporaryDirectory() as folder:
            only = [word for test in tests for word in ("--only", test)]
            done = subprocess.run([PROGRAM, "test", ROOT / "cases/rc_slab", "--material", "c30", "--set", "material.c30.use=C30", "--elements", ELEMENTS, "--seeds", "1",
                                   "--first-seed", PACKING, "-o", folder, *only], capture_output=True, text=True)
            self.assertIn(done.returncode, (0, 9), done.stderr)
            shown = {(one["test"], one["quantity"]): float(one["value"]) for one in lines_of(pathlib.Path(folder) / "specimens.csv")}
        compared = {key: value for key, value in recorded.items() if key in shown}
        self.assertEqual({test for test, _ in compared}, set(tests))
        for key, value in compared.items():
            same = math.isclose(shown[key], value, rel_tol=1e-6) or (math.isnan(shown[key]) and math.isnan(value))  # a cube that did not get to three times its strain
            self.assertTrue(same, f"{key}: {shown[key]} for {value}")


if __name__ == "__main__":
    unittest.main()
