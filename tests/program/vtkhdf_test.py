"""`output.format = "vtkhdf"`: what h5py finds in the frames of a run, resuming, and `breccia convert` there and back."""

import json
import os
import pathlib
import resource
import shutil
import subprocess
import tempfile
import unittest
import zlib

import h5py
import numpy

from two_balls import case_with

PROGRAM = os.environ["BRECCIA"]
FORGED = pathlib.Path(__file__).parents[1] / "attack/corpus/vtkhdf"
CASE = case_with('output = { frames = 4, pictures = false, format = "vtkhdf" }')


def files_of(folder, kinds=("elements", "links", "contacts", "walls")):
    return {path.name: path.read_bytes() for path in sorted((folder / "fields").iterdir()) if path.name.startswith(kinds)}


CONVERTED = ("elements", "links")


class Vtkhdf(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.path = pathlib.Path(cls.scratch.name)
        (cls.path / "balls.toml").write_text(CASE)
        cls.breccia("run", "balls.toml", "-o", "out", "-q", "--threads", "1")

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @classmethod
    def breccia(cls, *words, code=0):
        done = subprocess.run([PROGRAM, *words], cwd=cls.path, capture_output=True, text=True)
        if done.returncode != code:
            raise AssertionError(f"{words} ended with {done.returncode}: {done.stdout}{done.stderr}")
        return done.stdout + done.stderr

    def test_h5py_finds_the_grid_its_fields_and_units(self):
        series = json.loads((self.path / "out/elements.hdf.series").read_text())
        self.assertEqual(len(series["files"]), 5)
        self.assertEqual(len(json.loads((self.path / "out/contacts.hdf.series").read_text())["files"]), 5)
        with h5py.File(self.path / "out" / series["files"][-1]["name"], "r") as file:
            root = file["VTKHDF"]
            self.assertEqual(list(root.attrs["Version"]), [1, 0])
            self.assertEqual(root.attrs["Type"], b"UnstructuredGrid")
            points = int(root["NumberOfPoints"][0])
            self.assertEqual(root["Points"].shape, (points, 3))
            self.assertEqual(list(root["Offsets"]), list(range(points + 1)))
            self.assertEqual(list(root["Connectivity"]), list(range(points)))
            self.assertEqual(set(root["Types"]), {1})
            velocity = root["PointData/velocity"]
            self.assertEqual(velocity.shape, (points, 3))
            self.assertEqual(velocity.attrs["units"], b"m/s")
            self.assertEqual(root["PointData/id"].dtype, numpy.int32)
            self.assertEqual(root["FieldData/TIME"][0], series["files"][-1]["time"])
            names = bytes(root["FieldData/groups"]).split(b"\0")
        self.assertEqual(names[-1], b"")

    def test_the_frames_are_those_of_vtu_and_converting_gives_their_bytes(self):
        self.breccia("run", "balls.toml", "-o", "xml", "-q", "--threads", "1", "--set", "output.format=vtu")
        self.assertFalse(list((self.path / "out").glob("*.pvd")))
        self.breccia("convert", "xml", "to_hdf", "--frames", "vtkhdf")
        self.assertEqual(files_of(self.path / "to_hdf"), files_of(self.path / "out", CONVERTED))
        self.breccia("convert", "out", "to_xml", "--frames", "vtu")
        self.assertEqual(files_of(self.path / "to_xml"), files_of(self.path / "xml", CONVERTED))
        said = self.breccia("convert", "out", "to_xml", "--frames", "vtu", code=2)
        self.assertIn("holds frames already", said)

    def test_commands_read_the_frames(self):
        self.breccia("render", "out", "-o", "last.png", "--color", "velocity")
        self.breccia("report", "out")
        self.assertIn("spheres", self.breccia("mesh", "info", "out"))
        self.breccia("convert", "out", "spheres.hdf")
        with h5py.File(self.path / "spheres.hdf", "r") as file:
            self.assertIn("radius", file["VTKHDF/PointData"])

    def test_a_small_file_that_asks_for_much_memory_is_refused(self):
        shutil.copytree(self.path / "out", self.path / "forged")
        for path in (self.path / "forged/fields").glob("elements*.hdf"):
            with h5py.File(path, "r+") as file:
                rows = file["VTKHDF/PointData/velocity"].shape[0]
                del file["VTKHDF/PointData/velocity"]
                whole = file.create_dataset("VTKHDF/PointData/velocity", (rows, 3), "f8", maxshape=(None, 3),
                                            chunks=(1 << 27, 3), compression="gzip")  # a chunk of 3.2 GB
                whole.id.write_direct_chunk((0, 0), zlib.compress(bytes(24 * rows)))
        limit = (1 << 30, 1 << 30)
        done = subprocess.run([PROGRAM, "render", "forged", "-o", "forged.png"], cwd=self.path, capture_output=True, text=True,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, limit))
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        self.assertIn("damaged", done.stderr)

    def test_forged_files_end_no_command_by_a_signal(self):
        shutil.copytree(self.path / "out", self.path / "hostile")
        for forged in sorted(FORGED.iterdir()):
            for path in (self.path / "hostile/fields").glob("elements*.hdf"):
                shutil.copy(forged, path)
            for words in (["render", "hostile", "-o", "hostile.png"], ["render", "hostile", "-o", "hostile.gif"],
                          ["report", "hostile"], ["mesh", "info", "hostile"], ["convert", "hostile", "hostile.vtu"],
                          ["convert", "hostile", "to_hostile", "--frames", "vtu"], ["info", "hostile/fields/elements_0000.hdf"]):
                shutil.rmtree(self.path / "to_hostile", ignore_errors=True)
                self.assertIn("hostile/fields/", self.breccia(*words, code=3), words)

    def test_numbers_are_read_from_the_file_itself_alone(self):
        numbers = numpy.arange(6.0).reshape(2, 3)
        (self.path / "secret").write_bytes(numbers.tobytes())
        shutil.copytree(self.path / "out", self.path / "other")
        path = sorted((self.path / "other/fields").glob("elements*.hdf"))[-1]
        for layout, code in (({}, 0), ({"chunks": (1, 3)}, 0), ({"external": [(str(self.path / "secret"), 0, 48)]}, 3)):
            with h5py.File(path, "r+") as file:
                del file["VTKHDF/Points"]
                whole = file.create_dataset("VTKHDF/Points", (2, 3), "f8", **layout)
                if code == 0:
                    whole[:] = numbers
            said = self.breccia("convert", "other", "other.csv", code=code)
            if code == 0:
                self.assertIn("3,4,5", (self.path / "other.csv").read_text())
            else:
                self.assertIn("Points is neither chunked nor in one piece of this file", said)

    def test_a_run_that_goes_on_leaves_the_same_files(self):
        words = ["-q", "--threads", "1"]
        end = json.loads((self.path / "out/summary.json").read_text())["time"]
        self.breccia("run", "balls.toml", "-o", "broken", *words, "--until", str(0.6 * end))
        self.assertIn("one format", self.breccia("resume", "broken", "--set", "output.format=vtu", code=2))
        self.breccia("resume", "broken", *words, "--until", str(end))
        self.assertEqual(files_of(self.path / "broken"), files_of(self.path / "out"))


if __name__ == "__main__":
    unittest.main()
