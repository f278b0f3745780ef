#include "app/templates.hpp"

namespace breccia::app {

const char* const bar_of_tetrahedra =
    R"(# A bar of rock as a solid: a blow on one end runs to the other, comes back as
# tension, and a piece spalls off.
breccia = 1
method = "fdem3d"
title = "Spalling of a bar"

[time]
end = "130 us"

[output]
frames = 6
color = "damage"

[material.rock]
density = "2400 kg/m3"
young = "36 GPa"
poisson = 0.2
damping = 0.02

[material.rock.joint] # strength: how it cracks
tension = "4 MPa"
cohesion = "40 MPa"
friction_angle = "35 deg"
energy_open = "4 J/m2"
energy_slide = "20 J/m2"

[[body]]
name = "bar"
shape = "box"
material = "rock"
size = ["10 mm", "10 mm", "250 mm"]
mesh_size = "5 mm"
structured = true # without it the program gmsh makes a free mesh

[[load]] # on the faces below z = -124.99 mm: up to 8 MPa, and down again
name = "blow"
on = "bar"
max = [1, 1, "-124.99 mm"]
kind = "pressure"
pressure = "8 MPa"
times = [0.0, "6 us", "59 us"]
factors = [0.0, 1.0, 0.0]

[[support]] # holds nothing: a region that the probe reads
name = "end"
on = "bar"
min = [-1, -1, "124.99 mm"]
fix = []

[[probe]]
name = "end_velocity"
on = "end"
quantity = "velocity_z"

[[check]]
name = "every joule is accounted for"
value = "energy.error_relative"
expected = 0.0
tolerance = 0.01
)";

}  // namespace breccia::app
