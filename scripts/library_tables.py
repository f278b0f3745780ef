"""Tables of the concretes of `breccia materials` on packings that they were not calibrated on, from docs/results/library.csv: what targets ask for on
packings 5 to 12, and so what is left beyond the peak; all else, whose ratios are of two tests on the same packings, on 5 to 7."""
import math
import pathlib
import re
import statistics
import tomllib

MATERIALS = pathlib.Path(__file__).resolve().parent.parent / "src/io/case/materials.toml"


PAIRED = {"5", "6", "7", "mean"}  # packings of all tests


def numbers(lines):
    """{(material, elements, test, quantity): (mean, deviation, count)}, of specimens that have a number, or as recorded."""
    found = {}
    for one in lines:
        if math.isfinite(float(one["value"])):
            key = one["material"], int(one["elements"]), one["test"], one["quantity"]
            found.setdefault(key, {})[one["specimen"]] = float(one["value"])
    made = {}
    for key, of in found.items():
        if "mean" in of:
            made[key] = of["mean"], of["deviation"], int(of["count"])
        else:
            made[key] = statistics.mean(of.values()), statistics.stdev(of.values()) if len(of) > 1 else 0.0, len(of)
    return made


def spread(number, digits, over=1.0):
    mean, deviation, count = number
    return f"{round(mean / over, digits) + 0.0:.{digits}f}" + (f" +- {deviation / over:.{digits}f}" if count > 1 else "")


def targets_of(name):
    return {key: float(str(value).split()[0]) for key, value in tomllib.loads(MATERIALS.read_text())[name]["target"].items()}


def recovery(found, which):
    """What is asked beside what is shown: "all" concretes of 1,200 elements, the others of them over "sizes" of elements, or one over its sizes."""
    quantities = [("young", "compression_prism", "young", 1, 3), ("poisson", "compression_prism", "poisson", 3, 10),
                  ("compression", "compression_prism", "strength", 1, 5), ("tension", "tension", "strength", 2, 5),
                  ("fracture_energy", "tension_notched", "fracture_energy", 0, 10), (None, "bending", "fracture_energy", 0, None)]
    heads = {"all": "1,200 elements", "sizes": "elements in the prism"}
    lines = [f"| {heads.get(which, 'elements in the prism')} | E (3 %), GPa | nu (10 %) | f_c (5 %), MPa | f_t (5 %), MPa | G_F (10 %), J/m2 | notched beam, J/m2 | n |",
             "|---" * 8 + "|"]
    rows = {(material, elements) for material, elements, test, _ in found if test == "compression_prism"}
    for material, elements in sorted(rows, key=lambda row: (int(row[0][1:]), row[1])):
        if not {"all": elements == 1200, "sizes": material != "C30" and elements != 1200}.get(which, material == which):
            continue
        name_of = {"all": material, "sizes": f"{material}, {elements:,}"}.get(which, f"{elements:,}")
        cells, count = [], found[material, elements, "compression_prism", "strength"][2]
        for name, test, quantity, digits, allowed in quantities:
            number = found.get((material, elements, test, quantity))
            text = spread(number, digits) if number else ""
            if number and name:
                misfit = 100 * (number[0] / targets_of(material)[name] - 1)
                mark = "**" if abs(misfit) > allowed else ""
                text += f", {mark}{misfit:+.1f} %{mark}"
            cells.append(text + (f" (n = {number[2]})" if number and number[2] != count else ""))
        lines.append(f"| {name_of} | " + " | ".join(cells) + f" | {count} |")
    return "\n".join(lines)


def newman(f_c, pressure):
    """Triaxial strength by Newman and Newman (1971), MPa."""
    return f_c * (1 + 3.7 * (pressure / f_c) ** 0.86)


def paired_slopes(lines):
    """{(material, elements): (mean, deviation, count)} of the strength that a pressure of 5 MPa adds, over it, packing by packing."""
    of = {}
    for one in lines:
        if one["quantity"] == "strength" and one["test"] in ("compression_prism", "triaxial_5"):
            of.setdefault((one["material"], int(one["elements"])), {}).setdefault(one["specimen"], {})[one["test"]] = float(one["value"])
    slopes = {key: [(s["triaxial_5"] - s["compression_prism"]) / 5 for s in specimens.values() if len(s) == 2] for key, specimens in of.items()}
    return {key: (statistics.mean(values), statistics.stdev(values), len(values)) for key, values in slopes.items() if len(values) > 1}


SLOPE = "strength that 5 MPa add, over 5 MPa (concrete: 4 to 5)"


def slope_cell(number):
    if not number:
        return ""
    text = spread(number, 1)
    return text if 4.0 <= round(number[0], 1) <= 5.0 else re.sub(r"^(\S+)", r"**\1**", text)


def left(found, material, elements):
    """Of f_c at three times the strain of the peak: of long prisms where there are some, else of those of `breccia test`."""
    number = found.get((material, elements, "prism_long", "residual")) or found.get((material, elements, "compression_prism", "residual"))
    if not number:
        return ""
    text = spread(number, 3)
    if not 0.1 <= round(number[0], 3) <= 0.2:
        text = re.sub(r"^(\S+)", r"**\1**", text)
    return text + ("" if number[2] == 3 else f" (n = {number[2]})")


def beyond(lines, elements):
    """Tests that no target asks for, concrete by concrete, beside what is published."""
    found, whole, made = numbers([one for one in lines if one["specimen"] in PAIRED]), numbers(lines), lines
    slopes = paired_slopes([one for one in lines if one["specimen"] in PAIRED])
    materials = sorted({key[0] for key in found}, key=lambda name: int(name[1:]))
    materials = [name for name in materials if (name, elements, "triaxial_50", "strength") in found]

    def mean(material, test):
        return found.get((material, elements, test, "strength"), (None,))[0]

    def cell(material, test, quantity, digits, over=None, wanted=(-math.inf, math.inf), count=elements):
        number = found.get((material, count, test, quantity))
        if over:  # packing by packing
            up, below = ({one["specimen"]: float(one["value"]) for one in made if (one["material"], int(one["elements"]), one["test"], one["quantity"]) == (material, size, name, quantity)}
                         for size, name in ((count, test), (elements, over)))
            ratios = [up[packing] / below[packing] for packing in up if packing in below and packing in PAIRED]
            number = (statistics.mean(ratios), statistics.stdev(ratios) if len(ratios) > 1 else 0.0, len(ratios)) if ratios else None
        if not number:
            return ""
        text = spread(number, digits)
        if not wanted[0] <= round(number[0], digits) <= wanted[1]:
            text = re.sub(r"^(\S+)", r"**\1**", text)
        return text + ("" if number[2] == 3 else f" (n = {number[2]})")

    def confined(material, pressure):
        number = found.get((material, elements, f"triaxial_{pressure}", "strength"))
        if not number:
            return ""
        rule = newman(mean(material, "compression_prism"), pressure)
        return spread(number, 0) + (f", {100 * (number[0] / rule - 1):+.0f} %" if pressure <= 20 else "")

    def peak(material):
        number, rule = found.get((material, elements, "compression_prism", "peak_strain")), min(0.7 * targets_of(material)["compression"] ** 0.31, 2.8)
        return f"{spread(number, 2)}, {100 * (number[0] / rule - 1):+.0f} %" if number else ""

    def strains(material):
        of = [found.get((material, elements, f"triaxial_{pressure}", "peak_strain")) for pressure in (5, 20, 50, 100)]
        return "; ".join(f"{0.1 * number[0]:.2g}" for number in of if number)

    discs = 2 * elements
    rows = [("strain at f_c, 1e-3 (0.7 f_cm^0.31 up to 2.8, EN 1992-1-1)", peak),
            ("left at 3 times that strain, of f_c (0.1 to 0.2)", lambda m: left(whole, m, elements)),
            ("the same, rough platens (0.1 to 0.2)", lambda m: cell(m, "platens_prism", "residual", 2, None, (0.1, 0.2))),
            ("smooth cube over smooth prism (1.0)", lambda m: cell(m, "compression_cube", "strength", 2, "compression_prism")),
            ("rough prism over smooth prism (1.0 to 1.05)", lambda m: cell(m, "platens_prism", "strength", 2, "compression_prism", (1.0, 1.05))),
            ("rough cube over rough prism (1.15 to 1.30)", lambda m: cell(m, "platens_cube", "strength", 2, "platens_prism", (1.15, 1.30))),
            ("rough cube over smooth cube (below 1.6)", lambda m: cell(m, "platens_cube", "strength", 2, "compression_cube", (0.0, 1.6))),
            (f"disc of {discs:,} elements over f_t (1.0 to 1.15)", lambda m: cell(m, "brazilian", "strength", 2, "tension", (1.0, 1.15), discs)),
            ("beam under two lines of load over f_t (1.66, Model Code 2010)", lambda m: cell(m, "bending_thirds", "strength", 2, "tension", (1.58, 1.74))),
            ("s1 at 5 MPa, MPa; over Newman", lambda m: confined(m, 5)), ("at 20 MPa; over Newman", lambda m: confined(m, 20)),
            (SLOPE, lambda m: slope_cell(slopes.get((m, elements)))),
            ("strain at s1 at 5 MPa; at 20; at 50; at 100, %", strains),
            ("at 50 MPa (R30A7: 180 to 200)", lambda m: confined(m, 50)), ("at 100 MPa (R30A7: about 300)", lambda m: confined(m, 100)),
            ("at 200 MPa (R30A7: 500 to 550)", lambda m: confined(m, 200)),
            ("at 500 MPa", lambda m: confined(m, 500)), ("at 650 MPa", lambda m: confined(m, 650)),
            ("oedometer: strain at 0.1 GPa, %", lambda m: cell(m, "oedometer", "strain_100", 2)),
            ("at 1 GPa, % (R30A7: 8 to 10)", lambda m: cell(m, "oedometer", "strain_1000", 1)),
            ("its tangent at 0.3 GPa, GPa", lambda m: cell(m, "oedometer", "tangent_300", 1)),
            ("at 0.8 GPa, GPa", lambda m: cell(m, "oedometer", "tangent_800", 1)),
            ("lateral over axial stress at 1 GPa (0.4 to 0.6)", lambda m: cell(m, "oedometer", "side_ratio", 2, None, (0.4, 0.6)))]
    lines = [f"| {elements:,} elements, n = 3 | " + " | ".join(materials) + " |", "|---" * (len(materials) + 1) + "|"]
    for words, of in rows:
        cells = [of(material) for material in materials]
        if any(cells):
            lines.append(f"| {words} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def table(head, columns, rows):
    """@param rows  words, a function of a column's key that gives its cell"""
    lines = [f"| {head} | " + " | ".join(columns.values()) + " |", "|---" * (len(columns) + 1) + "|"]
    return "\n".join([*lines, *("| " + " | ".join([words, *(of(key) for key in columns)]) + " |" for words, of in rows)])


def pressed(lines, material):
    """Triaxial tests and oedometers of one concrete over sizes of elements, beside what is published."""
    lines = [one for one in lines if one["specimen"] in PAIRED]
    found, slopes = numbers(lines), paired_slopes(lines)
    sizes = {elements: f"{elements:,}" for elements in sorted({key[1] for key in found if key[0] == material and key[2] == "triaxial_5"})}

    def cell(test, quantity, digits, unit=1.0, wanted=(-math.inf, math.inf)):
        def of(elements):
            number = found.get((material, elements, test, quantity))
            if not number:
                return ""
            text = spread(number, digits, unit)
            return text if wanted[0] <= round(number[0] / unit, digits) <= wanted[1] else re.sub(r"^(\S+)", r"**\1**", text)
        return of

    def confined(pressure):
        def of(elements):
            number, f_c = (found[material, elements, test, "strength"] for test in (f"triaxial_{pressure}", "compression_prism"))
            return f"{spread(number, 1)}, {100 * (number[0] / newman(f_c[0], pressure) - 1):+.0f} %"
        return of

    def turned(elements):
        of = [found.get((material, elements, "oedometer_unload", quantity)) for quantity in ("turn_stress", "low_stress")]
        return f"{of[0][0]:.2f} to {of[1][0]:.2f}" if all(of) else ""

    rows = [("s1 at 5 MPa, MPa; over Newman", confined(5)), (SLOPE, lambda elements: slope_cell(slopes[material, elements])), ("s1 at 20 MPa; over Newman", confined(20)),
            *((f"at {p} MPa (R30A7: {words})", cell(f"triaxial_{p}", "strength", 0, 1.0, wanted))
              for p, words, wanted in ((50, "180 to 200", (180, 200)), (100, "about 300", (285, 315)), (200, "500 to 550", (500, 550)))),
            *((f"strain at s1 at {p} MPa, %", cell(f"triaxial_{p}", "peak_strain", 2 if p < 50 else 1, 10.0)) for p in (5, 20, 50, 100, 200)),
            ("oedometer: strain at 1 GPa, % (R30A7: 8 to 10)", cell("oedometer", "strain_1000", 1, 1.0, (8, 10))),
            *((f"its tangent at {stress} GPa, GPa", cell("oedometer", f"tangent_{1000 * stress:.0f}", 1)) for stress in (0.3, 0.8)),
            ("at 1.2 GPa, once unloaded and loaded again, GPa", cell("oedometer_unload", "tangent_1200", 1)),
            ("largest stress up to 15 % of strain, GPa", cell("oedometer_unload", "largest", 2)),
            ("unloaded at 8.7 % by 5 % of strain: from, to, GPa", turned), ("slope from 0.9 to 0.5 of that stress, GPa", cell("oedometer_unload", "unload_90_50", 1)),
            ("loaded again, 0.2 to 0.8 of it, GPa", cell("oedometer_unload", "reload_20_80", 1)),
            ("lateral over axial stress at 1 GPa (0.4 to 0.6)", cell("oedometer", "side_ratio", 2, 1.0, (0.4, 0.6)))]
    return table(f"{material}, n = 3; elements in the prism", sizes, rows)


def pressed_sizes(lines, materials):
    """The same of several concretes, side by side, beside Newman's rule alone."""
    lines = [one for one in lines if one["specimen"] in PAIRED]
    found, slopes = numbers(lines), paired_slopes(lines)
    columns = {key[:2]: f"{key[0]}, {key[1]:,}" for key in sorted(found, key=lambda key: (int(key[0][1:]), key[1])) if key[0] in materials and key[2:] == ("triaxial_100", "strength")}

    def cell(test, quantity, digits, unit=1.0):
        return lambda key: spread(found[*key, test, quantity], digits, unit) if (*key, test, quantity) in found else ""

    def confined(pressure):
        def of(key):
            number = found[*key, f"triaxial_{pressure}", "strength"]
            return f"{spread(number, 0)}, {100 * (number[0] / newman(found[*key, 'compression_prism', 'strength'][0], pressure) - 1):+.0f} %"
        return of

    rows = [*((f"s1 at {p} MPa, MPa; over Newman", confined(p)) for p in (5, 20)), (SLOPE, lambda key: slope_cell(slopes.get(key))), *((f"at {p} MPa, MPa", cell(f"triaxial_{p}", "strength", 0)) for p in (50, 100)),
            *((f"strain at s1 at {p} MPa, %", cell(f"triaxial_{p}", "peak_strain", 2, 10.0)) for p in (5, 20, 50, 100)), ("oedometer: strain at 1 GPa, %", cell("oedometer", "strain_1000", 1)),
            ("its tangent at 0.8 GPa, GPa", cell("oedometer", "tangent_800", 1)), ("lateral over axial stress at 1 GPa (0.4 to 0.6)", cell("oedometer", "side_ratio", 2))]
    return table("n = 3; elements in the prism", columns, rows)


def long_prisms(lines):
    """What is left of prisms beyond their peak, and what links spend by then, concrete by concrete and size by size."""
    found, spent = numbers(lines), ("friction", "plastic", "fracture")
    columns = {key[:2]: f"{key[0]}, {key[1]:,}" for key in sorted(found, key=lambda key: (int(key[0][1:]), key[1])) if key[2:] == ("prism_long", "residual")}

    def cell(quantity):
        def of(key):
            number = found[*key, "prism_long", quantity]
            text = spread(number, 3)
            return text if quantity != "residual" or number[0] >= 0.0995 else re.sub(r"^(\S+)", r"**\1**", text)
        return of

    def share(quantity, of_all):
        return lambda key: f"{100 * found[*key, 'prism_long', quantity][0] / sum(found[*key, 'prism_long', name][0] for name in of_all):.0f}"

    rows = [*((f"left at {times} times the strain of the peak, of f_c", cell(quantity)) for times, quantity in ((2, "left_2"), (2.5, "left_2.5"), ("3", "residual"))),
            ("of what links have spent at the end: friction; plastic (moments, compaction, crushing); cracks, %", lambda key: "; ".join(share(name, spent)(key) for name in spent)),
            ("damping of links, of all work, %", share("damping", ("work",)))]
    return table("n = 3; elements", columns, rows)


def markdown(lines, which):
    """`all`, `sizes`, `C30` over sizes, `beyond ELEMENTS`, `pressed MATERIAL`, `pressed MATERIAL MATERIAL`, `long prisms`."""
    if which.startswith("beyond"):
        return beyond(lines, int(which.split()[1]))
    if which.startswith("pressed"):
        materials = which.split()[1:]
        return pressed(lines, materials[0]) if len(materials) == 1 else pressed_sizes(lines, materials)
    return long_prisms(lines) if which == "long prisms" else recovery(numbers(lines), which)
