"""Gravity and the spin of walls by tables over time; friction of walls, restitution and strengths of joints that a stage
changes; regions by polygon."""

import csv
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["BRECCIA"]
BALL = """breccia = 1
method = "dem3d"
time = {{ end = "2 ms", max_step = "1 us" }}
output = {{ frames = 1, pictures = false, history = "0.5 ms" }}
energy = {{ stop = 0 }}
{gravity}
[material.steel]
law = "grain"
density = 7800.0
young = "2 GPa"
[contact]
law = "hertz"
friction = 0.0
[[body]]
name = "ball"
shape = "element"
material = "steel"
radius = 0.01
{of_ball}
[[probe]]
name = "v"
on = "ball"
quantity = "velocity_{axis}"
{more}
"""
PLATE = """breccia = 1
method = "{method}"
time = {{ end = "2 ms", max_step = "2 us" }}
output = {{ frames = 1, pictures = false }}
gravity = {gravity}
[material.rock]
joints = "none"
[[body]]
name = "plate"
material = "rock"
size = {size}
mesh_size = 0.1
[[probe]]
name = "v"
on = "plate"
quantity = "velocity_y"
{more}
"""
BOTH = """breccia = 1
method = ["dem3d", "fdem3d"]
time = {{ end = "2 ms", max_step = "2 us" }}
output = {{ frames = 1, pictures = false, history = "0.1 ms" }}
energy = {{ stop = 0 }}
{gravity}
[spheres.material.steel]
law = "grain"
density = 7800.0
young = "2 GPa"
[[spheres.body]]
name = "ball"
shape = "element"
material = "steel"
radius = 0.01
center = [0.0, 0.0, 0.2]
[tetrahedra.material.rock]
joints = "none"
[[tetrahedra.body]]
name = "cube"
material = "rock"
size = [0.1, 0.1, 0.1]
mesh_size = 0.1
[[probe]]
name = "v"
on = "ball"
quantity = "velocity_z"
[[probe]]
name = "cube"
on = "cube"
quantity = "velocity_z"
{more}
"""


class Tables(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def breccia(self, *words, code=0):
        done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def ran(self, text, *words):
        """Last row of the history, and the summary."""
        case, out = pathlib.Path(self.folder.name) / "case.toml", pathlib.Path(self.folder.name) / "out"
        case.write_text(text)
        self.breccia("run", case, "-o", out, "--force", "-q", *words)
        return self.result(out)

    def result(self, out):
        rows = list(csv.DictReader((out / "history.csv").read_text().splitlines()))
        return {k: float(v) for k, v in rows[-1].items() if k != "stage"}, json.loads((out / "summary.json").read_text())

    def ball(self, gravity="", of_ball="", axis="z", more=""):
        return BALL.format(gravity=gravity, of_ball=of_ball, axis=axis, more=more)

    RISES = 'gravity = [[0, 0, 0, 0], ["1 ms", 0, 0, -10.0], ["2 ms", 0, 0, 0]]'

    def test_a_ball_falls_by_the_integral_of_the_table(self):
        row, summary = self.ran(self.ball(self.RISES))
        self.assertAlmostEqual(row["v"], -0.01, delta=1e-7)
        self.assertLess(abs(row["error_relative"]), 1e-5)
        self.assertEqual(summary["state_hash"], self.ran(self.ball(self.RISES), "--threads", "2")[1]["state_hash"])
        out = pathlib.Path(self.folder.name) / "out"
        self.ran(self.ball(self.RISES), "--steps", "1234")
        self.breccia("resume", out, "-q")
        self.assertEqual(self.result(out)[1]["state_hash"], summary["state_hash"])
        self.assertEqual(self.result(out)[0], row)

    def test_spheres_and_tetrahedra_of_one_run_fall_alike(self):
        for step in (1, 7):  # what is left of ten steps when the run is ended
            row, summary = self.ran(BOTH.format(gravity=self.RISES, more=""))
            for probe in ("v", "cube"):
                self.assertAlmostEqual(row[probe], -0.01, delta=1e-6, msg=probe)
            self.assertLess(abs(row["error_relative"]), 1e-4)
            out = pathlib.Path(self.folder.name) / "out"
            rows = (out / "history.csv").read_text()
            self.ran(BOTH.format(gravity=self.RISES, more=""), "--steps", str(400 + step))
            self.breccia("resume", out, "-q")
            self.assertEqual(self.result(out)[1]["state_hash"], summary["state_hash"])
            self.assertEqual((out / "history.csv").read_text(), rows)
        stages = '[[stage]]\nname = "wait"\nuntil = "1 ms"\n[[stage]]\nname = "fall"\n'
        row, summary = self.ran(BOTH.format(gravity="", more=stages + 'gravity = [[0, 0, 0, 0], ["1 ms", 0, 0, -10.0]]'))
        for probe in ("v", "cube"):
            self.assertAlmostEqual(row[probe], -5e3 * (row["time"] - summary["stage"][1]["begin"]) ** 2, delta=1e-6, msg=probe)

    def test_a_table_of_one_value_is_that_value(self):
        hashes = [self.ran(self.ball(f"gravity = {g}"))[1]["state_hash"] for g in ("[0, 0, -9.81]", "[[0, 0, 0, -9.81], [1, 0, 0, -9.81]]")]
        self.assertEqual(*hashes)

    def test_the_time_of_a_stage_begins_with_it(self):
        stages = '[[stage]]\nname = "wait"\nuntil = "1 ms"\n[[stage]]\nname = "fall"\n'
        row, summary = self.ran(self.ball("", more=stages + 'gravity = [[0, 0, 0, 0], ["1 ms", 0, 0, -10.0]]'))
        self.assertAlmostEqual(row["v"], -5e3 * (row["time"] - summary["stage"][1]["begin"]) ** 2, delta=1e-7)
        self.assertLess(abs(row["error_relative"]), 1e-5)

    def test_triangles_and_tetrahedra_fall_alike(self):
        for method, size, table in (
            ("fdem2d", "[0.2, 0.1]", '[[0, 0, 0], ["1 ms", 0, -10.0], ["2 ms", 0, 0]]'),
            ("fdem3d", "[0.2, 0.1, 0.1]", '[[0, 0, 0, 0], ["1 ms", 0, -10.0, 0], ["2 ms", 0, 0, 0]]'),
        ):
            row, _ = self.ran(PLATE.format(method=method, size=size, gravity=table, more=""))
            rows = (pathlib.Path(self.folder.name) / "out" / "history.csv").read_text()
            self.ran(PLATE.format(method=method, size=size, gravity=table, more=""), "--steps", "47")
            self.breccia("resume", pathlib.Path(self.folder.name) / "out", "-q")
            self.assertEqual((pathlib.Path(self.folder.name) / "out" / "history.csv").read_text(), rows, method)
            self.assertAlmostEqual(row["v"], -0.01, delta=1e-6, msg=method)
            self.assertLess(abs(row["error_relative"]), 1e-4, method)

    DRUM = """[[wall]]
name = "drum"
shape = "sphere"
point = [0.0, 0.0, -0.0599]
radius = 0.05
friction = 0.5
spin = {spin}
"""

    def test_a_wall_turns_as_its_table_says(self):
        weight = "gravity = [0, 0, -9.81]"
        told = [self.ran(self.ball(weight, axis="x", more=self.DRUM.format(spin=s))) for s in ("[0, 40, 0]", "[[0, 0, 40, 0], [1, 0, 40, 0]]", '[[0, 0, 0, 0], ["2 ms", 0, 80, 0]]')]
        self.assertEqual(told[0][1]["state_hash"], told[1][1]["state_hash"])
        self.assertGreater(told[0][0]["v"], 0.0)
        self.assertNotEqual(told[0][1]["state_hash"], told[2][1]["state_hash"])
        aside = '[[wall]]\nname = "floor"\npoint = [0.0, 0.0, -0.01]\nspin = [[0, 0, 0, 1.0], [1, 0, 2.0, 0]]\n'
        case = pathlib.Path(self.folder.name) / "case.toml"
        case.write_text(self.ball(weight, more=aside))
        self.assertIn("wall.floor.spin: a plane without end turns about its normal only", self.breccia("check", case, code=2))

    def test_a_floor_rubs_from_a_stage_on(self):
        floor = '[[wall]]\nname = "floor"\npoint = [0.0, 0.0, -0.01]\nfriction = 0.0\n'
        stages = '[[stage]]\nname = "smooth"\nuntil = "1 ms"\n[[stage]]\nname = "rough"\n[[stage.wall]]\nname = "floor"\nfriction = 0.3\n'
        of_ball = "velocity = [0.5, 0.0, 0.0]"
        weight = "gravity = [0, 0, -9.81]"
        row, _ = self.ran(self.ball(weight, of_ball, "x", floor + stages.replace("friction = 0.3", "")))
        self.assertEqual(row["v"], 0.5)
        slowed, _ = self.ran(self.ball(weight, of_ball, "x", floor + stages))
        self.assertLess(slowed["v"], 0.5)

    def test_a_ball_bounces_less_from_a_stage_on(self):
        floor = '[[wall]]\nname = "floor"\npoint = [0.0, 0.0, -0.0101]\n'
        stages = '[[stage]]\nname = "hard"\nuntil = "0.05 ms"\n[[stage]]\nname = "dull"\n'
        for more, back in (("", 1.0), ("restitution = 0.5\n", 0.5)):
            row, _ = self.ran(self.ball("", "velocity = [0.0, 0.0, -1.0]", more=floor + stages + more))
            self.assertAlmostEqual(row["v"], back, delta=0.005)
            self.assertLess(abs(row["error_relative"]), 1e-3)

    def test_joints_of_tetrahedra_become_weaker(self):
        more = """[[support]]
name = "foot"
max = [-0.0099, 1.0, 1.0]
[[support]]
name = "head"
min = [0.0099, -1.0, -1.0]
fix = ["x"]
velocity = [0.05, 0.0, 0.0]
[[probe]]
name = "force"
on = "head"
quantity = "force_x"
reduce = "sum"
[[stage]]
name = "strong"
until = "30 us"
[[stage]]
name = "weak"
[[stage.support]]
name = "head"
velocity = [0.05, 0.0, 0.0]
"""
        text = PLATE.format(method="fdem3d", size="[0.02, 0.01, 0.01]", gravity="[0, 0, 0]", more=more).replace("mesh_size = 0.1", "mesh_size = 0.01").replace("2 ms", "0.15 ms")
        rock = 'joints = "intrinsic"\nyoung = "30 GPa"\njoint = {{ tension = "{} MPa" }}'
        peaks = []
        for tension, later in ((2, ""), (5, '[[stage.material]]\nname = "rock"\njoint = { tension = "2 MPa" }\n'), (5, "")):
            row, summary = self.ran(text.replace('joints = "none"', rock.format(tension)) + later)
            peaks.append(-summary["probe"]["force"]["min"])
            self.assertLess(abs(row["error_relative"]), 5e-3)
        self.assertAlmostEqual(peaks[1], peaks[0], delta=0.02 * peaks[0])
        self.assertGreater(peaks[2], 1.5 * peaks[0])

    def test_polygons_take_what_lies_in_their_prism(self):
        """Of two balls along y one is held by a triangle seen along x; of a block of tetrahedra a face."""
        other = '[[body]]\nname = "other"\nshape = "element"\nmaterial = "steel"\nradius = 0.01\ncenter = [0.0, 0.1, 0.0]\n'
        probe = '[[probe]]\nname = "w"\non = "other"\nquantity = "velocity_z"\n'
        held = '[[support]]\nname = "prism"\naround = "x"\npolygon = [[0.05, -0.01], [0.15, -0.01], [0.1, 0.05]]\nfix = ["z"]\n'
        row, _ = self.ran(self.ball("gravity = [0, 0, -10.0]", more=other + probe + held))
        self.assertAlmostEqual(row["v"], -10.0 * row["time"], delta=1e-6)
        self.assertEqual(row["w"], 0.0)
        hashes = []
        for region in ('polygon = [[-0.11, -0.06], [-0.09, -0.06], [-0.09, 0.06], [-0.11, 0.06]]\naround = "z"', "max = [-0.09, 1.0, 1.0]"):
            more = f'[[support]]\nname = "left"\n{region}\n'
            text = PLATE.format(method="fdem3d", size="[0.2, 0.1, 0.1]", gravity="[0, -10.0, 0]", more=more)
            hashes.append(self.ran(text)[1]["state_hash"])
        self.assertEqual(*hashes)


if __name__ == "__main__":
    unittest.main()
