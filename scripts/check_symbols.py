#!/usr/bin/env python3
"""Checks the tables of symbols in docs/theory*.md: each name in code stands in the file that its row names. Exit code 1 if not."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]


def main():
    rows, problems = 0, []
    for page in sorted((ROOT / "docs").glob("theory*.md")):
        before = rows
        inside = False
        for line in page.read_text().split("\n"):
            inside = line.startswith("| symbol |") or inside and line.startswith("|")
            if not inside or line.startswith(("| symbol |", "|---")):
                continue
            symbol, _, _, names, files = [cell.strip() for cell in line.strip("|").split("|")]
            rows += 1
            text = ""
            for file in files.split(","):
                path = ROOT / "src" / file.strip()
                if path.is_file():
                    text += path.read_text()
                else:
                    problems.append(f"{page.name}: {symbol}: no file src/{file.strip()}")
            for name in re.findall(r"`([^`]*)`", names):
                for word in re.findall(r"\w+", name):
                    if not re.search(rf"\b{word}\b", text):
                        problems.append(f"{page.name}: {symbol}: no {word} in {files}")
        if rows == before:
            problems.append(f"{page.name}: no table of symbols")
    print(f"{rows} symbols, {len(problems)} wrong")
    print("\n".join(problems))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
