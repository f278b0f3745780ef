// Bars in bodies of an STL surface, and in unions: where they lie, which do not fit, what they are
// bonded to.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/random.hpp"
#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "prepare/build.hpp"
#include "prepare/checks/check_case.hpp"
#include "prepare/packing/packing.hpp"
#include "prepare/packing/rebar.hpp"
#include "prepare/shapes/solid.hpp"
#include "prepare/shapes/surface.hpp"
#include "unit/prepare/models.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia::dem {
namespace bars_in_shapes_test {

using prepare::Surface;
using Triangle = Surface::Triangle;

/// An angle, upright along z from 0 to `height`: a square of edge 2 `leg` with a corner at the
/// origin, without its quarter away from there. Edges in m.
std::vector<Triangle> angle(double leg, double height) {
  const double a = leg, b = 2.0 * leg;
  const std::vector<Vec3> outline{{0.0, 0.0, 0.0}, {b, 0.0, 0.0}, {b, a, 0.0},
                                  {a, a, 0.0},     {a, b, 0.0},   {0.0, b, 0.0}};
  const Vec3 up{0.0, 0.0, height};
  std::vector<Triangle> triangles;
  for (std::size_t k = 0; k < 6; ++k) {
    const Vec3 p = outline[k], q = outline[(k + 1) % 6];
    triangles.push_back({p, q, q + up});
    triangles.push_back({p, q + up, p + up});
  }
  for (std::size_t k = 4; k < 8; ++k) {  // fans about the inner corner
    const Vec3 p = outline[k % 6], q = outline[(k + 1) % 6];
    triangles.push_back({outline[3], q, p});
    triangles.push_back({outline[3] + up, p + up, q + up});
  }
  return triangles;
}

TEST(Surface, knows_where_a_segment_is_nearest_to_it) {
  const Surface surface(angle(0.5, 1.0), "angle");
  const auto along_x = surface.clearance({0.75, 0.2, 0.5}, {0.3, 0.2, 0.5}, 10.0);
  EXPECT_NEAR(along_x.distance, 0.2, 1e-15);
  const auto round_corner = surface.clearance({0.4, 0.3, 0.5}, {0.3, 0.4, 0.5}, 10.0);
  EXPECT_NEAR(round_corner.distance, 0.15 * std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(round_corner.at.x, 0.35, 1e-15);
  EXPECT_EQ(surface.clearance({0.4, 0.3, 0.5}, {0.3, 0.4, 0.5}, 0.1).distance, 0.1);
  const auto out = surface.clearance({0.75, 0.25, 0.5}, {0.25, 0.75, 0.5}, 10.0);
  EXPECT_NEAR(out.distance, 0.0, 1e-15) << "it touches the inner edge";
  EXPECT_EQ(surface.clearance({0.75, 0.4, 0.5}, {0.4, 0.75, 0.5}, 10.0).distance, 0.0);
  EXPECT_EQ(surface.clearance({0.75, 0.4, 0.5}, {0.75, 0.4, 1.5}, 10.0).distance, 0.0);
  // Never more than at any of its points, and as much as at one of many.
  const Random random{5, 2};
  for (std::uint64_t i = 0; i < 300; ++i) {
    const auto corner = [&](std::uint32_t first) {
      return Vec3{0.5 * random.uniform(i, first), random.uniform(i, first + 1),
                  random.uniform(i, first + 2)};
    };
    const Vec3 a = corner(0), b = corner(3);  // in one leg
    const double found = surface.clearance(a, b, 10.0).distance;
    double least = 10.0;
    constexpr int points = 500;
    for (int k = 0; k <= points; ++k)
      least = std::min(least, surface.distance(a + (1.0 * k / points) * (b - a), 10.0));
    EXPECT_LE(found, least + 1e-12);
    EXPECT_GE(found, least - 0.5 * norm(b - a) / points);
    EXPECT_NEAR(surface.distance(surface.clearance(a, b, 10.0).at, 10.0), found, 1e-12);
  }
}

BarConfig bar(const std::vector<Vec3>& points) {
  BarConfig one;
  one.points = points;
  return one;
}

/// An angle of legs 40 mm thick and 80 mm wide, 0.2 m high, with an upright bar in its corner and
/// two stirrups, one in each leg.
class AngleWithBars : public ::testing::Test {
 protected:
  AngleWithBars() {
    replace_file(folder_ / "angle.stl", stl_text(angle(0.04, 0.2)));
    config_ = case_with_materials();
    BodyConfig part = box_body("part", {}, 1500, 0.55);
    part.shape = "stl";
    part.file = "angle.stl";
    part.file_unit = 1e-3;
    part.center = {1.0, 2.0, 3.0};
    BodyConfig cage = rebar_body("cage", "part", 0, 0);
    cage.rebar.diameter = 8e-3;
    cage.rebar.drawn = {
        bar({{0.02, 0.02, 0.01}, {0.02, 0.02, 0.19}}),
        bar({{0.008, 0.03, 0.1}, {0.008, 0.07, 0.1}, {0.032, 0.07, 0.1}, {0.032, 0.03, 0.1}})};
    cage.rebar.drawn[1].closed = true;
    cage.rebar.drawn[1].mark = "stirrup";
    cage.rebar.drawn[1].diameter = 6e-3;
    config_.bodies = {part, cage};
    config_.links.range = 1.443;
  }
  RebarConfig& rebar() { return config_.bodies[1].rebar; }
  /// Of checks that read files.
  std::string problem() const {
    try {
      check_case(config_);
      prepare::check_files(config_, folder_.path());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::string refusal() const {
    try {
      build_model(config_, folder_.path());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  ScratchFolder folder_;
  Config config_;
};

TEST_F(AngleWithBars, they_lie_in_the_frame_of_the_file_and_are_bonded_to_what_is_left) {
  ASSERT_EQ(problem(), "");
  const Model m = build_model(config_, folder_.path());
  const Surface surface(angle(0.04, 0.2), "angle");
  const Vec3 origin{1.0, 2.0, 3.0};
  const auto chains = prepare::chains_through(rebar(), {});
  std::vector<int> bonds(m.position.size(), 0);
  for (const Model::Link& link : m.links)
    if (link.kind == LinkKind::interface)
      for (const Index e : {link.a, link.b}) ++bonds[static_cast<std::size_t>(e)];
  std::size_t elements = 0;
  double steel = 0.0, concrete = 0.0;
  for (std::size_t e = 0; e < m.position.size(); ++e) {
    const Vec3 own = m.position[e] - origin;
    EXPECT_TRUE(surface.holds(own));
    (m.group[e] == 1 ? steel : concrete) += m.mass[e];
    if (m.group[e] == 0) {
      for (const auto& chain : chains)
        for (const auto& part : chain.segments)
          EXPECT_GE(norm(prepare::from_axis(part, own)),
                    part.radius + (1.0 - 2.0 * prepare::overlap_tolerance) * m.radius[e]);
      continue;
    }
    ++elements;
    EXPECT_GE(bonds[e], 4);
    double nearest = 1.0;
    for (const auto& chain : chains)
      for (const Vec3& centre : chain.centres) nearest = std::min(nearest, norm(centre - own));
    EXPECT_LT(nearest, 1e-12);
  }
  std::size_t drawn = 0;
  for (const auto& chain : chains) drawn += chain.centres.size();
  EXPECT_EQ(elements, drawn);
  const double volume = prepare::bars_volume(chains);
  EXPECT_NEAR(steel, 7850.0 * volume, 1e-9);
  EXPECT_NEAR(concrete, 2400.0 * (surface.volume() - volume), 0.04 * 2400.0 * surface.volume());
}

TEST_F(AngleWithBars, they_turn_with_it) {
  const Model upright = build_model(config_, folder_.path());
  config_.bodies[0].axis = {1.0, 0.0, 0.0};
  config_.bodies[0].spin = {0.0, 0.0, 2.0};
  const Model turned = build_model(config_, folder_.path());
  ASSERT_EQ(turned.size(), upright.size());
  for (std::size_t e = 0; e < upright.position.size(); ++e) {
    const Vec3 x = upright.position[e] - Vec3{1.0, 2.0, 3.0};
    const Vec3 y = turned.position[e] - Vec3{1.0, 2.0, 3.0};
    EXPECT_NEAR(y.x, x.z, 1e-15);
    EXPECT_NEAR(turned.velocity[e].y, 2.0 * y.x, 1e-15);
  }
}

/// Of coarse elements few are near a bar, and those beyond the inner face go.
TEST_F(AngleWithBars, they_are_bonded_to_four_elements_that_stay) {
  config_.bodies[0].pack.count = 150;
  rebar().drawn.resize(1);
  rebar().drawn[0].points = {{0.034, 0.06, 0.01}, {0.034, 0.06, 0.19}};
  const Model m = build_model(config_, folder_.path());
  std::vector<int> bonds(m.position.size(), 0);
  for (const Model::Link& link : m.links)
    if (link.kind == LinkKind::interface)
      for (const Index e : {link.a, link.b}) ++bonds[static_cast<std::size_t>(e)];
  for (std::size_t e = 0; e < m.position.size(); ++e)
    if (m.group[e] == 1) {
      EXPECT_GE(bonds[e], 4);
    }
}

TEST_F(AngleWithBars, particles_of_ldpm_hold_them_too) {
  config_.materials[0].law = "ldpm";
  config_.materials[0].mix.smallest = 8e-3;
  config_.materials[0].mix.largest = 16e-3;
  config_.bodies[0].pack = {};
  ASSERT_EQ(problem(), "");
  const Model m = build_model(config_, folder_.path());
  std::vector<int> bonds(m.position.size(), 0);
  for (const Model::Link& link : m.links)
    if (link.kind == LinkKind::interface)
      for (const Index e : {link.a, link.b}) ++bonds[static_cast<std::size_t>(e)];
  int elements = 0;
  for (std::size_t e = 0; e < m.position.size(); ++e)
    if (m.group[e] == 1) {
      ++elements;
      EXPECT_GE(bonds[e], 4);
    }
  EXPECT_GT(elements, 20);
}

TEST_F(AngleWithBars, what_does_not_lie_in_the_surface_is_refused_with_its_place) {
  const auto expect = [&](const std::string& part) {
    EXPECT_NE(problem().find("body.cage.rebar: " + part), std::string::npos) << problem();
    EXPECT_NE(refusal().find("body.cage.rebar: " + part), std::string::npos) << refusal();
  };
  rebar().drawn[0].points[1] = {0.02, 0.02, 0.197};  // 3 mm below the upper face
  expect(
      "bar 1 is not inside the body at (0.02, 0.02, 0.197) m of it: its axis must lie half a "
      "diameter, 0.004 m, below the faces");
  rebar().drawn[0].points[1] = {0.02, 0.02, 0.196};
  EXPECT_EQ(problem(), "");
  rebar().drawn[0].points[1] = {0.06, 0.06, 0.1};  // in the quarter that is missing
  expect("bar 1 is not inside the body at (0.04, 0.04,");
  rebar().drawn[0].points = {{0.06, 0.06, 0.1}, {0.06, 0.06, 0.15}};
  expect("bar 1 is not inside the body at (0.06, 0.06, 0.1) m");
  rebar().drawn[0].points = {{0.07, 0.02, 0.02}, {0.02, 0.07, 0.02}};  // across the inner edge
  expect("bar 1 is not inside the body at (0.");
  rebar().drawn[0].points = {{0.066, 0.008, 0.02}, {0.008, 0.066, 0.02}};
  EXPECT_EQ(problem(), "") << "4.2 mm from the inner edge";
}

TEST_F(AngleWithBars, mats_have_no_place_in_it) {
  rebar().drawn.clear();
  EXPECT_NE(problem().find("body.cage.rebar.in = \"part\" is a body of shape stl: mats of bars lie "
                           "in boxes; in other bodies bars are drawn one by one"),
            std::string::npos)
      << problem();
}

/// A beam of T section: a web below, a flange above, upright in a case that holds it turned by a
/// right angle about z.
Config t_beam() {
  Config config = case_with_materials();
  BodyConfig web = box_body("beam", {0.3, 0.04, 0.1}, 900, 0.55);
  web.center = {1.0, 0.0, 0.0};
  web.axis = {0.0, 0.0, 1.0};
  web.across = {0.0, 1.0, 0.0};  // its x is the y of the case
  CutConfig flange;
  flange.size = {0.18, 0.3, 0.03};
  flange.center = {1.02, 0.0, 0.065};  // the box around both has another middle
  web.joins = {flange};
  BodyConfig cage = rebar_body("cage", "beam", 0, 0);
  cage.rebar.diameter = 8e-3;
  cage.rebar.drawn = {bar({{-0.14, 0.0, -0.04}, {0.14, 0.0, -0.04}}),
                      bar({{-0.13, -0.06, 0.07}, {-0.13, 0.06, 0.07}}),
                      bar({{0.05, 0.01, -0.03}, {0.05, 0.01, 0.07}})};  // through both
  cage.rebar.drawn[1].copies = 3;
  cage.rebar.drawn[1].step = {0.13, 0.0, 0.0};
  config.bodies = {web, cage};
  config.links.range = 1.443;
  return config;
}
TEST(Rebar, lies_in_a_body_with_joins_and_passes_from_one_solid_to_the_next) {
  Config config = t_beam();
  config.bodies[0].spin = {0.0, 0.0, 2.0};
  ASSERT_EQ(problem_of(config), "");
  const Model m = build_model(config, "");
  const prepare::Union whole(config.bodies[0]);
  double longest = 0.0;
  int elements = 0;
  for (std::size_t e = 0; e < m.position.size(); ++e) {
    EXPECT_GT(whole.depth(m.position[e]), -1e-12);
    EXPECT_NEAR(m.velocity[e].y, 2.0 * (m.position[e].x - 1.0), 1e-12);
    if (m.group[e] != 1) continue;
    ++elements;
    if (std::abs(m.position[e].z + 0.04) < 1e-12) {
      EXPECT_NEAR(m.position[e].x, 1.0, 1e-12);
      longest = std::max(longest, std::abs(m.position[e].y));
    }
  }
  EXPECT_NEAR(longest, 0.14, 1e-12);
  EXPECT_GT(elements, 18 + 3 * 8 + 6);
}

TEST(Rebar, that_leaves_a_body_with_joins_is_refused) {
  Config config = t_beam();
  auto& drawn = config.bodies[1].rebar.drawn;
  drawn[1].points[1].y = 0.067;
  EXPECT_NE(
      problem_of(config).find("bar 2 (copy 1) is not inside the body at (-0.13, 0.067, 0.07)"),
      std::string::npos)
      << problem_of(config);
  config = t_beam();
  config.bodies[1].rebar.drawn[1].points = {{0.0, -0.05, 0.07}, {0.0, 0.05, 0.045}};
  EXPECT_NE(problem_of(config).find("bar 2 (copy 1) is not inside the body"), std::string::npos);
  config = t_beam();
  config.bodies[1].rebar.drawn[1].points = {{0.0, -0.05, 0.07},
                                            {0.1, 0.0, -0.04}};  // over the edge
  EXPECT_NE(problem_of(config).find("bar 2 (copy 1) is not inside the body"), std::string::npos);
  config = t_beam();
  config.bodies[1].rebar.drawn.clear();
  EXPECT_NE(problem_of(config).find("is a body of shape box with joins: mats of bars lie in boxes"),
            std::string::npos)
      << problem_of(config);
}

}  // namespace bars_in_shapes_test
}  // namespace breccia::dem
