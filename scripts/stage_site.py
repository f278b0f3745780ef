#!/usr/bin/env python3
"""Copies the pages of the repository, and what they link to, into FOLDER, each to its own path.

stage_site.py FOLDER. A link to a folder becomes one to its README.md, as sites of repositories show it. Exit code 1 if a page links
to what the repository does not hold, or if the list of pages in mkdocs.yml lacks one of docs; pages that are generated (docs/reference, docs/gallery) are looked for later, by check_links.py.
"""
import pathlib
import re
import shutil
import subprocess
import sys

from typeset import typeset

LINK = re.compile(r"(!?\[[^\]]*\]\()([^)\s]+)(\))")


def staged(page, tracked, folders, wanted, missing):
    """The text of a page with links to folders completed; names in `wanted` the files it links to."""
    def completed(match):
        target, _, anchor = match[2].partition("#")
        if not target or "://" in target or target.startswith("mailto:"):
            return match[0]
        path = (page.parent / target).as_posix()
        parts = []
        for part in path.split("/"):
            if part == "..":
                if not parts:
                    break
                parts.pop()
            elif part not in (".", ""):
                parts.append(part)
        path = "/".join(parts)
        if path in tracked:
            wanted.add(path)
        elif path in folders and f"{path}/README.md" in tracked:
            return f"{match[1]}{target.rstrip('/')}/README.md{'#' + anchor if anchor else ''}{match[3]}"
        elif not path.startswith(("docs/reference/", "docs/gallery/")):
            missing.append(f"{page}: {match[2]}")
        return match[0]

    lines, fenced = [], False
    for line in page.read_text().split("\n"):
        fenced ^= line.startswith("```")
        lines.append(line if fenced else LINK.sub(completed, line))
    text = "\n".join(lines)
    return typeset(text) if page.name.startswith("theory") else text


def main(folder):
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], check=True, capture_output=True, text=True).stdout.split("\n")
    tracked = {name for name in listed if name and pathlib.Path(name).exists()}
    folders = {parent.as_posix() for name in tracked for parent in pathlib.Path(name).parents}
    wanted, missing = set(), []
    for name in sorted(tracked):
        if name.endswith(".md"):
            target = folder / name
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(staged(pathlib.Path(name), tracked, folders, wanted, missing))
    for name in wanted:
        if not name.endswith(".md"):
            target = folder / name
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(name, target)
    for line in missing:
        print("no such file in the repository:", line, file=sys.stderr)
    listed = pathlib.Path("mkdocs.yml").read_text()
    lost = [name for name in sorted(tracked) if re.fullmatch(r"docs/(tutorials/)?[\w-]+\.md", name) and f": {name}\n" not in listed]
    for name in lost:
        print("not in the list of pages (nav of mkdocs.yml):", name, file=sys.stderr)
    return 1 if missing or lost else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
