"""`breccia mesh info` against geometry known by hand, and `breccia convert` there and back."""

import math
import os
import pathlib
import subprocess
import tempfile
import unittest

from two_balls import case_with

PROGRAM = os.environ["BRECCIA"]
H = math.sqrt(3) / 2
# Two equilateral triangles of 10 mm, one of them a part of its own, and a line along the bottom.
MESH = f"""$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
1 1 "floor"
2 2 "left half"
2 3 "right"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 0.01 0 0
3 0.005 {0.01 * H!r} 0
4 0.015 {0.01 * H!r} 0
$EndNodes
$Elements
3
1 1 2 1 1 1 2
2 2 2 2 2 1 2 3
3 2 2 3 3 2 4 3
$EndElements
"""
# Two regular tetrahedra of 10 mm, base on base: the upper one a part, the base a surface.
SOLID = f"""$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "middle"
3 2 "upper"
$EndPhysicalNames
$Nodes
5
1 0 0 0
2 0.01 0 0
3 0.005 {0.01 * H!r} 0
4 0.005 {0.01 * H / 3!r} {0.01 * math.sqrt(2 / 3)!r}
5 0.005 {0.01 * H / 3!r} {-0.01 * math.sqrt(2 / 3)!r}
$EndNodes
$Elements
3
1 2 2 1 1 1 2 3
2 4 2 2 2 1 2 3 4
3 4 2 0 3 1 3 2 5
$EndElements
"""
CASE = """
method = "fdem2d"
time.end = "20 us"
output = { frames = 1, pictures = false }
gravity = [3e5, -2e5]
[material.rock]
density = 2600.0
young = "30 GPa"
poisson = 0.2
joint = { tension = "3 MPa", cohesion = "10 MPa", friction_angle = "30 deg", energy_open = 10.0, energy_slide = 50.0 }
[[body]]
name = "pair"
material = "rock"
shape = "mesh"
file = "FILE"
"""


class Meshes(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.path = pathlib.Path(scratch.name)
        (self.path / "pair.msh").write_text(MESH)

    def breccia(self, *words, code=0):
        done = subprocess.run([PROGRAM, *words], cwd=self.path, capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout if code == 0 else done.stderr

    def told(self, file):
        """Lines of `mesh info` by their first word; of several with one word the last."""
        lines = self.breccia("mesh", "info", file).splitlines()[1:]
        self.assertTrue(all(len(line) <= 80 for line in lines), lines)
        return {line[2:13].strip(): line[14:] for line in lines}

    def test_info_of_equilateral_triangles(self):
        told = self.told("pair.msh")
        self.assertEqual(told["triangles"], "2, vertices 4")
        self.assertEqual(told["edges"], "5, 4 of them on the rim")
        self.assertEqual(told["extent"].split(",")[0], "15 mm x 8.66 mm")
        self.assertAlmostEqual(float(told["area"].split()[0]), 2 * 0.5 * 0.01 * 0.01 * H, delta=1e-10)
        self.assertTrue(told["edge length"].startswith("10 mm to 10 mm"), told)
        self.assertTrue(told["least angle"].startswith("60.0 deg"), told)
        self.assertTrue(told["quality"].startswith("mean 1.000, least 1.000"), told)
        self.assertIn("8.66 mm", told["step"])
        self.assertEqual(told["part"], "right: 1 triangles, 4.33e-05 m2")
        self.assertEqual(told["line"], "floor: 1 edges, 10 mm")

    def test_a_run_is_the_same_with_the_mesh_in_any_format(self):
        hashes = set()
        for number, file in enumerate(("pair.msh", "pair.inp", "again.msh")):
            if number > 0:
                self.breccia("convert", ("pair.msh", "pair.inp")[number - 1], file)
                self.assertEqual(self.told(file)["part"].split(":")[1], " 1 triangles, 4.33e-05 m2")
            (self.path / "case.toml").write_text(CASE.replace("FILE", file))
            self.breccia("run", "case.toml", "-o", f"out{number}", "-q", "--threads", "1")
            summary = (self.path / f"out{number}/summary.json").read_text()
            hashes.add(summary.split('"state_hash": "')[1][:16])
        self.assertEqual(len(hashes), 1, hashes)
        self.breccia("convert", "out0", "moved.msh", "--frame", "0")
        self.assertEqual(self.told("moved.msh")["triangles"], "2, vertices 4")

    def test_spheres_of_a_run_and_of_a_model_come_back(self):
        (self.path / "balls.toml").write_text(case_with("output = { frames = 1, pictures = false }"))
        self.breccia("run", "balls.toml", "-o", "out", "-q", "--threads", "1")
        self.breccia("prepare", "balls.toml", "-o", "balls.br")
        for source in ("out", "balls.br"):
            self.breccia("convert", source, "balls.csv")
            self.assertEqual(self.told("balls.csv")["spheres"], "2")
            self.assertEqual(self.told(source)["radius"], self.told("balls.csv")["radius"])

    def test_info_of_regular_tetrahedra(self):
        (self.path / "solid.msh").write_text(SOLID)
        for file in ("solid.msh", "solid.inp", "again.msh"):
            if file != "solid.msh":
                self.breccia("convert", {"solid.inp": "solid.msh", "again.msh": "solid.inp"}[file], file)
            told = self.told(file)
            self.assertEqual(told["tetrahedra"], "2, vertices 5")
            self.assertEqual(told["faces"], "7, 6 of them on the surface")
            volume = 2 * 0.01**3 / (6 * math.sqrt(2))
            self.assertAlmostEqual(float(told["volume"].split()[0]), volume, delta=1e-5 * volume)
            self.assertAlmostEqual(float(told["volume"].split()[3]), 6 * 0.5 * 0.01 * 0.01 * H, delta=1e-9)
            self.assertTrue(told["edge length"].startswith("10 mm to 10 mm"), told)
            self.assertTrue(told["quality"].startswith("mean 1.000, least 1.000"), told)
            self.assertIn("8.165 mm", told["step"])  # sqrt(2/3) of the edge
            self.assertEqual(told["part"], "upper: 1 tetrahedra, 1.179e-07 m3")
            self.assertEqual(told["surface"], "middle: 1 faces, 4.33e-05 m2")
        (self.path / "solid.toml").write_text(
            CASE.replace("fdem2d", "fdem3d").replace("-2e5]", "-2e5, 0.0]").replace("FILE", "solid.msh"))
        self.breccia("run", "solid.toml", "-o", "solid", "-q", "--threads", "1")
        self.breccia("convert", "solid", "moved.msh", "--frame", "0")
        for source in ("solid", "moved.msh"):
            told = {line.split()[0]: line for line in self.breccia("mesh", "info", source, "--frame", "0").splitlines()[1:]}
            self.assertIn("2, vertices 5", told["tetrahedra"])
            self.assertIn("pair: 2 tetrahedra, 2.357e-07 m3", told["part"])
        self.breccia("convert", "solid.msh", "solid.vtu")
        self.assertIn('Name="types"', (self.path / "solid.vtu").read_bytes().decode("latin1"))

    def test_other_files_are_told_what_may_be_looked_at(self):
        (self.path / "part.stl").write_text("solid part\nendsolid part\n")
        said = self.breccia("mesh", "info", "part.stl", code=2)
        self.assertIn(".stl is no mesh and no packing", said)
        self.assertIn(".msh", said)

    def test_what_cannot_be_is_refused(self):
        self.assertIn("a mesh is written as", self.breccia("convert", "pair.msh", "x.csv", code=2))
        self.assertIn("no.msh", self.breccia("mesh", "info", "no.msh", code=3))
        self.breccia("mesh", code=2)
        self.assertFalse((self.path / "x.csv").exists())


if __name__ == "__main__":
    unittest.main()
