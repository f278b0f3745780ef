#pragma once
// Result folders as runs leave them, small enough to know every number.

#include <fmt/format.h>

#include <fstream>
#include <string>
#include <vector>

#include "io/vtu/paraview.hpp"

namespace breccia::test {

inline void write_text(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
}

inline const std::string chain_case = R"(
title = "a chain </script><b>pulled</b>"
[output]
color = "damage"
view = "y"
[material.c30]
law = "concrete"
tensile_strength = 2e6
[material.b500]
law = "steel"
tensile_strength = 1.0
[[body]]
name = "chain"
material = "c30"
[[body]]
name = "ball"
material = "b500"
[[wall]]
name = "floor"
point = [0.0, 0.0, -0.1]
normal = [0.0, 0.0, 1.0]
velocity = [0.0, 0.0, 2.0]
[[support]]
name = "held"
min = [-inf, -1.0, -1.0]
max = [0.0, 1.0, 1.0]
)";

/// Frame k of a chain of `count` spheres along x, 20 mm apart, that is stretched by 1 % a frame.
/// From frame `breaks_at` on the link in its middle is broken, and the right half has flown off.
inline Frame chain_frame(int k, int count, int breaks_at) {
  Frame frame;
  frame.step = 10 * k;
  frame.time = 1e-3 * k;
  frame.groups = {"chain", "ball"};
  FrameField velocity{"velocity", "m/s", 3, {}}, group{"group", "-", 1, {}},
      damage{"damage", "-", 1, {}};
  FrameField kind{"kind", "-", 1, {}}, state{"state", "-", 1, {}}, force{"force", "N", 1, {}};
  const bool broken = k >= breaks_at;
  for (int i = 0; i < count; ++i) {
    const double x = 0.02 * i * (1.0 + 0.01 * k) + (broken && 2 * i >= count ? 0.05 : 0.0);
    frame.position.push_back({x, 0.001 * (i % 3), 0.0});
    frame.radius.push_back(0.01);
    for (const double v : {2.0 * i, -1.0, 0.0}) velocity.values.push_back(static_cast<float>(v));
    group.values.push_back(i + 1 == count ? 1.0F : 0.0F);
    damage.values.push_back(broken ? 0.25F : 0.0F);
    if (i + 1 == count) continue;
    frame.lines.insert(frame.lines.end(), {i, i + 1});
    kind.values.push_back(0.0F);
    state.values.push_back(broken && i + 1 == count / 2 ? 2.0F : 0.0F);
    // At most half of what a link of 2 MPa and this radius bears.
    force.values.push_back(static_cast<float>(0.25 * k * 2e6 * 3.14159265358979 * 1e-4));
  }
  frame.point_fields = {velocity, group, damage};
  frame.line_fields = {kind, state, force};
  return frame;
}

/// The folder of a chain's run of 3 frames.
inline void write_chain(const std::string& folder, int count = 8, int breaks_at = 2) {
  ParaviewSeries series(folder);
  for (int k = 0; k < 3; ++k) series.write(chain_frame(k, count, breaks_at));
  series.finish();
  const int broken = breaks_at < 3 ? 1 : 0;
  write_text(folder + "/summary.json",
             fmt::format(R"({{"status": "done", "exit_code": 0, "message": "",
  "case": {{"name": "chain", "sha256": "ab", "seed": 7}}, "method": "dem3d",
  "model": {{"elements": {}, "links": {}}}, "steps": 20, "time": 0.002,
  "energy": {{"fracture": {}}}, "state_hash": "00ff",
  "fracture": {{"broken_links": {}, "fragments": {}, "largest_fragment_fraction": 0.5}}}})",
                         count, count - 1, broken == 0 ? 0.0 : 1.5, broken, broken + 1));
  write_text(folder + "/case.toml", chain_case);
  write_text(folder + "/history.csv",
             "step,time,dt,kinetic,elastic,fracture,error_relative,\"pull, right\"\n"
             "-,s,s,J,J,J,-,N\n0,0,1e-4,0,0,0,0,0\n10,0.001,1e-4,1,2,0,0,4000\n"
             "20,0.002,1e-4,2,1,1.5,0,1000\n");
  write_text(folder + "/log.jsonl",
             "{\"level\":\"info\",\"message\":\"starts\"}\n"
             "{\"level\":\"warning\",\"message\":\"2 % of the energy is missing\"}\n");
}

/// Two triangles that share an edge and part by `gap` [m]; from then on there is a line between.
inline Frame pair_frame(int k, double gap) {
  Frame frame;
  frame.step = k;
  frame.time = 1e-3 * k;
  frame.groups = {"rock"};
  frame.position = {{0, 0, 0},   {0.1, 0, 0},         {0, 0.1, 0},
                    {0.1, 0, 0}, {0.1 + gap, 0.1, 0}, {gap, 0.1, 0}};
  frame.position[3].x += gap;
  frame.triangles = {0, 1, 2, 3, 4, 5};
  frame.triangle_fields = {{"stress_xx", "Pa", 1, {1e6F, -2e6F}},
                           {"stress_yy", "Pa", 1, {0.0F, 0.0F}},
                           {"stress_xy", "Pa", 1, {0.0F, 0.0F}},
                           {"group", "-", 1, {0.0F, 0.0F}},
                           {"material", "-", 1, {0.0F, 0.0F}}};
  FrameField velocity{"velocity", "m/s", 3, std::vector<float>(18, 0.0F)};
  velocity.values[0] = 3.0F;  // of one corner
  frame.line_fields = {{"mode", "-", 1, {}}, {"damage", "-", 1, {}}, {"time", "s", 1, {}}};
  if (gap > 0.0) {
    frame.position.push_back({0.1 + 0.5 * gap, 0, 0});
    frame.position.push_back({0.5 * gap, 0.1, 0});
    velocity.values.resize(24, 0.0F);
    frame.lines = {6, 7};
    const std::vector<float> values{0.0F, 1.0F, 1e-3F};
    for (std::size_t f = 0; f < 3; ++f) frame.line_fields[f].values = {values[f]};
  }
  frame.point_fields = {velocity};
  return frame;
}

}  // namespace breccia::test
