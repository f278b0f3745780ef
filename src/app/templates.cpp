#include "app/templates.hpp"

#include <fmt/format.h>

#include <set>

#include "exec/error.hpp"
#include "io/case/suggestion.hpp"

namespace breccia::app {
namespace {

const char* const beam = R"(# A concrete beam bent over three points until it cracks from below.
# The plane is 1 m thick: forces are N for each metre of thickness.
breccia = 1
method = "fdem2d"
title = "Three-point bending"

[time]
end = "7 ms"

[output]
frames = 10
color = "stress_xx"
view = "z"

[material.concrete]
density = "2340 kg/m3"
young = "26 GPa"
poisson = 0.2
damping = 0.5 # of waves: the load is quasi-static

[material.concrete.joint] # strength: how it cracks
tension = "3 MPa"
cohesion = "10 MPa"
friction_angle = "30 deg"
energy_open = "30 J/m2"
energy_slide = "30 J/m2"

[[body]]
name = "beam"
shape = "beam"
material = "concrete"
size = ["320 mm", "40 mm"]
mesh_size = "6 mm" # smaller: a finer crack, and shorter steps
structured = true  # without it the program gmsh makes a free mesh

# A support takes the corners of triangles in its region.
[[support]]
name = "left"
min = ["-161 mm", "-21 mm"]
max = ["-154 mm", "-19 mm"]
fix = ["y"]

[[support]]
name = "right"
min = ["154 mm", "-21 mm"]
max = ["161 mm", "-19 mm"]
fix = ["y"]

[[support]]
name = "press"
min = ["-4 mm", "19 mm"]
max = ["4 mm", "21 mm"]
velocity = [0.0, "-25 mm/s"]
ramp = "2 ms"

[[probe]] # a column of history.csv
name = "force"
on = "press"
quantity = "force_y"
reduce = "sum"

[[check]]
name = "every joule is accounted for"
value = "energy.error_relative"
expected = 0.0
tolerance = 0.01
)";

const char* const cylinder = R"(# A concrete cylinder crushed between two rigid walls.
breccia = 1
method = "dem3d"
title = "Cylinder between walls"

[time]
end = "12 ms"

[output]
frames = 10
color = "damage"

[material.c30]
use = "C30" # of the program: breccia materials C30; found with packings and links as below

[[body]]
name = "cylinder"
shape = "cylinder"
material = "c30"
radius = "50 mm"
length = "200 mm" # along z, about its centre
pack = { count = 1500, size_ratio = 2.0, compactness = 0.56 }

[links]
range = 1.443

[[wall]]
name = "bottom"
point = [0.0, 0.0, "-100 mm"]
normal = [0.0, 0.0, 1.0] # out of the wall, towards the elements

[[wall]]
name = "top"
point = [0.0, 0.0, "100 mm"]
normal = [0.0, 0.0, -1.0]
velocity = [0.0, 0.0, "-60 mm/s"]

[[probe]] # the load curve: force and place of the moving wall
name = "force"
on = "top"
quantity = "force_z"

[[probe]]
name = "place"
on = "top"
quantity = "position_z"

[[check]]
name = "every joule is accounted for"
value = "energy.error_relative"
expected = 0.0
tolerance = 0.01
)";

const char* const plate = R"(# A steel-hard ball through a thin concrete plate.
breccia = 1
method = "dem3d"
title = "Ball through a plate"

[time]
end = "1.5 ms"

[output]
frames = 12
color = "damage"

[material.c30]
use = "C30" # of the program: breccia materials C30; found with packings and links as below

[material.steel_ball]
law = "grain" # contacts only: one element does not break
density = "7850 kg/m3"
young = "200 GPa"

[[body]]
name = "plate"
shape = "box"
material = "c30"
size = ["400 mm", "400 mm", "30 mm"]
pack = { count = 3000, size_ratio = 2.0, compactness = 0.56 }

[links]
range = 1.443

[[body]]
name = "ball"
shape = "element"
material = "steel_ball"
radius = "25 mm"
center = [0.0, 0.0, "42 mm"]
velocity = [0.0, 0.0, "-60 m/s"]

[[support]]
name = "left"
on = "plate"
max = ["-185 mm", inf, inf]

[[support]]
name = "right"
on = "plate"
min = ["185 mm", -inf, -inf]

[[probe]]
name = "ball_velocity"
on = "ball"
quantity = "velocity_z"

[[check]]
name = "the ball goes through and is slower"
value = "probe.ball_velocity.last"
expected = -35.0
tolerance = 24.9
unit = "m/s"
)";

const char* const slope = R"(# A heap of loose grains runs down a slope and stops on the plain.
breccia = 1
method = "dem3d"
title = "Avalanche"
gravity = [0.0, 0.0, "-9.81 m/s2"]

[time]
end = "1.2 s"
safety = 0.2 # grains touch for few steps: a shorter step books what they take within 0.1 %

[output]
frames = 12
color = "velocity"
view = "y"

[material.stone]
law = "grain" # contacts only
density = "1600 kg/m3" # of the heap, voids included
young = "5 MPa"        # soft: longer steps; grains overlap by less than 1 % of their size

[contact]
friction = 0.5
restitution = 0.3
rolling_limit = 0.2
rolling_stiffness = 1.0

[[body]]
name = "heap"
shape = "box"
material = "stone"
center = [0.0, 0.0, "450 mm"]
size = ["300 mm", "200 mm", "200 mm"]
pack = { count = 1500, size_ratio = 1.5, compactness = 0.5 }

[[wall]] # the slope, 35 degrees
name = "slope"
point = [0.0, 0.0, "200 mm"]
normal = [0.5736, 0.0, 0.8192]

[[wall]]
name = "plain"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]

[[probe]]
name = "front"
on = "heap"
quantity = "position_x"
reduce = "max"

[[probe]]
name = "motion"
on = "heap"
quantity = "kinetic"
reduce = "sum"
)";

const char* const disc = R"(# A rock disc split between two platens: the Brazilian test.
# The plane is 1 m thick: forces are N for each metre of thickness.
breccia = 1
method = "fdem2d"
title = "Brazilian disc"

[time]
end = "0.2 ms"

[output]
frames = 12
color = "stress_xx"
view = "z"

[material.granite]
density = "2630 kg/m3"
young = "60 GPa"
poisson = 0.25
damping = 0.5

[material.granite.joint]
tension = "8 MPa"
cohesion = "33 MPa"
friction_angle = "52 deg"
energy_open = "30 J/m2"
energy_slide = "140 J/m2"

[material.steel]
density = "7850 kg/m3"
young = "200 GPa"
poisson = 0.3
joints = "none" # does not break
friction = 0.1

[[body]]
name = "disc"
shape = "disc"
material = "granite"
radius = "40 mm"
mesh_size = "3 mm"
structured = true # without it the program gmsh makes a free mesh

[[body]]
name = "top"
shape = "plate"
material = "steel"
center = [0.0, "42 mm"]
size = ["24 mm", "4 mm"]
mesh_size = "2 mm"
structured = true

[[body]]
name = "bottom"
shape = "plate"
material = "steel"
center = [0.0, "-42 mm"]
size = ["24 mm", "4 mm"]
mesh_size = "2 mm"
structured = true

[[support]]
name = "press"
on = "top"
velocity = [0.0, "-0.5 m/s"]
ramp = "10 us"

[[support]]
name = "anvil"
on = "bottom"
velocity = [0.0, "0.5 m/s"]
ramp = "10 us"

[[probe]]
name = "force"
on = "top"
quantity = "force_y"
reduce = "sum"

[[check]]
name = "every joule is accounted for"
value = "energy.error_relative"
expected = 0.0
tolerance = 0.02
)";

const char* const slab = R"(# A falling rock strikes a small slab of reinforced concrete.
breccia = 1
method = "dem3d"
title = "Rock on a reinforced slab"

[time]
end = "1.5 ms"

[output]
frames = 15
color = "damage"

[material.c30]
use = "C30" # of the program: breccia materials C30; found with packings and links as below

[material.b500]
law = "steel"
density = "7850 kg/m3"
young = "200 GPa"
yield = "500 MPa"
hardening = "1 GPa"
failure_strain = 0.08

[material.bond]
law = "interface" # between bars and concrete

[[body]]
name = "slab"
shape = "box"
material = "c30"
size = ["360 mm", "360 mm", "100 mm"]
pack = { count = 1648, size_ratio = 2.0, compactness = 0.56 }

[[body]] # 2 mats x 2 directions x 3 bars
name = "bars"
shape = "rebar"
material = "b500"
rebar = { in = "slab", interface = "bond", diameter = "8 mm", cover = "20 mm", layers = 2, bars = 3, elements = 10 }

[[body]]
name = "rock"
shape = "sphere"
material = "c30"
center = [0.0, 0.0, "108 mm"]
radius = "57 mm"
pack = { count = 97, size_ratio = 2.0, compactness = 0.56 }
velocity = [0.0, 0.0, "-30 m/s"]

[links]
range = 1.443

[[support]]
name = "left"
on = "slab"
max = ["-160 mm", inf, inf]
fix = ["all"]

[[support]]
name = "right"
on = "slab"
min = ["160 mm", -inf, -inf]
fix = ["all"]

[[probe]]
name = "rock_velocity"
on = "rock"
quantity = "velocity_z"

[[probe]]
name = "rock_force"
on = "rock"
quantity = "force_z"
reduce = "sum"

[[check]]
name = "every joule is accounted for"
value = "energy.error_relative"
expected = 0.0
tolerance = 0.01
)";

}  // namespace

const std::vector<CaseTemplate>& case_templates() {
  static const std::vector<CaseTemplate> all{
      {"beam", "2D: a concrete beam bent over three points",
       "stress_xx, red below, and the crack that climbs; force in history.csv peaks and falls",
       beam},
      {"cylinder", "3D: a concrete cylinder crushed between walls",
       "damage at mid-height; force over place in history.csv is the load curve", cylinder},
      {"plate", "3D: a ball through a concrete plate",
       "the plug below the ball; ball_velocity in history.csv tells what the hole cost", plate},
      {"slope", "3D: loose grains run down a slope",
       "where the front stops: front in history.csv; motion goes to nothing", slope},
      {"disc", "2D: a rock disc split between platens",
       "stress_xx before, the vertical crack after; force peaks when the disc splits", disc},
      {"slab", "3D: a rock strikes reinforced concrete",
       "the punched cone (render --clip y=0); rock_force in history.csv is the blow", slab},
      {"bar", "3D, tetrahedra: a bar of rock that spalls",
       "the crack across the bar (render --view y); end_velocity in history.csv jumps as it parts",
       bar_of_tetrahedra}};
  return all;
}

const CaseTemplate& template_named(const std::string& name) {
  std::set<std::string> names;
  for (const CaseTemplate& t : case_templates()) {
    if (t.name == name) return t;
    names.insert(t.name);
  }
  throw InputError(name + " is not a template" + suggestion(name, names));
}

}  // namespace breccia::app
