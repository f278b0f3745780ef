"""What `breccia check` refuses where `run` once ended by a signal."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

PROGRAM = os.environ["BRECCIA"]
ATTACK = pathlib.Path(__file__).resolve().parents[1] / "attack"


class Check(unittest.TestCase):
    def told(self, text):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copy(ATTACK / "pierced.inp", folder)
            path = pathlib.Path(folder) / "case.toml"
            path.write_text(text)
            done = subprocess.run([PROGRAM, "check", path], capture_output=True, text=True)
            return done.returncode, done.stdout + done.stderr

    # Another fluid did nothing beside one that flows, and an explosive ended the program by a signal.
    def test_a_fluid_that_flows_is_the_only_one(self):
        text = (ATTACK / "fluids.toml").read_text()
        self.assertEqual(self.told(text)[0], 0)
        before, after = text.split('name = "water"\nkind = "fluid"\n', 1)
        code, words = self.told(before + 'name = "water"\nkind = "fluid"\nviscosity = 1e-3\n' + after)
        self.assertEqual(code, 2)
        self.assertIn("load.anfo.kind: a fluid that flows, as load.water, is the only fluid", words)

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


if __name__ == "__main__":
    unittest.main()
