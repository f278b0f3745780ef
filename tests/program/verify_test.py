"""Pictures that say of which run they are, and `breccia verify`, which makes them again."""

import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import tempfile
import unittest
import zlib

from two_balls import case_with

PROGRAM = os.environ["BRECCIA"]
ROOT = pathlib.Path(__file__).resolve().parents[2]
CASE = case_with(
    'title = "two balls"\n'
    'output = { frames = 4, color = "velocity", width = 201, height = 150, picture_steps = [3] }'
)


def chunks(png):
    place = 8
    while place < len(png):
        length, kind = struct.unpack(">I4s", png[place : place + 8])
        yield kind, png[place + 8 : place + 8 + length]
        place += 12 + length


def packed(parts):
    out = b"\x89PNG\r\n\x1a\n"
    for kind, data in parts:
        out += struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return out


def texts(png):
    found = {}
    for kind, data in chunks(png):
        if kind == b"iTXt":
            word, rest = data.split(b"\0", 1)
            found[word.decode()] = zlib.decompress(rest[4:]).decode()
    return found


def with_changed_pixel(png):
    pixels = zlib.decompress(b"".join(data for kind, data in chunks(png) if kind == b"IDAT"))
    pixels = pixels[:-1] + bytes([pixels[-1] ^ 1])
    parts = [part for part in chunks(png) if part[0] not in (b"IDAT", b"IEND")]
    return packed([*parts, (b"IDAT", zlib.compress(pixels)), (b"IEND", b"")])


class Verify(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.path = pathlib.Path(cls.scratch.name)
        (cls.path / "balls.toml").write_text(CASE)
        words = [PROGRAM, "run", cls.path / "balls.toml", "-o", cls.path / "out", "-q"]
        subprocess.run([*words, "--threads", "1"], check=True)

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def verify(self, picture, *words, code):
        done = subprocess.run(
            [PROGRAM, "verify", self.path / picture, *words], capture_output=True, text=True, cwd=self.path
        )
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def test_pictures_of_a_run_are_made_again(self):
        for name in ("0000", "0002", "0004", "step_3"):
            said = self.verify(f"out/pictures/{name}.png", "--threads", "2", code=0)
            self.assertIn("the same picture: balls", said)
            self.assertNotIn("names none", said)
        found = texts((self.path / "out/pictures/0004.png").read_bytes())
        self.assertEqual(found["Case file"], (self.path / "out/case.toml").read_text())

    def test_a_rendered_picture_is_made_again(self):
        words = ["--color", "", "--view", "y", "--hide", "left", "--frame", "2", "--width", "190", "--height", "140"]
        subprocess.run([PROGRAM, "render", "out", "-o", "drawn.png", *words], check=True, cwd=self.path, stdout=subprocess.DEVNULL)
        said = self.verify("drawn.png", code=0)
        self.assertIn("190 x 140", said)
        self.assertNotIn("names none", said)
        (self.path / "stand.toml").write_text("[[key]]\neye = [0.1, -0.2, 0.1]\ntarget = [0.0, 0.0, 0.0]\n")
        self.render("stood.png", "--camera", "stand.toml", "--frame", "2")
        self.assertIn("the same picture: balls, step", self.verify("stood.png", code=0))

    def render(self, name, *words):
        words = [PROGRAM, "render", "out", "-o", name, *words]
        subprocess.run(words, check=True, cwd=self.path, stdout=subprocess.DEVNULL)

    def test_a_changed_pixel_is_found(self):
        png = (self.path / "out/pictures/0002.png").read_bytes()
        (self.path / "changed.png").write_bytes(with_changed_pixel(png))
        self.assertIn("1 of 30150 pixels differ", self.verify("changed.png", code=9))

    def change_text(self, word, old, new, picture="out/pictures/0002.png"):
        parts = []
        for kind, data in chunks((self.path / picture).read_bytes()):
            if kind == b"iTXt" and data.startswith(word.encode() + b"\0"):
                text = zlib.decompress(data[len(word) + 5 :]).decode()
                self.assertIn(old, text)
                data = data[: len(word) + 5] + zlib.compress(text.replace(old, new).encode())
            parts.append((kind, data))
        (self.path / "changed.png").write_bytes(packed(parts))

    def test_another_case_is_found(self):
        self.change_text("Case file", "[2.0, ", "[2.5, ")
        self.assertIn("has hash", self.verify("changed.png", code=9))

    def test_another_version_is_refused(self):
        self.change_text("Software", "breccia ", "breccia 0.0.1-")
        self.assertIn("is by breccia 0.0.1-", self.verify("changed.png", code=2))

    def test_damaged_options_are_refused(self):
        self.change_text("Picture", '"width":201', '"width":"many"')
        self.assertIn("damaged", self.verify("changed.png", code=2))

    def test_a_picture_of_no_run_is_refused(self):
        parts = chunks((self.path / "out/pictures/0002.png").read_bytes())
        (self.path / "plain.png").write_bytes(packed([part for part in parts if part[0] != b"iTXt"]))
        self.assertIn("does not say of which run", self.verify("plain.png", code=2))

    def test_another_state_is_found(self):
        named = texts((self.path / "out/pictures/0002.png").read_bytes())["State hash"]
        self.change_text("State hash", named, f"{int(named, 16) ^ 1:016x}")
        self.assertIn("has hash", self.verify("changed.png", code=9))

    def test_sheets_and_panels_are_made_again(self):
        other = ["-o", "slow", "-q", "--threads", "1", "--set", "body.0.velocity=[1.0, 0.0, 0.0]"]
        subprocess.run([PROGRAM, "run", "balls.toml", *other], check=True, cwd=self.path)
        self.render("sheet.png", "--size", "120x90", "--sheet", "3x2", "--panels", "slow")
        said = self.verify("sheet.png", "--threads", "2", code=0)
        self.assertRegex(said, "the same picture: balls beside balls, step .*, hash .* and step .*, hash .*, all 720 x 180 pixels")
        runs = texts((self.path / "sheet.png").read_bytes())["Runs"].splitlines()
        for line, folder in zip(runs, ("out", "slow"), strict=True):
            self.assertIn(json.loads((self.path / folder / "summary.json").read_text())["state_hash"], line)
        (self.path / "changed.png").write_bytes(with_changed_pixel((self.path / "sheet.png").read_bytes()))
        self.assertIn("1 of 129600 pixels differ", self.verify("changed.png", code=9))
        self.change_text("Pictures", "[1.0,", "[1.5,", "sheet.png")
        self.assertIn("has hash", self.verify("changed.png", code=9))
        self.change_text("Pictures", '"columns":6', '"columns":999', "sheet.png")
        self.assertIn("it is drawn with 119880 x 90 pixels", self.verify("changed.png", code=9))
        self.change_text("Pictures", '"run":1', '"run":7', "sheet.png")
        self.assertIn("damaged", self.verify("changed.png", code=2))

    @unittest.skipUnless(shutil.which("ffmpeg"), "needs Debian's ffmpeg")
    def test_films_are_made_again(self):
        (self.path / "turn.toml").write_text("[turntable]\nturns = 0.25\n")
        for name, *words in (("film.mp4",), ("film.webm",), ("film.gif",), ("turn.mp4", "--camera", "turn.toml")):
            words = [PROGRAM, "render", "out", "-o", name, "--color", "velocity", "--size", "301x225", *words]
            subprocess.run(words, check=True, cwd=self.path, stdout=subprocess.DEVNULL)
            said = self.verify(name, "--threads", "1", code=0)
            self.assertIn("the same film: balls, 5 pictures", said)
            self.assertNotIn("names none", said)
        self.render("both.mp4", "--color", "velocity", "--size", "202x150", "--panels", "out")
        self.assertIn("the same film: balls beside balls, 5 pictures", self.verify("both.mp4", code=0))
        (self.path / "long.toml").write_text("[turntable]\npictures = 400\nturns = 1.7\n")
        self.render("long.mp4", "--size", "64x48", "--camera", "long.toml")
        self.assertIn("the same film: balls, 400 pictures", self.verify("long.mp4", code=0))

    @unittest.skipUnless(shutil.which("ffmpeg"), "needs Debian's ffmpeg")
    def test_films_that_show_or_say_something_else_are_found(self):
        subprocess.run([PROGRAM, "render", "out", "-o", "true.mp4", "--size", "201x150"], check=True, cwd=self.path, stdout=subprocess.DEVNULL)
        ffmpeg = ["ffmpeg", "-y", "-nostdin", "-loglevel", "error", "-i", "true.mp4"]
        subprocess.run([*ffmpeg, "-vf", "negate", "shown.mp4"], check=True, cwd=self.path)
        self.assertIn("the film shows another one", self.verify("shown.mp4", code=9))
        subprocess.run([*ffmpeg, "-frames:v", "2", "short.mp4"], check=True, cwd=self.path)
        self.assertIn("picture 3 of 5: the film ends before it", self.verify("short.mp4", code=9))
        head, digits = re.search(rb"(breccia[^\0]*?breccia-film:)\d+:([0-9a-f]+)", (self.path / "true.mp4").read_bytes()).groups()
        recipe = zlib.decompress(bytes.fromhex(digits.decode())).replace(b"[2.0, ", b"[2.5, ")
        comment = f"comment={head.decode()}{len(recipe)}:{zlib.compress(recipe).hex()}"
        subprocess.run([*ffmpeg, "-c", "copy", "-metadata", comment, "said.mp4"], check=True, cwd=self.path)
        self.assertIn("another film", self.verify("said.mp4", code=9))
        subprocess.run([*ffmpeg, "-c", "copy", "-map_metadata", "-1", "mute.mp4"], check=True, cwd=self.path)
        self.assertIn("does not say how", self.verify("mute.mp4", code=2))

    def of_other_case(self, name, *words, resumed=False):
        """Pictures of 200 steps of a run: of its last state, and of its last stored frame with the hash; its film."""
        few = ["--steps", "120" if resumed else "200"]
        few += ["--set", "output.picture_steps=[200]", "--set", "output.width=200", "--set", "output.height=150"]
        words = [PROGRAM, "run", *words, "-o", self.path / name, "-q", "--threads", "1", *few]
        subprocess.run(words, check=True)
        if resumed:
            subprocess.run([PROGRAM, "resume", self.path / name, "-q", "--threads", "2", "--steps", "200"], check=True)
        drawn = [PROGRAM, "render", self.path / name, "-o", self.path / f"{name}.png", "--width", "190"]
        subprocess.run(drawn, check=True, stdout=subprocess.DEVNULL)
        state = self.verify(f"{name}/pictures/step_200.png", "--threads", "2", code=0)
        self.assertRegex(state, "the same picture: .*, step 200, hash")
        drawn = self.verify(f"{name}.png", code=0)
        self.assertRegex(drawn, "the same picture: .*, step 200, hash")
        self.assertNotIn("names none", drawn)
        if shutil.which("ffmpeg"):
            film = [PROGRAM, "render", self.path / name, "-o", self.path / f"{name}.mp4", "--size", "190x150"]
            subprocess.run(film, check=True, stdout=subprocess.DEVNULL)
            self.assertRegex(self.verify(f"{name}.mp4", "--threads", "1", code=0), "the same film: .*, [2-9] pictures to step 200, hash")

    def test_a_run_that_was_resumed(self):
        words = [ROOT / "cases/rc_slab/small.toml", "--set", "output.frames=20"]
        self.of_other_case("resumed", *words, resumed=True)

    def test_drawings(self):
        few = ["--steps", "100", "--set", "output.pictures=false", "--threads", "1", "-q"]
        subprocess.run([PROGRAM, "run", ROOT / "cases/three_point_bending/small.toml", "-o", "out_plane", *few], check=True, cwd=self.path)
        for name in ("plane.svg", "plane.pdf"):
            words = [PROGRAM, "render", "out_plane", "-o", name, "--color", "stress_xx", "--title", "a (b) \\ <c>"]
            subprocess.run(words, check=True, cwd=self.path, stdout=subprocess.DEVNULL)
            content = (self.path / name).read_bytes()
            self.assertIn(b"case three_point_bending_small, seed 1, state hash ", content)
            self.assertIn("the same picture: three_point_bending_small, step 100, hash", self.verify(name, code=0))
            at = content.index(b"M", 1000) if name.endswith("svg") else content.index(b"stream\n") + 300
            (self.path / f"other_{name}").write_bytes(content[:at] + b"m" + content[at + 1 :])
            self.assertIn("other lines", self.verify(f"other_{name}", code=9))

    def test_joints_in_the_plane(self):
        self.of_other_case("beam", ROOT / "cases/three_point_bending/small.toml")

    def test_facets_of_particles(self):
        self.of_other_case("facets", ROOT / "cases/ldpm_cube/small.toml")

    def test_stages(self):
        stages = (
            '[[stage]]\nname = "fly"\nuntil = "0.2 ms"\n'
            '[[stage]]\nname = "fall"\ngravity = [0.0, 0.0, -1e5]\n'
        )
        case = case_with('time.max_step = "2 us"') + stages
        (self.path / "staged.toml").write_text(case)
        self.of_other_case("staged", self.path / "staged.toml")
        summary = json.loads((self.path / "staged/summary.json").read_text())
        self.assertEqual(len(summary["stage"]), 2, "the picture is of the second stage")


if __name__ == "__main__":
    unittest.main()
