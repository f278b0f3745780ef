"""Tables of the concretes of `breccia materials` on packings that they were not calibrated on, from docs/results/library.csv: what targets ask for on
packings 5 to 12, all else, whose ratios are of two tests on the same packings, on 5 to 7."""
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
    return f"{mean / over:.{digits}f}" + (f" +- {deviation / over:.{digits}f}" if count > 1 else "")


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


def beyond(found, elements):
    """Tests that no target asks for, concrete by concrete, beside what is published."""
    materials = sorted({key[0] for key in found}, key=lambda name: int(name[1:]))
    materials = [name for name in materials if (name, elements, "triaxial_50", "strength") in found]

    def mean(material, test):
        return found.get((material, elements, test, "strength"), (None,))[0]

    def cell(material, test, quantity, digits, over=None, wanted=(-math.inf, math.inf), count=elements):
        number, below = found.get((material, count, test, quantity)), mean(material, over) if over else 1.0
        if not number or not below:
            return ""
        text = spread(number, digits, below)
        if not wanted[0] <= round(number[0] / below, digits) <= wanted[1]:
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

    discs = 2 * elements
    rows = [("strain at f_c, 1e-3 (0.7 f_cm^0.31 up to 2.8, EN 1992-1-1)", peak),
            ("left at 3 times that strain, of f_c (0.1 to 0.2)", lambda m: cell(m, "compression_prism", "residual", 2, None, (0.1, 0.2))),
            ("the same, rough platens (0.1 to 0.2)", lambda m: cell(m, "platens_prism", "residual", 2, None, (0.1, 0.2))),
            ("smooth cube over smooth prism (1.0)", lambda m: cell(m, "compression_cube", "strength", 2, "compression_prism")),
            ("rough prism over smooth prism (1.0 to 1.05)", lambda m: cell(m, "platens_prism", "strength", 2, "compression_prism", (1.0, 1.05))),
            ("rough cube over rough prism (1.15 to 1.30)", lambda m: cell(m, "platens_cube", "strength", 2, "platens_prism", (1.15, 1.30))),
            ("rough cube over smooth cube (below 1.6)", lambda m: cell(m, "platens_cube", "strength", 2, "compression_cube", (0.0, 1.6))),
            (f"disc of {discs:,} elements over f_t (1.0 to 1.15)", lambda m: cell(m, "brazilian", "strength", 2, "tension", (1.0, 1.15), discs)),
            ("beam under two lines of load over f_t (1.66, Model Code 2010)", lambda m: cell(m, "bending_thirds", "strength", 2, "tension", (1.58, 1.74))),
            ("s1 at 5 MPa, MPa; over Newman", lambda m: confined(m, 5)), ("at 20 MPa; over Newman", lambda m: confined(m, 20)),
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


def markdown(lines, which):
    """`all`, `sizes`, `C30` over sizes, `beyond ELEMENTS`."""
    if which.startswith("beyond"):
        return beyond(numbers([one for one in lines if one["specimen"] in PAIRED]), int(which.split()[1]))
    return recovery(numbers(lines), which)
