#!/usr/bin/env python3
"""Writes the tables of the validation pages from docs/results: result_tables.py [--check].

Between <!-- results: NAME ARGUMENT --> and <!-- end of results --> a page holds what this script makes of docs/results/NAME.csv. With --check
nothing is written, and the exit code is 1 if a page is not what its results give. How the files were made: docs/results/README.md.
"""
import argparse
import csv
import difflib
import pathlib
import re
import sys

import rock_tables

ROOT = pathlib.Path(__file__).resolve().parent.parent
RESULTS = ROOT / "docs/results"
PLACE = re.compile(r"(<!-- results: (\w+) (.+?) -->\n)(.*?)(<!-- end of results -->)", re.DOTALL)


def rock(campaign):
    with open(RESULTS / "rock.csv", newline="") as file:
        return rock_tables.markdown(rock_tables.read_records(file), campaign)


def spread(row, factor):
    """Mean and deviation; one packing alone is told by (n = 1)."""
    digits = int(row["digits"])
    mean = f"{float(row['mean']) * factor:.{digits}f}"
    if row["n"] == "1":
        return f"{mean} (n = 1)"
    return mean if row["deviation"] == "" else f"{mean} +- {float(row['deviation']) * factor:.{digits}f}"


MAKERS = {"rock": rock}


def remade(text, page):
    def table(match):
        if match[2] not in MAKERS:
            raise SystemExit(f"{page}: no results {match[2]}; there are {', '.join(MAKERS)}")
        made = MAKERS[match[2]](match[3])
        if not made:
            raise SystemExit(f"{page}: docs/results/{match[2]}.csv has no {match[3]}")
        return f"{match[1]}\n{made}\n\n{match[5]}"
    return PLACE.sub(table, text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    tables, stale = 0, []
    for page in sorted((ROOT / "docs").glob("*.md")):
        text = page.read_text()
        made = remade(text, page.name)
        tables += len(PLACE.findall(text))
        if made == text:
            continue
        stale.append(page.name)
        if options.check:
            sys.stdout.writelines(difflib.unified_diff(text.splitlines(True), made.splitlines(True), page.name, "of docs/results", n=0))
        else:
            page.write_text(made)
            print(f"{page.name} written anew")
    print(f"{tables} tables of pages are made from docs/results" + (f"; stale: {', '.join(stale)}" if options.check and stale else ""))
    return 1 if not tables or (options.check and stale) else 0


if __name__ == "__main__":
    sys.exit(main())
