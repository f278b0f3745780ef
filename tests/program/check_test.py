"""What `breccia check` refuses where `run` once ended by a signal."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["BRECCIA"]
ATTACK = pathlib.Path(__file__).resolve().parents[1] / "attack"
CASES = pathlib.Path(__file__).resolve().parents[2] / "cases"


class Check(unittest.TestCase):
    def told(self, text, *options):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copy(ATTACK / "pierced.inp", folder)
            path = pathlib.Path(folder) / "case.toml"
            path.write_text(text)
            done = subprocess.run([PROGRAM, "check", path, *options], capture_output=True, text=True)
            return done.returncode, done.stdout + done.stderr

    # Another fluid did nothing beside one that flows, and an explosive ended the program by a signal.
    def test_a_fluid_that_flows_is_the_only_one(self):
        text = (ATTACK / "fluids.toml").read_text()
        self.assertEqual(self.told(text)[0], 0)
        before, after = text.split('name = "water"\nkind = "fluid"\n', 1)
        code, words = self.told(before + 'name = "water"\nkind = "fluid"\nviscosity = 1e-3\n' + after)
        self.assertEqual(code, 2)
        self.assertIn("load.anfo.kind: a fluid that flows, as load.water, is the only fluid", words)

    # Tetrahedra had no fluids.
    def test_fluids_of_tetrahedra_obey_the_rules_of_triangles(self):
        text = (CASES / "penny_fracture" / "small.toml").read_text()
        self.assertEqual(self.told(text)[0], 0)
        for line, problem in (
            ('viscosity = "1e-6 Pa s"', 'load.water.rate: needs kind = "fluid" and a viscosity above 0'),
            ('kind = "fluid"', "load.water.viscosity: only a fluid has one"),
        ):
            code, words = self.told(text.replace(line + "\n", ""))
            self.assertEqual(code, 2)
            self.assertIn(problem, words)
        code, words = self.told(text.replace('radius = "0.26 m"\nviscosity', 'radius = "1 cm"\nviscosity'), "--model")
        self.assertEqual(code, 2)
        self.assertIn("load.water: its region holds corners, but no edge of any tetrahedron", words)

    # Such a mesh counted as one whose size is not known, which `check` does not build.
    def test_triangles_larger_than_their_body_are_built(self):
        text = (ATTACK / "bolted.toml").read_text()
        self.assertIn('mesh_size = "2 mm"', text)
        self.assertEqual(self.told(text)[0], 0)
        code, words = self.told(text.replace('mesh_size = "2 mm"', 'mesh_size = "2 m"'))
        self.assertEqual(code, 2)
        self.assertIn("discontinuity.crack: meets no edge between two triangles", words)

    # Names with spaces and dots took line and key away: the path of a key was parted at them.
    def test_names_with_spaces_and_dots_keep_the_line(self):
        text = """breccia = 1
method = "fdem2d"
time.end = "1 ms"
[material."rock no. 2"]
joints = "none"
[[body]]
name = "the block"
material = "rock no. 2"
size = [1.0, 1.0]
mesh_size = 0.5
[[load]]
name = "side no. 3"
pressure = 1.0
[[stage]]
name = "wait for v1.5"
when = "forces > 3e5"
[[stage.load]]
name = "side no. 3"
pressure = [[0, 0], [2, 1], [1, 0]]
"""
        code, words = self.told(text)
        self.assertEqual(code, 2)
        self.assertIn('line 16, stage.wait for v1.5.when: "forces" is not a probe', words)
        self.assertIn("line 19, stage.wait for v1.5.load.side no. 3.pressure[2]: its time", words)

    STRIP = """breccia = 1
method = "fdem2d"
time.end = "2 ms"
[material.rock]
[[body]]
name = "strip"
material = "rock"
size = [0.2, 0.1]
mesh_size = 0.05
[[support]]
name = "left"
max = [-0.099, 1.0]
[[load]]
name = "side"
min = [0.099, -1.0]
"""

    # Each of these was called good.
    def test_stages_that_never_begin_and_tables_that_begin_too_late(self):
        stages = """[[stage]]
name = "wait"
until = "1 ms"
[[stage.load]]
name = "side"
pressure = [["1.5 ms", 0], ["2 ms", 1e6]]
[[stage]]
name = "press"
until = "2 ms"
"""
        code, words = self.told(self.STRIP + stages)  # the load stays as it is in the next stage
        self.assertEqual(code, 0, words)
        self.assertNotIn("first row", words)
        changed = stages + '[[stage.load]]\nname = "side"\npressure = 1e6\n'
        code, words = self.told(self.STRIP + changed)
        self.assertEqual(code, 0, words)
        words = " ".join(words.split())
        self.assertIn("line 21, stage.wait.load.side.pressure: the table begins at 1.5 ms, and counts for 1 ms", words)
        last = changed.replace('until = "1 ms"', 'until = "3 ms"') + '[[stage]]\nname = "never"\n'
        code, words = self.told(self.STRIP + last)
        self.assertEqual(code, 0, words)
        words = " ".join(words.split())
        self.assertIn("line 22, stage.press: never begins: the stages before it last 3 ms at least, and time.end is 2 ms", words)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "case.toml"
            path.write_text(self.STRIP + last)
            done = subprocess.run([PROGRAM, "run", path, "--steps", "1", "-o", f"{folder}/out"], capture_output=True, text=True)
            self.assertIn("line 22, stage.press: never begins", done.stdout + done.stderr)

    def test_stages_that_leave_nothing_or_never_end(self):
        stage = '[[stage]]\nname = "wait"\nuntil = 1e-4\n[[stage]]\nname = "dig"\n'
        code, words = self.told(self.STRIP + stage + 'remove = ["strip"]\n')
        self.assertEqual(code, 2)
        self.assertIn("line 21, stage.dig.remove takes out all that is left", words)
        probe = '[[probe]]\nname = "push"\non = "left"\nquantity = "force_x"\n'
        code, words = self.told(self.STRIP + probe + '[[stage]]\nname = "wait"\nwhen = "push > inf"\n')
        self.assertEqual(code, 2)
        self.assertIn('line 22, stage.wait.when = "push > inf": no probe reads more', words)

    def test_joints_and_cuts_that_lie_in_no_body(self):
        beds = '[[joint_set]]\nname = "beds"\nmin = [1.0, 0.0]\nmax = [2.0, 1.0]\nspacing = 0.1\n'
        code, words = self.told(self.STRIP + beds)
        self.assertEqual(code, 2)
        self.assertIn("line 18, joint_set.beds.min = 1 m: the region takes nothing; strip is nearest", words)
        code, words = self.told("""breccia = 1
method = "dem3d"
time.end = "1 ms"
[material.rock]
law = "concrete"
[[body]]
name = "slab"
material = "rock"
size = [0.1, 0.1, 0.1]
pack = { count = 60 }
[[body.cut]]
size = [0.02, 0.02, 0.2]
[[body.cut]]
center = [0.08, 0.0, 0.0]
size = [0.02, 0.02, 0.2]
""")
        self.assertEqual(code, 2)
        self.assertIn("line 14, body.slab.cut[1].center: it takes nothing out of slab, 20 mm away", words)


if __name__ == "__main__":
    unittest.main()
