"""What is left of runs whose checks fail, and of results that have lost rows."""

import os
import pathlib
import subprocess
import tempfile
import unittest

from two_balls import case_with

PROGRAM = os.environ["BRECCIA"]


class Endings(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.path = pathlib.Path(self.scratch.name)

    def breccia(self, *words):
        return subprocess.run([PROGRAM, *words], cwd=self.path, capture_output=True, text=True, timeout=120)

    def write(self, tables="", keys="output = { frames = 2, pictures = false, report = true }"):
        probe = '\n[[probe]]\nname = "way"\non = "right"\nquantity = "position_x"\nreduce = "max"\n'
        (self.path / "case.toml").write_text(case_with(keys) + probe + tables)

    def test_a_failed_check_leaves_the_report(self):
        self.write('[[check]]\nname = "goes"\nvalue = "probe.way.last"\nexpected = 1.0\ntolerance = 0.1\n')
        done = self.breccia("run", "case.toml", "-o", "out", "--threads", "1", "--no-progress")
        self.assertEqual(done.returncode, 9, done.stderr)
        self.assertRegex(done.stdout, "(?m)^failed ")
        self.assertRegex(done.stdout, "(?m)^shows ")
        self.assertRegex(done.stdout, "(?m)^report ")
        self.assertTrue((self.path / "out/report.html").exists())

    def test_lost_rows_are_told_by_resume(self):
        self.write(keys="checkpoint = { steps = 5 }")
        begun = self.breccia("run", "case.toml", "-o", "out", "--threads", "1", "--until", "1 ms", "-q")
        self.assertEqual(begun.returncode, 0, begun.stderr)
        history = self.path / "out/history.csv"
        rows = history.read_text().splitlines(keepends=True)
        whole = self.breccia("resume", "out", "--threads", "1", "--until", "1.2 ms")
        self.assertNotIn("has lost its rows", whole.stdout + whole.stderr)
        rows = history.read_text().splitlines(keepends=True)
        history.write_text("".join(rows[: len(rows) // 2]))
        cut = self.breccia("resume", "out", "--threads", "1", "--until", "1.4 ms")
        self.assertEqual(cut.returncode, 0, cut.stderr)
        self.assertIn("history.csv has lost its rows from step", cut.stdout + cut.stderr)
        history.unlink()
        lost = self.breccia("resume", "out", "--threads", "1")
        self.assertIn("history.csv has lost its rows from step 0", lost.stdout + lost.stderr)


if __name__ == "__main__":
    unittest.main()
