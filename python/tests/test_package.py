"""The package against the program: same bits, same texts, no copies."""

import gc
import os
import pathlib
import runpy
import subprocess
import tempfile
import unittest

import numpy

import breccia as br

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("BRECCIA", str(ROOT / "build/release/breccia"))

BALLS = {
    "method": "dem3d",
    "energy": {"warn": 0.0, "stop": 0.0},
    "time": {"end": "2 ms"},
    "output": {"frames": 2, "width": 64, "height": 64},
    "material": {"rock": {"law": "grain", "young": "1 GPa"}},
    "body": [
        {
            "name": name,
            "shape": "element",
            "material": "rock",
            "center": [side * 0.011, 0.0, 0.0],
            "radius": "10 mm",
            "velocity": [-2.0 * side, 0.0, 0.0],
        }
        for name, side in (("left", -1), ("right", 1))
    ],
    "probe": [{"name": "left_x", "on": "left", "quantity": "position_x"}],
}


def in_folder(test):
    """Calls the test with a folder that goes with its end."""

    def wrapped(self):
        with tempfile.TemporaryDirectory() as folder:
            test(self, pathlib.Path(folder))

    wrapped.__name__, wrapped.__doc__ = test.__name__, test.__doc__
    return wrapped


def balls(**overrides):
    return br.Case(BALLS, set=overrides, name="balls")


class SameBits(unittest.TestCase):
    def by_program(self, case, folder, *options):
        subprocess.run(
            [PROGRAM, "run", case, "-o", folder, "--threads", "1", "-q", *options], check=True
        )
        return br.load(folder)

    def compare(self, case, until, folder):
        path = ROOT / "cases" / case / "small.toml"
        run = self.by_program(path, folder / "out", "--until", str(until))
        sim = br.Simulation(br.Case(path), threads=2)
        self.assertTrue(sim.run(until=until, stop=lambda _: False, every=7))
        self.assertEqual(sim.hash, run.hash)
        self.assertEqual(sim.steps, run.summary["steps"])
        self.assertEqual(sim.time, run.summary["time"])
        for name, value in sim.energies.items():
            if name not in ("start", "error_relative"):
                self.assertEqual(value, run.summary["energy"][name], name)

    @in_folder
    def test_slab_has_the_hash_of_the_program(self, folder):
        self.compare("rc_slab", 2e-5, folder)

    @in_folder
    def test_box_in_the_plane_has_the_hash_of_the_program(self, folder):
        self.compare("moving_box", 2e-3, folder)

    @in_folder
    def test_run_leaves_what_the_program_leaves(self, folder):
        run = br.run(balls(), folder / "here")
        (folder / "balls.toml").write_text(balls().text)
        other = self.by_program(folder / "balls.toml", folder / "there")
        self.assertEqual(run.hash, other.hash)
        self.assertEqual(
            (folder / "here/history.csv").read_bytes(), (folder / "there/history.csv").read_bytes()
        )
        with self.assertRaisesRegex(br.InputError, "--force"):
            br.run(balls(), folder / "here")
        self.assertEqual(br.run(balls(), folder / "here", replace=True).hash, other.hash)


class Arrays(unittest.TestCase):
    def test_are_the_state_itself(self):
        sim = br.Simulation(balls(), threads=1)
        x, v = sim.positions, sim.velocities
        self.assertEqual((x.shape, x.dtype), ((2, 3), numpy.float64))
        where = x.__array_interface__["data"][0]
        before = x.copy()
        sim.step(20)
        self.assertEqual(sim.steps, 20)
        numpy.testing.assert_allclose(x - before, v * sim.time, rtol=1e-9, atol=1e-12)
        self.assertEqual(sim.positions.__array_interface__["data"][0], where)
        self.assertEqual(sim.probes["left_x"], x[0, 0])
        with self.assertRaises(ValueError):
            x[0, 0] = 1.0

    def test_outlive_the_name_of_the_simulation(self):
        sim = br.Simulation(balls(), threads=1)
        x = sim.positions
        del sim
        gc.collect()
        numpy.testing.assert_array_equal(x[:, 0], [-0.011, 0.011])

    def test_of_a_slab_agree_with_its_counts(self):
        sim = br.Simulation(ROOT / "cases/rc_slab/small.toml", threads=1)
        count = int(sim.facts["model.elements"])
        self.assertEqual(sim.fields["mass"].shape, (count,))
        self.assertEqual(sim.damage.shape, (count,))
        self.assertEqual(sim.fields.units["links.concrete.shear"], "N")
        for name in sim.fields:
            self.assertGreater(sim.fields[name].size, 0, name)
        kinetic = 0.5 * (sim.fields["mass"] * (sim.velocities**2).sum(axis=1)).sum()
        self.assertAlmostEqual(kinetic / sim.energies["kinetic"], 1.0, places=12)
        a, b = sim.fields["links.concrete.a"], sim.fields["links.concrete.b"]
        ids = sim.fields["id"]
        self.assertTrue((ids[a] < ids[b]).all())

    def test_in_the_plane_have_corners(self):
        sim = br.Simulation(ROOT / "cases/moving_box/small.toml", threads=1)
        triangles = int(sim.facts["model.triangles"])
        self.assertEqual(sim.positions.shape, (triangles, 3, 2))
        self.assertEqual(sim.fields["stress"].shape, (triangles, 3))
        sides = sim.positions - numpy.roll(sim.positions, 1, axis=1)
        doubled = sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0]
        self.assertTrue((doubled > 0).all())
        sim.step(10)
        self.assertLessEqual(abs(sim.velocities).max(), 100.0)


class Runs(unittest.TestCase):
    def test_stop_ends_a_run_where_it_says(self):
        sim = br.Simulation(balls(), threads=1)
        self.assertFalse(sim.run(stop=lambda s: s.probes["left_x"] > -0.0105, every=1))
        self.assertGreater(sim.positions[0, 0], -0.0105)
        self.assertLess(sim.positions[0, 0], -0.0105 + 2.0 * 2 * sim.time_step)
        self.assertTrue(sim.run())
        self.assertGreaterEqual(sim.time, 2e-3)

    def test_exceptions_of_a_callback_come_through(self):
        sim = br.Simulation(balls(), threads=1)

        def stop(_):
            raise KeyError("mine")

        with self.assertRaisesRegex(KeyError, "mine"):
            sim.run(stop=stop, every=5)
        self.assertEqual(sim.steps, 5)

    def test_errors_have_the_texts_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "wrong.toml"
            path.write_text('method = "dem3d"\n[time]\nend = -1.0\nsafty = 0.5\n')
            said = subprocess.run([PROGRAM, "check", path], capture_output=True, text=True)
            with self.assertRaises(br.InputError) as raised:
                br.Case(path)
        self.assertEqual(said.stderr, f"error: {raised.exception}\n")
        self.assertIsInstance(raised.exception, ValueError)
        self.assertIsInstance(raised.exception, br.Error)
        with self.assertRaisesRegex(br.InputError, "cpu, cuda"):
            br.Simulation(balls(), device="tpu")
        with self.assertRaisesRegex(br.InputError, 'velocity'):
            br.Simulation(balls(), threads=1).fields["velocty"]

    def test_set_overrides_keys(self):
        self.assertEqual(balls(**{"time.end": "3 ms"}).end_time, 3e-3)
        case = br.Case(balls().text)
        self.assertEqual(case.digest, balls().digest)


class Results(unittest.TestCase):
    @in_folder
    def test_load_gives_columns_with_units(self, folder):
        run = br.run(balls(), folder / "out")
        self.assertEqual(run.summary["status"], "done")
        self.assertEqual(run.history.units["left_x"], "m")
        self.assertEqual(run.history["time"][0], 0.0)
        self.assertEqual(len(run.frames), 3)
        self.assertEqual(run.frames[-1]["position"].shape, (2, 3))
        self.assertEqual(run.frames[0]["points.velocity"].dtype, numpy.float32)
        with self.assertRaises(IndexError):
            run.frames[3]
        try:
            import pandas  # noqa: F401
        except ImportError:
            return
        self.assertEqual(run.history.frame.attrs["units"]["kinetic"], "J")

    def test_a_folder_without_a_run_is_named(self):
        with self.assertRaisesRegex(br.FileError, "/nowhere/summary.json"):
            br.load("/nowhere")


class Examples(unittest.TestCase):
    @in_folder
    def test_all_run(self, folder):
        here = os.getcwd()
        os.chdir(folder)
        try:
            for script in sorted((ROOT / "python/examples").glob("*.py")):
                with self.subTest(script.name):
                    runpy.run_path(str(script), run_name="__main__")
        finally:
            os.chdir(here)


if __name__ == "__main__":
    unittest.main()
