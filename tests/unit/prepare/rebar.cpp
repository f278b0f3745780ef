// Bars that users draw: where their elements lie, what they weigh, how they are joined, and which
// do not fit.

#include "prepare/packing/rebar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "exec/error.hpp"
#include "math/constants.hpp"
#include "prepare/build.hpp"
#include "prepare/checks/check_case.hpp"
#include "run/case_keys.hpp"
#include "unit/prepare/models.hpp"

namespace breccia::dem {
namespace rebar_test {

BarConfig stirrup(double x, double y, double z) {
  BarConfig bar;
  bar.mark = "stirrup";
  bar.points = {{x, -y, -z}, {x, y, -z}, {x, y, z}, {x, -y, z}};
  bar.closed = true;
  bar.diameter = 6e-3;
  return bar;
}

BarConfig straight(const Vec3& a, const Vec3& b) {
  BarConfig bar;
  bar.points = {a, b};
  return bar;
}

/// A beam with two bars below and five stirrups around them.
Config beam() {
  Config config = case_with_materials();
  BodyConfig cage = rebar_body("cage", "beam", 0, 0);
  cage.rebar.diameter = 0.01;
  cage.rebar.spacing = 0.02;
  cage.rebar.drawn = {straight({-0.18, -0.03, -0.04}, {0.18, -0.03, -0.04}),
                      stirrup(-0.15, 0.04, 0.05)};
  cage.rebar.drawn[0].copies = 2;
  cage.rebar.drawn[0].step = {0.0, 0.06, 0.0};
  cage.rebar.drawn[1].copies = 5;
  cage.rebar.drawn[1].step = {0.075, 0.0, 0.0};
  config.bodies = {box_body("beam", {0.4, 0.12, 0.14}, 900, 0.52), cage};
  config.bodies[0].center = {1.0, 2.0, 3.0};
  config.links.range = 1.4;
  return config;
}

TEST(Rebar, as_it_is_drawn_has_an_element_at_each_corner_and_the_weight_of_its_length) {
  const Model m = build_model(beam(), ".");
  const double straight_area = pi * 1e-4 / 4.0, ring_area = pi * 36e-6 / 4.0;
  const double around = 2.0 * (0.08 + 0.1);
  double steel = 0.0, concrete = 0.0;
  int ends = 0, corners = 0, elements = 0;
  std::vector<int> bonds(m.position.size(), 0);
  for (const Model::Link& link : m.links)
    if (link.kind == LinkKind::interface)
      for (const Index e : {link.a, link.b}) ++bonds[static_cast<std::size_t>(e)];
  for (std::size_t e = 0; e < m.position.size(); ++e) {
    (m.group[e] == 1 ? steel : concrete) += m.mass[e];
    if (m.group[e] != 1) continue;
    ++elements;
    const bool end = m.bar_previous[e] < 0 || m.bar_next[e] < 0;
    ends += end ? 1 : 0;
    EXPECT_GE(bonds[e], 4);
    const Vec3 x = m.position[e] - Vec3{1.0, 2.0, 3.0};
    if (std::fabs(std::fabs(x.y) - 0.04) < 1e-12 && std::fabs(std::fabs(x.z) - 0.05) < 1e-12)
      ++corners;
    if (!end) continue;
    EXPECT_NEAR(std::fabs(x.x), 0.18, 1e-12);
    EXPECT_EQ(m.radius[e], 5e-3);
  }
  EXPECT_EQ(elements, 2 * 19 + 5 * (2 * 4 + 2 * 5));
  EXPECT_EQ(ends, 4) << "stirrups have no end";
  EXPECT_EQ(corners, 5 * 4);
  const double volume = 2.0 * 0.36 * straight_area + 5.0 * around * ring_area;
  EXPECT_NEAR(steel, 7850.0 * volume, 1e-9);
  EXPECT_NEAR(concrete, 2400.0 * (0.4 * 0.12 * 0.14 - volume), 1e-9);
}

TEST(Rebar, leaves_room_in_a_cylinder_for_a_ring_and_an_upright_bar) {
  Config config = beam();
  config.bodies[0] = box_body("beam", {}, 600, 0.5);
  config.bodies[0].shape = "cylinder";
  config.bodies[0].radius = 0.08;
  config.bodies[0].length = 0.2;
  BarConfig ring;
  for (int k = 0; k < 8; ++k)
    ring.points.push_back({0.05 * std::cos(k * pi / 4.0), 0.05 * std::sin(k * pi / 4.0), 0.02});
  ring.closed = true;
  config.bodies[1].rebar.drawn = {ring, straight({0.0, 0.03, -0.09}, {0.0, 0.03, 0.09})};
  const Model m = build_model(config, ".");
  const auto chains = prepare::chains_through(config.bodies[1].rebar, {});
  double deepest = 0.0;
  for (std::size_t e = 0; e < m.position.size(); ++e)
    for (const auto& chain : chains)
      for (const auto& part : chain.segments)
        if (m.group[e] == 0)
          deepest = std::max(
              deepest, (m.radius[e] + part.radius - norm(prepare::from_axis(part, m.position[e]))) /
                           m.radius[e]);
  EXPECT_LE(deepest, prepare::overlap_tolerance);
}

TEST(Rebar, of_a_mat_may_have_other_numbers_of_bars_each_way) {
  RebarConfig rebar;
  rebar.bars_x = 3;
  rebar.bars_y = 5;
  rebar.layers = 1;
  const auto bars = prepare::bars_through(rebar, {0.5, 0.3, 0.1});
  int along_x = 0;
  for (const auto& bar : bars) along_x += bar.a.y == bar.b.y ? 1 : 0;
  EXPECT_EQ(along_x, 3);
  EXPECT_EQ(bars.size(), 8U);
}

TEST(Rebar, in_a_body_of_another_shape_is_refused_with_the_shapes_that_there_are) {
  Config config = beam();
  config.bodies[0].shape = "element";
  config.bodies[0].radius = 0.08;
  EXPECT_NE(
      problem_of(config).find("rebar.in = \"beam\" is a body of shape element: bars lie in bodies "
                              "of shape box, cylinder, sphere, stl or file"),
      std::string::npos)
      << problem_of(config);
  config.bodies[0] = box_body("beam", {}, 600, 0.5);
  config.bodies[0].shape = "cylinder";
  config.bodies[0].radius = 0.08;
  config.bodies[0].length = 0.2;
  config.bodies[1].rebar.drawn.clear();
  EXPECT_NE(problem_of(config).find(
                "rebar.in = \"beam\" is a body of shape cylinder: mats of bars lie in boxes"),
            std::string::npos)
      << problem_of(config);
}

TEST(Rebar, that_does_not_fit_is_refused_with_its_place) {
  const auto with = [](const std::function<void(RebarConfig&)>& change) {
    Config config = beam();
    change(config.bodies[1].rebar);
    return problem_of(config);
  };
  const auto expect = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  EXPECT_EQ(problem_of(beam()), "");
  expect(with([](RebarConfig& r) { r.drawn[0].points[1].x = 0.196; }),
         "bar 1 (copy 1) is not inside the body at (0.196, -0.03, -0.04) m of it");
  expect(with([](RebarConfig& r) { r.drawn[1].step.x = 0.1; }), "stirrup (copy 5) is not inside");
  expect(with([](RebarConfig& r) { r.drawn[0].points[1].z = -0.052; }),
         "bar 1 (copy 1) and stirrup");
  expect(with([](RebarConfig& r) { r.drawn[1].step.x = 0.005; }),
         "stirrup (copy 1) and stirrup (copy 2) come as near as 0.005 m");
  expect(with([](RebarConfig& r) { r.spacing = 4e-3; }), "which overlap");
  expect(with([](RebarConfig& r) { r.drawn[1].points.resize(2); }), "has 2 points; it needs 3");
  Config two = beam();
  two.bodies.push_back(two.bodies[1]);
  two.bodies[2].name = "again";
  expect(problem_of(two), "body.again.rebar: with body.cage: bar 1 (copy 1) and bar 1 (copy 1)");
}

TEST(Rebar, is_read_from_a_case_with_its_points) {
  const Config config = read_case<Config>(CaseText{R"(breccia = 1
method = "dem3d"
[time]
end = 1.0
[[body]]
name = "cage"
shape = "rebar"
material = "b500"
[body.rebar]
in = "beam"
interface = "bond"
[[body.rebar.bar]]
points = [[0.0, 0.0, "5 mm"], [1.0, 0.5, 0.0], [1.0, 0.0, 0.0]]
closed = true
)",
                                                   "cage.toml"},
                                          {});
  const auto& drawn = config.bodies.at(0).rebar.drawn;
  ASSERT_EQ(drawn.size(), 1U);
  ASSERT_EQ(drawn[0].points.size(), 3U);
  EXPECT_EQ(drawn[0].points[0].z, 5e-3);
  EXPECT_EQ(drawn[0].points[1].y, 0.5);
  EXPECT_TRUE(drawn[0].closed);
  const Config again = read_case<Config>(CaseText{completed_case(config), "completed.toml"}, {});
  EXPECT_EQ(again.bodies.at(0).rebar.drawn.at(0).points[2].x, 1.0);
}

}  // namespace rebar_test
}  // namespace breccia::dem
