#!/usr/bin/env python3
"""Writes the tables of the pages on validation and speed from docs/results: result_tables.py [--check].

Between <!-- results: NAME ARGUMENT --> and <!-- end of results --> a page holds what this script makes of docs/results/NAME.csv (of `speed`: of
bench/results as well; of `misfits`: of the other tables). With --check
nothing is written, and the exit code is 1 if a page is not what its results give. How the files were made: docs/results/README.md.
"""
import argparse
import csv
import difflib
import math
import pathlib
import re
import statistics
import sys

import beyond_peak
import concrete_tables
import damped_links
import impact_tables
import ldpm_tables
import library_tables
import localisation
import misfit_table
import published_tests
import reinforced_tests
import rock_experiments
import rock_library
import rock_tables
import slip_wear
import speed_tables

ROOT = pathlib.Path(__file__).resolve().parent.parent
RESULTS = ROOT / "docs/results"
PLACE = re.compile(r"(<!-- results: (\w+) (.+?) -->\n)(.*?)(<!-- end of results -->)", re.DOTALL)


def rock(campaign):
    with open(RESULTS / "rock.csv", newline="") as file:
        return rock_tables.markdown(rock_tables.read_records(file), campaign)


def concrete(name):
    """Slow tests beside published numbers; or strengths over sizes of elements: where single specimens are recorded, mean and deviation are made from them."""
    if name == "slow":
        return concrete_tables.slow(lines_of("concrete"))
    found = {}
    with open(RESULTS / "concrete.csv", newline="") as file:
        for row in csv.DictReader(file):
            numbers = found.setdefault((int(row["elements"]), row["test"], row["quantity"]), {})
            numbers[row["specimen"]] = row["value"]

    def spread(elements, test, quantity):
        """Mean, deviation (None where it is not recorded), number of specimens (None likewise); a text as it is."""
        of = found.get((elements, test, quantity), {})
        if not of or "text" in of:
            return of.get("text", ""), None, None
        if "mean" in of:
            return float(of["mean"]), float(of["deviation"]) if "deviation" in of else None, None
        values = [value for value in map(float, of.values()) if math.isfinite(value)]  # some do not get there
        if len(values) < len(of):
            return f"{statistics.mean(values):.3g} ({len(values)} of {len(of)})" if values else "not reached", None, None
        return statistics.mean(values), statistics.stdev(values) if len(values) > 1 else None, len(values)

    def cell(elements, digits, wanted, quantity, over=None):
        if over and (elements, *(ratio := (quantity[0], f"strength_over_{over[0]}"))) in found:
            quantity, over = ratio, None  # all that was kept of some, or before means were rounded
        mean, deviation, count = spread(elements, *quantity)
        if isinstance(mean, str):
            return mean
        if over and isinstance(below := spread(elements, *over)[0], float):
            mean, deviation = mean / below, None
        elif over:
            return ""
        text = f"{mean:.{digits}f}"
        bold = wanted and not wanted[0] <= float(text) <= wanted[1]
        more = "" if deviation is None else f" +- {deviation:.{digits}f}"
        return ("**" + text + "**" if bold else text) + more + (" (n = 1)" if count == 1 else "")

    def strength(test):
        return test, "strength"

    sizes = {600: "7.8 mm", 1200: "6.2 mm", 2400: "4.9 mm", 9600: "3.1 mm"}
    rows = [("compression, prism, smooth ends [MPa]", 1, None, strength("compression_prism")),
            ("left at 3 times the strain of the peak, of f_c", 2, None, ("compression_prism", "residual")),
            ("cube, smooth ends", 1, None, strength("compression_cube")),
            ("rough platens: prism", 1, None, strength("platens_prism")), ("cube", 1, None, strength("platens_cube")),
            ("cube over prism, both rough (1.15 to 1.30)", 2, (1.15, 1.30), strength("platens_cube"), strength("platens_prism")),
            ("direct tension", 2, None, strength("tension")),
            ("f_c / f_t (10 to 12)", 1, (10.0, 12.0), strength("compression_prism"), strength("tension")),
            ("Brazilian disc, over f_t (1.0 to 1.1)", 2, (1.0, 1.1), strength("brazilian"), strength("tension")),
            ("plain beam, over f_t (1.66)", 2, (1.58, 1.74), strength("bending_plain"), strength("tension")),
            ("notched beam: strength of the ligament [MPa]", 2, None, strength("bending")),
            *((f"triaxial at {p} MPa", 0 if p >= 50 else 1, None, strength(f"triaxial_{p}")) for p in (5, 20, 50, 100, 200)),
            ("oedometer: strain at 1 GPa [%]", 1, None, ("oedometer", "strain_1000")),
            ("tangent at 0.3 GPa [GPa]", 1, None, ("oedometer", "tangent_300"))]
    if name != "sizes":
        return ""
    lines = ["| elements in the prism (radius) | " + " | ".join(f"{n:,} ({r})" for n, r in sizes.items()) + " |", "|---" * 5 + "|"]
    for words, *how in rows:
        lines.append("| " + " | ".join([words, *(cell(n, *how) for n in sizes)]) + " |")
    return "\n".join(lines)


def lines_of(name):
    with open(RESULTS / f"{name}.csv", newline="") as file:
        return list(csv.DictReader(file))


def impact(kind):
    return impact_tables.TABLES[kind](lines_of("impact"))


MAKERS = {"rock": rock, "concrete": concrete, "impact": impact, "library": lambda which: library_tables.markdown(lines_of("library"), which),
          "criterion": lambda _: concrete_tables.criterion(lines_of("criterion")), "choice": lambda _: concrete_tables.choice(lines_of("choice")),
          "reinforced": lambda what: reinforced_tests.drops(lines_of("reinforced")) if what == "drops" else reinforced_tests.markdown(lines_of("reinforced"), what),
          "slip_wear": lambda packings: slip_wear.markdown(lines_of("slip_wear"), packings),
          "speed": lambda table: speed_tables.TABLES[table](),
          "ldpm": lambda what: ldpm_tables.markdown(lines_of("ldpm"), what),
          "published": lambda test: published_tests.markdown(lines_of("published"), test),
          "experiments": lambda test: rock_experiments.markdown(lines_of("rock_experiments"), test),
          "calibrations": lambda which: rock_library.calibration_table(lines_of("calibrations"), which),
          "rocks": lambda which: rock_library.recovery_table(lines_of("rocks"), which),
          "misfits": lambda _: misfit_table.markdown(lambda name, what: MAKERS[name](what)),
          "localisation": lambda _: localisation.markdown(lines_of("localisation")),
          "beyond_peak": lambda which: beyond_peak.markdown(lines_of("beyond_peak"), which),
          "damping": lambda _: damped_links.table(lines_of("damping")),
          "grips": lambda which: localisation.pulled_table(lines_of("grips"), which)}


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
    for page in [*sorted((ROOT / "docs").glob("*.md")), ROOT / "cases/rc_slab/README.md", ROOT / "cases/triaxial/README.md", ROOT / "README.md"]:
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
