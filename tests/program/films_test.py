"""Films, sheets and panels of a run, as `breccia render` makes them."""

import json
import os
import pathlib
import shutil
import struct
import subprocess
import tempfile
import unittest

from two_balls import case_with

PROGRAM = os.environ["BRECCIA"]
CASE = case_with('output = { frames = 4, pictures = false }')


def size_of(png):
    return struct.unpack(">II", pathlib.Path(png).read_bytes()[16:24])


class Render(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.path = pathlib.Path(cls.scratch.name)
        (cls.path / "balls.toml").write_text(CASE)
        for name, more in (("out", []), ("slow", ["--set", "body.0.velocity=[1.0, 0.0, 0.0]"])):
            words = [PROGRAM, "run", cls.path / "balls.toml", "-o", cls.path / name, "-q", *more]
            subprocess.run([*words, "--threads", "1"], check=True)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def render(self, name, *words, code=0, **environment):
        small = ["--width", "201", "--height", "150", "--color", "velocity"]
        words = [PROGRAM, "render", self.path / "out", "-o", self.path / name, *small, *words]
        done = subprocess.run(words, capture_output=True, text=True, env=os.environ | environment)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stdout + done.stderr

    def test_sheet_shows_frames_from_start_to_end(self):
        self.assertIn("5 of 5 frames", self.render("sheet.png", "--sheet", "3x2"))
        self.assertEqual(size_of(self.path / "sheet.png"), (603, 300))
        self.assertIn("is no sheet", self.render("sheet.png", "--sheet", "3", code=2))

    def test_panels_stand_beside_each_other(self):
        self.render("panels.png", "--panels", str(self.path / "slow"))
        self.assertEqual(size_of(self.path / "panels.png"), (402, 150))
        said = self.render("panels.png", "--panels", str(self.path / "slow"), "--frame", "9", code=2)
        self.assertIn("9", said)
        words = [PROGRAM, "render", "--width", "201", "--height", "150", "--color", "velocity"]
        runs = ["--panels", self.path / "out", self.path / "slow"]
        subprocess.run([*words, *runs, "-o", self.path / "both.png"], check=True)
        both, panels = (self.path / name for name in ("both.png", "panels.png"))
        self.assertEqual(both.read_bytes(), panels.read_bytes())
        said = subprocess.run(words, capture_output=True, text=True)
        self.assertEqual((said.returncode, "DIR is required" in said.stderr), (2, True))

    def test_without_ffmpeg_says_what_to_install(self):
        said = self.render("none.mp4", code=3, PATH="/nowhere")
        self.assertIn("apt install ffmpeg", said)
        self.assertFalse((self.path / "none.mp4").exists())

    def test_an_ffmpeg_that_fails_leaves_no_film(self):
        folder = self.path / "broken"
        folder.mkdir()
        (folder / "ffmpeg").write_text("#!/bin/sh\nexit 1\n")
        (folder / "ffmpeg").chmod(0o755)
        self.assertIn("ffmpeg ended early", self.render("failed.mp4", code=3, PATH=str(folder)))
        self.assertEqual([p for p in self.path.iterdir() if "failed.mp4" in p.name], [])

    @unittest.skipUnless(shutil.which("ffprobe"), "needs Debian's ffmpeg")
    def test_films_have_all_frames(self):
        for name, codec in (("film.mp4", "h264"), ("film.webm", "vp9"), ("film.gif", "gif")):
            said = self.render(name, "--fps", "5", "--panels", str(self.path / "slow"))
            self.assertIn("5 frames, 1.0 s", said)
            probe = ["ffprobe", "-v", "error", "-count_frames", "-of", "csv=p=0", "-show_entries"]
            entries = "stream=codec_name,width,height,nb_read_frames"
            found = subprocess.check_output([*probe, entries, self.path / name], text=True)
            self.assertEqual(found.strip(), f"{codec},402,150,5")

    @unittest.skipUnless(shutil.which("ffprobe"), "needs Debian's ffmpeg")
    def test_films_name_their_run(self):
        summary = json.loads((self.path / "out/summary.json").read_text())
        version, last = summary["breccia"]["version"], summary["state_hash"]
        line = f"breccia {version}, case balls, seed 1, state hash {last} at step {summary['steps']}"
        for name in ("film.mp4", "film.webm", "film.gif"):
            self.render(name)
            probe = ["ffprobe", "-v", "error", "-of", "default=nk=1:nw=1", "-show_entries"]
            probe += ["format_tags:stream_tags=comment", self.path / name]
            found = subprocess.check_output(probe, text=True)
            if name.endswith(".gif"):  # ffprobe reads no comment of a GIF
                found = self.comment_of_gif((self.path / name).read_bytes())
            self.assertIn(line, found, name)

    def comment_of_gif(self, gif):
        """The first extension of the file, as GIF89a has it."""
        self.assertEqual(gif[:6], b"GIF89a")
        place = 13 + (3 << ((gif[10] & 7) + 1) if gif[10] & 0x80 else 0)
        self.assertEqual(gif[place : place + 2], b"\x21\xfe")
        place, text = place + 2, b""
        while gif[place]:
            text += gif[place + 1 : place + 1 + gif[place]]
            place += 1 + gif[place]
        return text.decode()


if __name__ == "__main__":
    unittest.main()
