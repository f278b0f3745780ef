"""`breccia watch` beside a run of another process."""

import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

PROGRAM = os.environ["BRECCIA"]
CASE = """
method = "dem3d"
energy = { warn = 0.0, stop = 0.0 }
time.end = "900 s"
output = { frames = 1, pictures = false, history = 1e-3 }
material.rock = { law = "grain", young = "1 GPa" }
[[body]]
name = "left"
shape = "element"
material = "rock"
radius = "10 mm"
velocity = [2.0, 0.0, 0.0]
[[probe]]
name = "a name that is long enough to need cutting"
on = "left"
quantity = "position_x"
"""


class Watch(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.path = pathlib.Path(self.scratch.name)
        (self.path / "ball.toml").write_text(CASE)

    def run_words(self, *more):
        words = [PROGRAM, "run", "ball.toml", "-o", "out", "-q", "--threads", "1"]
        return [*words, *more]

    def start(self):
        run = subprocess.Popen(self.run_words(), cwd=self.path)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        for _ in range(1000):
            history = self.path / "out/history.csv"
            if history.exists() and history.read_text().count("\n") > 5:
                return run
            time.sleep(0.01)
        self.fail("the run does not begin")

    def watch(self, *more, **environment):
        words = [PROGRAM, "watch", "out", "--every", "0.1", *more]
        return subprocess.Popen(
            words, cwd=self.path, stdout=subprocess.PIPE, text=True, env=os.environ | environment
        )

    def test_tells_of_a_finished_run_in_80_columns_without_escapes(self):
        subprocess.run(self.run_words("--until", "0.05"), cwd=self.path, check=True)
        for locale in ("C", "C.UTF-8"):
            watch = self.watch(LC_ALL=locale)
            said = watch.communicate(timeout=60)[0]
            self.assertEqual(watch.returncode, 0)
            self.assertRegex(said, "^out  .*ball  dem3d  done")
            self.assertIn("step ", said)
            self.assertNotIn("\x1b", said)
            self.assertLessEqual(max(len(line) for line in said.splitlines()), 80)
            self.assertEqual(said.isascii(), locale == "C")
        self.assertIn("▁", said)
        self.assertIn("█", said)

    def test_ends_with_the_run_and_its_exit_code(self):
        run = self.start()
        watch = self.watch()
        time.sleep(0.5)
        self.assertIsNone(watch.poll())
        run.send_signal(signal.SIGTERM)
        said = watch.communicate(timeout=60)[0]
        self.assertEqual(watch.returncode, 128 + signal.SIGTERM)
        self.assertIn("interrupted", said)
        self.assertIn("state saved", said)

    def test_a_run_that_was_killed_is_lost(self):
        run = self.start()
        run.kill()
        run.wait()
        watch = self.watch()
        self.assertIn("breccia resume out", watch.communicate(timeout=60)[0])
        self.assertEqual(watch.returncode, 8)

    def test_once_looks_once(self):
        self.start()
        watch = self.watch("--once")
        self.assertIn("running", watch.communicate(timeout=60)[0])
        self.assertEqual(watch.returncode, 0)

    def test_names_a_folder_without_a_run(self):
        watch = subprocess.run([PROGRAM, "watch", "/nowhere"], capture_output=True, text=True)
        self.assertEqual(watch.returncode, 3)
        self.assertIn("/nowhere/summary.json: no such file: there is no run, or it still", watch.stderr)


if __name__ == "__main__":
    unittest.main()
