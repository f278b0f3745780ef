"""The recipes for containers: that for Apptainer does what the Dockerfile does, from the packages that CPack leaves."""

import json
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DEBS = re.compile(r"(?:/tmp|/opt)/\*\.deb")


def commands(text):
    """The commands of a piece of shell, one an item, without where the packages lie."""
    text = text.replace("\\\n", " ")
    return [" ".join(DEBS.sub("DEBS", part).split()) for line in text.splitlines() for part in line.split("&&") if part.strip()]


def of_docker():
    text = (ROOT / "packaging/Dockerfile").read_text().replace("\\\n", " ")
    stages = re.split(r"^FROM .*$", text, flags=re.MULTILINE)[1:]
    return [[one for run in re.findall(r"^RUN (.*)$", stage, re.MULTILINE) for one in commands(run)] for stage in stages]


def of_apptainer():
    text = (ROOT / "packaging/breccia.def").read_text()
    posts = re.findall(r"^%post\n((?:^[ \t].*\n|^\n)*)", text, re.MULTILINE)
    return [[one for one in commands(post) if not one.startswith("cd ")] for post in posts]


class Recipes(unittest.TestCase):
    def test_both_run_the_same_commands(self):
        self.assertEqual(len(of_docker()), 2)
        self.assertEqual(of_apptainer(), of_docker())

    def test_they_take_the_packages_from_where_the_preset_leaves_them(self):
        presets = json.loads((ROOT / "CMakePresets.json").read_text())["packagePresets"]
        folder = next(one["packageDirectory"] for one in presets if one["name"] == "package")
        folder = folder.replace("${sourceDir}", "/breccia")
        for name in ("Dockerfile", "breccia.def"):
            self.assertIn(f"{folder}/*.deb", (ROOT / "packaging" / name).read_text(), name)

    def test_apptainer_takes_the_sources_and_no_build(self):
        text = (ROOT / "packaging/breccia.def").read_text()
        files = re.search(r"^%files\n((?:^[ \t].*\n)*)", text, re.MULTILINE)[1].split()
        self.assertEqual(set(files[1::2]), {"/breccia/"})
        taken = set(files[::2])
        for name in taken:
            self.assertTrue((ROOT / name).exists(), name)
        self.assertFalse(taken & {"build", "."})
        used = {"CMakePresets.json", "scripts"}
        for file in (ROOT / "CMakeLists.txt", ROOT / "packaging/CMakeLists.txt"):
            used |= set(re.findall(r"PROJECT_SOURCE_DIR\}/([\w.]+)", file.read_text())) | set(re.findall(r"add_subdirectory\((\w+)", file.read_text()))
        self.assertLessEqual(used, taken)

    def test_apptainer_starts_the_program(self):
        text = (ROOT / "packaging/breccia.def").read_text()
        self.assertRegex(text, r'%runscript\n\s+exec breccia "\$@"')
        self.assertIn('ENTRYPOINT ["breccia"]', (ROOT / "packaging/Dockerfile").read_text())


if __name__ == "__main__":
    unittest.main()
