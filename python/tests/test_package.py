"""The package against the program: same bits, same texts, no copies."""

import gc
import importlib.util
import os
import pathlib
import runpy
import subprocess
import tempfile
import unittest
import weakref

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
    def test_bar_of_tetrahedra_has_the_hash_of_the_program(self, folder):
        self.compare("spall_bar_3d", 3e-6, folder)

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


    def test_of_tetrahedra_have_four_corners_in_space(self):
        sim = br.Simulation(ROOT / "cases/spall_bar_3d/small.toml", threads=1)
        count = int(sim.facts["model.tetrahedra"])
        self.assertEqual(sim.positions.shape, (count, 4, 3))
        self.assertEqual(sim.fields["stress"].shape, (count, 6))
        sides = sim.positions[:, 1:] - sim.positions[:, :1]
        self.assertAlmostEqual(numpy.linalg.det(sides).sum() / 6.0, 0.01 * 0.01 * 0.25, places=9)


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


class Stages(unittest.TestCase):
    @in_folder
    def test_are_gone_through_as_the_program_does(self, folder):
        text = balls(**{"time.max_step": 2e-6}).text + """
[[stage]]
name = "fly"
until = 3e-4
[[stage]]
name = "fall"
gravity = [0.0, 0.0, -1e3]
when = "left_x > -0.0102"
[[stage]]
name = "rub"
local_damping = 0.3
until = 2e-4
"""
        (folder / "staged.toml").write_text(text)
        run = SameBits().by_program(folder / "staged.toml", folder / "out")
        sim = br.Simulation(folder / "staged.toml", threads=1)
        self.assertEqual(run.history["stage"][0], "fly")
        self.assertEqual([s["name"] for s in sim.stages], ["fly"])
        self.assertIsNone(sim.stages[0]["end"])
        sim.step(7)
        self.assertTrue(sim.run(until=1.0))
        self.assertEqual((sim.hash, sim.steps), (run.hash, run.summary["steps"]))
        self.assertEqual([s["ended_by"] for s in sim.stages], ["time", "probe", "time"])
        self.assertLess(sim.time, 2e-3)
        sim.step(5)
        self.assertEqual(sim.steps, run.summary["steps"])


class OwnForces(unittest.TestCase):
    """Forces from Python against closed answers and against the same forces of a case."""

    def test_a_spring_has_the_frequency_of_the_leapfrog(self):
        dt = 2e-6
        sim = br.Simulation(balls(**{"time.max_step": dt}), threads=1)
        mass, stiffness, rest = sim.fields["mass"][0], 4e6, -0.011
        spring = sim.add_force(
            lambda sim: [-stiffness * (sim.positions[0, 0] - rest), 0.0, 0.0], on=[0]
        )
        places = []
        sim.on_step(lambda sim: places.append(sim.positions[0, 0] - rest))
        sim.step(400)
        self.assertAlmostEqual(sim.time_step / (sim.time / 400), 1.0, places=12)
        # x_n = A sin(n theta) with sin(theta / 2) = dt / 2 sqrt(k / m) is the scheme's own motion.
        half = 0.5 * sim.time_step * numpy.sqrt(stiffness / mass)
        theta = 2.0 * numpy.arcsin(half)
        moved = places[0] * numpy.sin(theta * numpy.arange(1, 401)) / numpy.sin(theta)
        numpy.testing.assert_allclose(places, moved, rtol=0, atol=1e-12 * abs(moved).max() * 400)
        potential = 0.5 * stiffness * places[-1] ** 2
        most = 0.5 * stiffness * max(abs(x) for x in places) ** 2
        self.assertAlmostEqual(-spring.work / most, potential / most, places=12)
        self.assertLess(sim.energies["error_relative"], 1e-13)

    def test_weights_do_what_gravity_does(self):
        gravity = [0.0, 3e3, -1e4]
        fall = br.Simulation(balls(gravity=gravity), threads=1)
        sim = br.Simulation(balls(), threads=1)
        mass = sim.fields["mass"]
        force = sim.add_force(mass[:, None] * numpy.array(gravity))
        for _ in range(5):
            fall.step(60)
            sim.step(60)
            numpy.testing.assert_allclose(sim.positions, fall.positions, rtol=0, atol=1e-13)
            work = fall.energies["work"]
            self.assertAlmostEqual(sim.energies["work"] / work, 1.0, places=9)
            self.assertAlmostEqual(force.work / work, 1.0, places=9)
            error = fall.energies["error_relative"]  # of the collision
            self.assertAlmostEqual(sim.energies["error_relative"], error, places=9)
        force.off()
        sim.step(1)
        speed = sim.velocities[:, 1].copy()
        sim.step(10)
        numpy.testing.assert_array_equal(sim.velocities[:, 1], speed)

    def test_the_ledger_closes_with_damping_supports_and_breaking_links(self):
        sim = br.Simulation(
            br.Case(ROOT / "cases/rc_slab/small.toml", set={"local_damping": 0.1}), threads=2
        )
        slab = sim.fields["group"] == 0
        push = sim.add_force(lambda sim: [300.0 * numpy.sin(4e4 * sim.time), 0.0, -200.0], on=slab)
        self.assertEqual(len(push.on), slab.sum())
        sim.run(until=1.5e-4)
        energies = sim.energies
        self.assertGreater(energies["fracture"], 0.0)
        self.assertGreater(push.work, 0.2 * energies["elastic"])
        self.assertLess(energies["error_relative"], 1e-3)

    def test_in_the_plane_a_box_gains_what_the_force_gives(self):
        path = ROOT / "cases/moving_box/small.toml"
        sim, free = (br.Simulation(path, threads=1) for _ in range(2))
        mass = sim.fields["mass"]  # of a corner
        pull = 2e4
        force = sim.add_force(lambda sim: 3.0 * mass[:, None] * numpy.array([0.0, pull]))
        sim.step(50)
        free.step(50)
        flies = abs(free.velocities).min(axis=(1, 2)) > 0.0
        self.assertGreater(flies.sum(), 1000)
        gained = (sim.velocities - free.velocities)[flies]
        numpy.testing.assert_allclose(gained[..., 0], 0.0, atol=1e-9)
        # Velocities are half a step behind: the first kick is half a step long.
        spent = sim.time - 0.5 * sim.time_step
        numpy.testing.assert_allclose(gained[..., 1], pull * spent, rtol=1e-9)
        way = (sim.positions - br.Simulation(path, threads=1).positions)[..., 1]
        work = (mass[:, None] * pull * way)[flies].sum()  # what is held takes none
        self.assertAlmostEqual(force.work / work, 1.0, places=9)
        # All that the ledger misses is the first kick, half a step long, of a force that is there at
        # once: m (a dt)^2 / 8.
        names = ("kinetic", "elastic", "fracture", "friction", "damping", "contact")
        energies = sim.energies
        missing = energies["start"] + energies["work"] - sum(energies[name] for name in names)
        first = 3.0 * mass[flies].sum() * (pull * sim.time_step) ** 2 / 8.0
        self.assertAlmostEqual(abs(missing) / first, 1.0, places=5)

    def test_in_space_a_bar_gains_what_the_force_gives(self):
        path = ROOT / "cases/spall_bar_3d/small.toml"
        sim, free = (br.Simulation(path, threads=1) for _ in range(2))
        mass = sim.fields["mass"]  # of a corner
        pull = 2e4
        force = sim.add_force(lambda sim: 4.0 * mass[:, None] * numpy.array([pull, 0.0, 0.0]))
        sim.step(40)
        free.step(40)
        gained = sim.velocities - free.velocities
        spent = sim.time - 0.5 * sim.time_step
        numpy.testing.assert_allclose(gained[..., 0], pull * spent, rtol=1e-8)
        numpy.testing.assert_allclose(gained[..., 1:], 0.0, atol=1e-9)
        way = (sim.positions - br.Simulation(path, threads=1).positions)[..., 0]
        self.assertAlmostEqual(force.work / (mass[:, None] * pull * way).sum(), 1.0, places=8)

    def test_wrong_forces_are_named(self):
        sim = br.Simulation(balls(), threads=1)
        with self.assertRaisesRegex(br.InputError, "item 7, there are 0 to 1"):
            sim.add_force([1.0, 0.0, 0.0], on=[7])
        with self.assertRaisesRegex(br.InputError, "not finite on item 1"):
            sim.add_force([[0.0, 0.0, 0.0], [numpy.nan, 0.0, 0.0]])
        with self.assertRaises(ValueError):
            sim.add_force(numpy.zeros((3, 3)))
        with self.assertRaisesRegex(br.InputError, "cannot take steps"):
            sim.add_force(lambda sim: sim.step())
        sim.step(3)
        self.assertEqual(sim.steps, 3)

        def fails_at_five(sim):
            if sim.steps == 5:
                raise KeyError("mine")
            return [1.0, 0.0, 0.0]

        force = sim.add_force(fails_at_five)
        with self.assertRaisesRegex(KeyError, "mine"):
            sim.step(10)
        self.assertEqual(sim.steps, 5)
        sim.step(5)
        self.assertLess(sim.energies["error_relative"], 1e-13)
        self.assertNotEqual(force.work, 0.0)

    def test_simulations_with_forces_go(self):
        sim = br.Simulation(balls(), threads=1)
        sim.add_force([1.0, 0.0, 0.0])
        gone = weakref.ref(sim)
        del sim
        gc.collect()
        self.assertIsNone(gone())


class Callbacks(unittest.TestCase):
    def test_are_called_every_so_many_steps(self):
        sim = br.Simulation(balls(), threads=1)
        sim.step(3)
        every_five, every_two = [], []
        sim.on_step(lambda sim: every_five.append(sim.steps), every=5)
        sim.on_step(lambda sim: every_two.append(sim.steps), every=2)
        sim.step(4)
        sim.step(7)
        self.assertEqual(every_five, [8, 13])
        self.assertEqual(every_two, [5, 7, 9, 11, 13])
        self.assertEqual(sim.steps, 14)
        self.assertFalse(sim.run(stop=lambda sim: sim.steps >= 20, every=3))
        self.assertEqual(sim.steps, 20)
        self.assertEqual(every_five[-1], 18)
        plain = br.Simulation(balls(), threads=1)
        plain.step(20)
        self.assertEqual(sim.hash, plain.hash)


class Tensors(unittest.TestCase):
    def test_are_the_state_itself(self):
        sim = br.Simulation(balls(), threads=1)
        tensor = sim.fields.tensor("velocity")
        self.assertEqual(tensor.__dlpack_device__(), (1, 0))
        v = numpy.from_dlpack(tensor)
        self.assertEqual((v.shape, v.dtype), ((2, 3), numpy.float64))
        self.assertEqual(v.strides, sim.velocities.strides)
        self.assertEqual(
            v.__array_interface__["data"][0], sim.velocities.__array_interface__["data"][0]
        )
        sim.add_force([100.0, 0.0, 0.0])
        sim.step(10)
        numpy.testing.assert_array_equal(v, sim.velocities)
        gone = weakref.ref(sim)
        del sim, tensor
        gc.collect()
        self.assertIsNotNone(gone())
        self.assertGreater(v[0, 0], 2.0)
        del v
        gc.collect()
        self.assertIsNone(gone())

    def test_have_every_type_and_go_if_nobody_takes_them(self):
        sim = br.Simulation(ROOT / "cases/moving_box/small.toml", threads=1)
        for name in sim.fields:
            array = sim.fields[name]
            numpy.testing.assert_array_equal(numpy.from_dlpack(sim.fields.tensor(name)), array, name)
        sim.fields.tensor("damage").__dlpack__()
        with self.assertRaisesRegex(br.InputError, "velocity"):
            sim.fields.tensor("velocty")


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
        self.assertEqual(run.frames.units["points.velocity"], "m/s")
        self.assertEqual(set(run.frames.units), set(run.frames[0]))
        with self.assertRaises(IndexError):
            run.frames[3]

    @unittest.skipUnless(importlib.util.find_spec("pandas"), "needs python3-pandas")
    @in_folder
    def test_pandas_has_columns_and_units(self, folder):
        run = br.run(balls(), folder / "out")
        frame = run.history.frame
        self.assertEqual(frame.attrs["units"]["kinetic"], "J")
        self.assertEqual(list(frame.columns), list(run.history))
        numpy.testing.assert_array_equal(frame["left_x"].to_numpy(), run.history["left_x"])

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

    def test_samples_of_the_document_run(self):
        samples = (ROOT / "docs/python.md").read_text().split("```python\n")[1:]
        self.assertGreater(len(samples), 1)
        here = os.getcwd()
        os.chdir(ROOT)
        try:
            for sample in samples:
                exec(compile(sample.split("```")[0], "docs/python.md", "exec"), {})
        finally:
            os.chdir(here)


if __name__ == "__main__":
    unittest.main()
