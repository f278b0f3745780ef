"""A case of two balls, of which the left one flies at the other for 2 ms."""

CASE = """
method = "dem3d"
energy = { warn = 0.0, stop = 0.0 }
time.end = "2 ms"
material.rock = { law = "grain", young = "1 GPa" }
%s
[[body]]
name = "left"
shape = "element"
material = "rock"
center = [-0.011, 0.0, 0.0]
radius = "10 mm"
velocity = [2.0, 0.0, 0.0]
[[body]]
name = "right"
shape = "element"
material = "rock"
center = [0.011, 0.0, 0.0]
radius = "10 mm"
"""


def case_with(keys):
    """The case with more keys of the file's first level."""
    return CASE % keys
