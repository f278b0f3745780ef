"""Cameras in files: keys in time, turntables, cuts that move."""

import math
import os
import pathlib
import struct
import subprocess
import tempfile
import unittest
import zlib

from two_balls import case_with

PROGRAM = os.environ["BRECCIA"]
KEY = """
[[key]]
time = {time}
eye = [{eye[0]!r}, {eye[1]!r}, {eye[2]!r}]
target = [0.02, 0.0, 0.0]
angle = {angle}
clip = "{clip}"
"""


def pixels_of(png):
    """Rows of an 8-bit RGB picture whose lines have any of the five filters."""
    data, place, packed = pathlib.Path(png).read_bytes(), 8, b""
    while place < len(data):
        size, kind = struct.unpack(">I4s", data[place : place + 8])
        body = data[place + 8 : place + 8 + size]
        if kind == b"IHDR":
            width, height = struct.unpack(">II", body[:8])
        packed += body if kind == b"IDAT" else b""
        place += 12 + size
    raw, stride, above, rows = zlib.decompress(packed), 3 * width, bytes(3 * width), []
    for y in range(height):
        filter_, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        for x in range(stride):
            a, b, c = (line[x - 3] if x > 2 else 0), above[x], (above[x - 3] if x > 2 else 0)
            nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            line[x] = (line[x] + (0, a, b, (a + b) // 2, nearest)[filter_]) & 255
        rows.append(bytes(line))
        above = line
    return rows


class Cameras(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.path = pathlib.Path(cls.scratch.name)
        (cls.path / "balls.toml").write_text(case_with("output = { frames = 4, pictures = false }"))
        words = [PROGRAM, "run", cls.path / "balls.toml", "-o", cls.path / "out", "-q", "--threads", "1"]
        subprocess.run(words, check=True)
        rows = (cls.path / "out/history.csv").read_text().split("\n")
        cls.end = float(rows[-2].split(",")[rows[0].split(",").index("time")])

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def render(self, name, camera, *words, code=0):
        (self.path / "camera.toml").write_text(camera)
        words = [PROGRAM, "render", self.path / "out", "-o", self.path / name, "--width", "160", "--height", "120",
                 "--color", "velocity", "--range", "0:2", "--camera", self.path / "camera.toml", *words]
        done = subprocess.run(words, capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stderr)
        return pixels_of(self.path / name) if code == 0 else done.stderr

    def key(self, azimuth, time=0.0, angle=0.5, clip="", height=0.1):
        eye = [0.02 + 0.2 * math.cos(azimuth), 0.2 * math.sin(azimuth), height]
        return KEY.format(time=time, eye=eye, angle=angle, clip=clip)

    def unlike(self, a, b):
        """Share of the bytes that differ by more than a rounding of an edge can."""
        pairs = [pair for rows in zip(a, b) for pair in zip(*rows)]
        return sum(abs(x - y) > 8 for x, y in pairs) / len(pairs)

    def test_a_quarter_turn_is_the_camera_a_quarter_on(self):
        turned = self.render("turned.png", self.key(0.3) + "[turntable]\nturns = 0.25\n", "--sheet", "2x1")
        there = self.render("there.png", self.key(0.3 + math.pi / 2))
        other = self.render("other.png", self.key(0.3 - math.pi / 2))
        right = [row[480:] for row in turned]
        self.assertLess(self.unlike(right, there), 0.002)
        self.assertGreater(self.unlike(right, other), 0.02)

    def test_between_two_keys_the_camera_goes_round_its_target(self):
        end = self.end
        keys = self.key(0.0, -end, height=0.0) + self.key(1.0, 3 * end, height=0.0)
        half = self.render("half.png", self.key(0.5, height=0.0), "--frame", "4")
        self.assertLess(self.unlike(self.render("way.png", keys, "--frame", "4"), half), 0.002)
        other = self.render("other.png", self.key(0.3, height=0.0), "--frame", "4")
        self.assertGreater(self.unlike(other, half), 0.004)

    def test_before_the_first_key_and_behind_the_last_it_stands(self):
        keys = self.key(0.0, 10.0) + self.key(1.0, 20.0)
        self.assertEqual(self.render("early.png", keys), self.render("first.png", self.key(0.0)))
        keys = self.key(0.0, -20.0) + self.key(1.0, -10.0)
        self.assertEqual(self.render("late.png", keys), self.render("last.png", self.key(1.0)))

    def test_a_cut_moves_between_keys(self):
        end = self.end
        keys = self.key(0.7, 0.0, clip="x<-0.1") + self.key(0.7, 2 * end, clip="x<0.14")
        half = self.render("cut.png", keys, "--frame", "4")
        self.assertEqual(half, self.render("at.png", self.key(0.7, clip="x<0.02"), "--frame", "4"))
        self.assertGreater(self.unlike(half, self.render("whole.png", self.key(0.7), "--frame", "4")), 0.0005)

    def test_what_is_wrong_is_told(self):
        for camera, words in (
            ("", "needs a [[key]] or a [turntable]"),
            ("[[key]]\neye = [0.0, 0.0, 0.0]\n", "where its target is"),
            ("[[key]]\neye = [0.0, 0.0, 1.0]\n", "along the line of sight"),
            ("[[key]]\neye = [1.0, 0.0, 0.0]\nangel = 0.5\n", "did you mean angle?"),
            ("[[key]]\neye = [1.0, 0.0, 0.0]\nangle = \"190 deg\"\n", "angle"),
            (self.key(0.0, 1.0) + self.key(0.0, 1.0), "is not later"),
            (self.key(0.0, clip="w=3"), "is not a plane"),
        ):
            self.assertIn(words, self.render("none.png", camera, code=2))


if __name__ == "__main__":
    unittest.main()
