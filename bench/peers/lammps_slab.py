"""The slab of cases/rc_slab in LAMMPS: its data file, its input, and the program run as told line by line.

The elements are those of Breccia: same places, radii, masses, supports, velocity. Every link of Breccia becomes a bond of
bpm/rotational, which is elastic and breaks at once by its sum of normal force, shear force and moments over their limits.
Bonds are of 16 types by the smaller radius of their ends, each with the stiffness and strength of a round beam of that radius.
Spheres without a bond between them touch as gran/hooke/history has it.
"""
import csv
import math
import re

YOUNG, SHEAR = 30e9, 12.5e9  # Pa
TENSION, COHESION = 2.2e6, 11e6  # Pa
TYPES = 16
SPEED = 30.0  # of the rock, m/s

INPUT = """units si
atom_style bpm/sphere
boundary f f f
newton on off
special_bonds lj 0 1 1 coul 1 1 1
comm_modify vel yes cutoff {reach:.6g}
read_data {data} extra/special/per/atom 60
neighbor {skin:.6g} bin
neigh_modify every 1 delay 0 check yes
pair_style gran/hooke/history {contact:.6g} NULL 0 NULL 0.5 0
pair_coeff * *
bond_style bpm/rotational
{coefficients}
timestep {dt}
group free type 1
fix motion free nve/bpm/sphere
compute of_each all nbond/atom
compute in_all all reduce sum c_of_each
variable speed atom sqrt(vx*vx+vy*vy+vz*vz)
compute fastest all reduce max v_speed
thermo_style custom step c_in_all c_fastest
thermo_modify lost ignore lost/bond ignore format float %.17g
thermo 0
run 0 post no
print "READY"
"""


def rows(path):
    with open(path, newline="") as lines:
        return list(csv.DictReader(lines))[1:]  # the first row holds units


def write(folder):
    """Writes the data file and the input. @returns elements, links, lines of the input"""
    elements = [{k: v if k == "group" else float(v) for k, v in row.items()} for row in rows(folder / "elements.csv")]
    links = [(int(row["a"]), int(row["b"])) for row in rows(folder / "links.csv")]
    places = [(e["x"], e["y"], e["z"]) for e in elements]
    radii = [e["radius"] for e in elements]
    small = [min(radii[a], radii[b]) for a, b in links]
    least, most = min(small), max(small)
    types = [min(TYPES - 1, int(TYPES * (r - least) / (most - least))) for r in small]
    lengths = [math.dist(places[a], places[b]) for a, b in links]

    atoms = [f"{k + 1} 1 {1 if e['fixed'] == 0 else 2} {2 * e['radius']:.17g} "
             f"{e['mass'] / (4 / 3 * math.pi * e['radius']**3):.17g} {e['x']:.17g} {e['y']:.17g} {e['z']:.17g}"
             for k, e in enumerate(elements)]
    speeds = [f"{k + 1} 0 0 {-SPEED if e['group'] == 'impactor' else 0} 0 0 0" for k, e in enumerate(elements)]
    bonds = [f"{k + 1} {types[k] + 1} {a + 1} {b + 1}" for k, (a, b) in enumerate(links)]
    room = 0.5
    bounds = [f"{min(p[c] for p in places) - room} {max(p[c] for p in places) + room} {'xyz'[c]}lo {'xyz'[c]}hi" for c in range(3)]
    head = [f"{len(atoms)} atoms", f"{len(bonds)} bonds", "2 atom types", f"{TYPES} bond types", *bounds]
    parts = {"Atoms # bpm/sphere": atoms, "Velocities": speeds, "Bonds": bonds}
    text = "the slab\n\n" + "\n".join(head) + "".join(f"\n\n{name}\n\n" + "\n".join(lines) for name, lines in parts.items())
    (folder / "slab.data").write_text(text + "\n")

    coefficients = []
    for t in range(TYPES):
        own = [k for k, of in enumerate(types) if of == t]
        r = sum(small[k] for k in own) / len(own) if own else most
        length = sum(lengths[k] for k in own) / len(own) if own else 2 * most
        section, bending, twist = math.pi * r**2, math.pi * r**4 / 4, math.pi * r**4 / 2
        numbers = [YOUNG * section / length, SHEAR * section / length, SHEAR * twist / length, YOUNG * bending / length,
                   TENSION * section, COHESION * section, COHESION * twist / r, TENSION * bending / r, 0, 0, 0, 0]
        coefficients.append(f"bond_coeff {t + 1} " + " ".join(f"{n:.6g}" for n in numbers))
    lines = INPUT.format(reach=1.5 * max(lengths), data=folder / "slab.data", skin=0.5 * min(radii), contact=YOUNG * min(radii),
                         coefficients="\n".join(coefficients), dt=(folder / "dt.txt").read_text())
    return len(atoms), len(bonds), lines


class Answers:
    """Reads what LAMMPS says of each run."""

    def __init__(self, process):
        self.process = process

    def until(self, word):
        said = []
        for line in self.process.stdout:
            said.append(line)
            if line.startswith("ERROR"):
                break
            if line.strip() == word:
                return "".join(said)
        raise SystemExit("LAMMPS ended:\n" + "".join(said[-12:]))

    def state(self, said):
        """Bonds, and the highest speed, of the last row."""
        row = [line.split() for line in said.splitlines() if re.match(r"\s*\d+\s+[\d.e+]+\s+[\d.e+-]+\s*$", line)][-1]
        return round(float(row[1]) / 2), float(row[2])
