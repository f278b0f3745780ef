#pragma once
// A beam of triangles, whose case tests change.

#include <string>

namespace breccia {

inline const std::string beam = R"(breccia = 1
method = "fdem2d"
[time]
end = "1 ms"
[material.stone]
young = "30 GPa"
[[body]]
name = "beam"
shape = "beam"
structured = true
material = "stone"
size = ["300 mm", "40 mm"]
mesh_size = "5 mm"
[[support]]
name = "left"
min = ["-151 mm", "-21 mm"]
max = ["-140 mm", "-19 mm"]
)";

}  // namespace breccia
