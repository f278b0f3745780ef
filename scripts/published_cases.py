"""Parts of the cases of published tests, and what their histories and records give."""
import json
import statistics

HEAD = """breccia = 1
method = "dem3d"
title = "{title}"
seed = {seed}

[time]
end = "{end}"
safety = {safety}

[output]
frames = 2
history = "{history}"
color = "damage"
view = "y"

[energy]
stop = 0.1

[search]
margin = 0.5

[links]
range = 1.443

[material.concrete]
use = "{concrete}"
{keys}
"""
BARS = """
[material.bars]
use = "B500B"

[material.bond]
law = "interface"
bond = "mc90"
bond_strength = "13.7 MPa"
bond_residual = "5.5 MPa"
slip1 = "1 mm"
slip2 = "3 mm"
slip3 = "8 mm"
tensile_strength = "2.2 MPa"
softening = 10.0

[[body]]
name = "steel"
shape = "rebar"
material = "bars"
rebar = {{ in = "target", interface = "bond", {mats} }}
"""


def probe(name, on, quantity, reduce="mean", low=None, high=None):
    box = f"min = {low}\nmax = {high}\n" if low else ""
    return f'\n[[probe]]\nname = "{name}"\non = "{on}"\nquantity = "{quantity}"\nreduce = "{reduce}"\n{box}'


def slab(size, thickness, elements):
    return (f'\n[[body]]\nname = "target"\nshape = "box"\nmaterial = "concrete"\nsize = [{size}, {size}, {thickness}]\n'
            f'pack = {{ count = {elements}, size_ratio = 2.0, compactness = 0.56 }}\n')


def smooth(values, width):
    return [statistics.mean(values[max(0, k - width):k + width + 1]) for k in range(len(values))]


def spread(values, digits, unit=1.0):
    values = [unit * v for v in values]
    mean = round(statistics.mean(values), digits) + 0.0  # no -0
    return f"{mean:,.{digits}f}" + (f" +- {statistics.stdev(values):,.{digits}f}" if len(values) > 1 else "")


def grouped(records):
    """[(setting, {quantity: values})] in the order of the file."""
    found = {}
    for one in records:
        found.setdefault(one["setting"], {}).setdefault(one["quantity"], []).append(float(one["value"]))
    return [(json.loads(setting), values) for setting, values in found.items()]
