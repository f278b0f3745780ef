// Bodies that are turned, cut, or have the shape of an STL file.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <set>
#include <utility>

#include "core/random.hpp"
#include "dem/observe.hpp"
#include "dem/setup/materials.hpp"
#include "dem/world.hpp"
#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "prepare/build.hpp"
#include "prepare/checks/check_bodies.hpp"
#include "prepare/shapes/carve.hpp"
#include "unit/prepare/models.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace shapes_test {

using prepare::Surface;
using Triangle = Surface::Triangle;

/// An L: the unit square without its upper right quarter, from z = 0 to 1.
std::vector<Triangle> l_shape() {
  const std::vector<Vec3> outline{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 0.5, 0.0},
                                  {0.5, 0.5, 0.0}, {0.5, 1.0, 0.0}, {0.0, 1.0, 0.0}};
  const Vec3 up{0.0, 0.0, 1.0};
  std::vector<Triangle> triangles;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec3 a = outline[k], b = outline[(k + 1) % outline.size()];
    triangles.push_back({a, b, b + up});
    triangles.push_back({a, b + up, a + up});
  }
  // A fan about the inner corner, which sees all others.
  for (std::size_t k = 4; k < 8; ++k) {
    const Vec3 a = outline[k % 6], b = outline[(k + 1) % 6];
    triangles.push_back({outline[3], b, a});
    triangles.push_back({outline[3] + up, a + up, b + up});
  }
  return triangles;
}
bool in_l_shape(const Vec3& p) {
  const auto within = [](double x, double high) { return x > 0.0 && x < high; };
  return within(p.z, 1.0) && within(p.x, 1.0) && within(p.y, 1.0) && !(p.x > 0.5 && p.y > 0.5);
}

std::string bytes_of(const std::vector<Triangle>& triangles) {
  std::string bytes(80, ' ');
  const auto count = static_cast<std::uint32_t>(triangles.size());
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  for (const Triangle& t : triangles) {
    float v[12] = {};
    for (std::size_t k = 0; k < 3; ++k) {
      v[3 * k + 3] = static_cast<float>(1000.0 * t[k].x);
      v[3 * k + 4] = static_cast<float>(1000.0 * t[k].y);
      v[3 * k + 5] = static_cast<float>(1000.0 * t[k].z);
    }
    bytes.append(reinterpret_cast<const char*>(v), sizeof v);
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string message_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

TEST(Surface, holds_what_lies_in_it_and_knows_how_deep) {
  const Surface surface(l_shape(), "L");
  EXPECT_NEAR(surface.volume(), 0.75, 1e-15);
  const Random random{3, 1};
  for (std::uint64_t i = 0; i < 5000; ++i) {
    const Vec3 p{1.4 * random.uniform(i, 0) - 0.2, 1.4 * random.uniform(i, 1) - 0.2,
                 1.4 * random.uniform(i, 2) - 0.2};
    EXPECT_EQ(surface.holds(p), in_l_shape(p)) << p.x << " " << p.y << " " << p.z;
    if (!in_l_shape(p)) continue;
    const double corner = std::sqrt(std::pow(0.5 - p.x, 2) + std::pow(0.5 - p.y, 2));
    const double to_x = p.y > 0.5 ? 0.5 - p.x : 1.0 - p.x, to_y = p.x > 0.5 ? 0.5 - p.y : 1.0 - p.y;
    double depth = std::min({p.x, p.y, p.z, 1.0 - p.z, to_x, to_y});
    if (p.x < 0.5 && p.y < 0.5) depth = std::min(depth, corner);
    EXPECT_NEAR(surface.distance(p, 10.0), depth, 1e-12);
    EXPECT_EQ(surface.distance(p, 0.01), std::min(surface.distance(p, 10.0), 0.01));
  }
  // Points over and beside vertices and edges of the mesh.
  for (const double x : {0.0, 0.25, 0.5, 1.0})
    for (const double y : {-0.2, 0.25, 0.5, 0.75, 1.1})
      EXPECT_EQ(surface.holds({x + 0.1, y + 0.1, 0.5}), in_l_shape({x + 0.1, y + 0.1, 0.5}));
}

TEST(Surface, parts_segments_that_leave_it) {
  const Surface surface(l_shape(), "L");
  EXPECT_TRUE(surface.parts({0.75, 0.4, 0.5}, {0.4, 0.75, 0.5}));  // round the inner corner
  EXPECT_FALSE(surface.parts({0.75, 0.2, 0.5}, {0.2, 0.4, 0.7}));
  EXPECT_TRUE(surface.parts({0.75, 0.4, 0.5}, {0.75, 0.4, 1.5}));
}

TEST(Surface, is_read_from_text_and_from_bytes_and_must_be_closed) {
  const ScratchFolder folder;
  const std::string path = folder / "l.stl";
  for (const std::string& content : {dem::stl_text(l_shape()), bytes_of(l_shape())}) {
    replace_file(path, content);
    const Surface surface = prepare::read_surface(path, 1e-3);
    EXPECT_NEAR(surface.volume(), 0.75, 1e-6);
    EXPECT_NEAR(surface.high().y, 1.0, 1e-7);
  }
  std::vector<Triangle> open = l_shape();
  open.pop_back();
  replace_file(path, bytes_of(open));
  const std::string message = message_of([&] { prepare::read_surface(path, 1e-3); });
  EXPECT_NE(message.find("not closed: 3 edges"), std::string::npos) << message;
  EXPECT_NE(message.find(path), std::string::npos);
  std::vector<Triangle> turned = l_shape();
  std::swap(turned[4][0], turned[4][1]);
  replace_file(path, bytes_of(turned));
  EXPECT_NE(message_of([&] { prepare::read_surface(path, 1e-3); }).find("not closed"),
            std::string::npos);
  replace_file(path, "solid a\nvertex 0 0 zero\n");
  EXPECT_NE(message_of([&] { prepare::read_surface(path, 1.0); }).find("line 2: not"),
            std::string::npos);
  replace_file(path, "x,y,z\n");
  EXPECT_NE(message_of([&] { prepare::read_surface(path, 1.0); }).find("not an STL file"),
            std::string::npos);
}

TEST(Surface, refuses_corners_that_are_nowhere) {
  const ScratchFolder folder;
  const std::string path = folder / "l.stl";
  for (const double odd : {std::nan(""), std::numeric_limits<double>::infinity(), 1e30}) {
    std::vector<Triangle> triangles = l_shape();
    triangles[4][1].y = odd;
    replace_file(path, bytes_of(triangles));
    EXPECT_NE(message_of([&] {
                prepare::read_triangles(path, 1e-3);
              }).find("triangle 4 has a corner that is no number, or farther than 1e+09 m"),
              std::string::npos)
        << odd;
    replace_file(path, dem::stl_text(triangles));
    EXPECT_NE(message_of([&] { prepare::read_triangles(path, 1e-3); }).find("line 33: not"),
              std::string::npos)
        << odd << message_of([&] { prepare::read_triangles(path, 1e-3); });
  }
}

dem::Config one_body(const dem::BodyConfig& body) {
  dem::Config config = dem::case_with_materials();
  config.bodies = {body};
  return config;
}
double mass_of(const dem::Model& model) {
  double sum = 0.0;
  for (const double m : model.mass) sum += m;
  return sum;
}

TEST(Shapes, an_stl_body_has_its_mass_and_no_link_across_its_gap) {
  const ScratchFolder folder;
  replace_file(folder / "l.stl", bytes_of(l_shape()));
  dem::BodyConfig body = dem::box_body("part", {}, 1500, 0.6);
  body.shape = "stl";
  body.file = "l.stl";
  body.file_unit = 0.2e-3;  // edges of 0.2 m
  body.center = {1.0, 2.0, 3.0};
  const dem::Config config = one_body(body);
  const dem::Model model = build_model(config, folder.path());
  const Surface surface(l_shape(), "L");
  EXPECT_NEAR(model.size(), 1500, 60);
  const double mass = config.materials[0].density * 0.75 * 0.2 * 0.2 * 0.2;
  EXPECT_NEAR(mass_of(model), mass, 0.04 * mass);
  const auto own = [&](Index e) {
    return 5.0 * (model.position[static_cast<std::size_t>(e)] - body.center);
  };
  for (Index e = 0; e < model.size(); ++e) EXPECT_TRUE(surface.holds(own(e)));
  ASSERT_GT(model.links.size(), 5000u);
  for (const auto& link : model.links)
    EXPECT_TRUE(link.parted || !surface.parts(own(link.a), own(link.b)));
}

dem::CutConfig ball(double radius) {
  dem::CutConfig cut;
  cut.shape = "sphere";
  cut.radius = radius;
  return cut;
}

/// The stiffness is measured before: turning changes nothing but places.
TEST(Shapes, a_turned_body_is_the_upright_one_elsewhere) {
  dem::BodyConfig body = dem::box_body("part", {0.1, 0.2, 0.3}, 400, 0.6);
  body.center = {0.3, -0.2, 0.1};
  body.velocity = {1.0, 2.0, 3.0};
  body.spin = {0.0, 0.0, 5.0};
  const dem::Model upright = build_model(one_body(body), "");
  body.axis = {0.0, 2.0, 0.0};
  body.across = {0.0, 1.0, 3.0};
  const dem::Model turned = build_model(one_body(body), "");
  ASSERT_EQ(turned.size(), upright.size());
  ASSERT_EQ(turned.links.size(), upright.links.size());
  EXPECT_EQ(turned.bulk.at(0).young, upright.bulk.at(0).young);
  for (std::size_t e = 0; e < upright.position.size(); ++e) {
    const Vec3 x = upright.position[e] - body.center, y = turned.position[e] - body.center;
    EXPECT_NEAR(y.z, x.x, 1e-15);  // its x points to z, its z to y, its y to x
    EXPECT_NEAR(y.x, x.y, 1e-15);
    EXPECT_NEAR(y.y, x.z, 1e-15);
    EXPECT_NEAR(turned.velocity[e].x, 1.0 - 5.0 * y.y, 1e-14);
  }
}

TEST(Shapes, frames_are_right_handed_and_turned_the_shortest_way) {
  for (const Vec3& axis : {Vec3{0.0, 0.0, 2.0}, Vec3{1.0, 0.0, 0.0}, Vec3{1.0, -2.0, 0.5},
                           Vec3{0.0, 0.0, -1.0}, Vec3{0.3, 0.2, -4.0}}) {
    const prepare::Frame3 f = prepare::frame_of(axis, {});
    const Vec3 z = (1.0 / norm(axis)) * axis;
    EXPECT_NEAR(norm(f.z - z), 0.0, 1e-15);
    EXPECT_NEAR(norm(cross(f.x, f.y) - f.z), 0.0, 1e-14);
    EXPECT_NEAR(dot(f.x, f.y), 0.0, 1e-14);
    // The axis of the turn, across both axes, stays where it is.
    const Vec3 hinge = cross(Vec3{0.0, 0.0, 1.0}, z);
    EXPECT_NEAR(norm(f.out(hinge) - hinge), 0.0, 1e-14);
    EXPECT_NEAR(norm(f.in(f.out({1.0, 2.0, 3.0})) - Vec3{1.0, 2.0, 3.0}), 0.0, 1e-14);
  }
}

TEST(Shapes, cuts_take_elements_and_links_and_leave_the_rest) {
  dem::BodyConfig body = dem::box_body("beam", {0.4, 0.1, 0.1}, 1200, 0.6);
  const dem::Model whole = build_model(one_body(body), "");
  dem::CutConfig crack;
  crack.center = {0.0, 0.0, -0.05};
  crack.size = {0.0, 0.2, 0.06};  // 30 mm deep
  dem::CutConfig hole;
  hole.shape = "cylinder";
  hole.axis = {0.0, 1.0, 0.0};
  hole.center = {0.1, 0.0, 0.0};
  hole.radius = 0.03;
  hole.length = 0.2;
  body.cuts = {crack, hole};
  const dem::Model cut = build_model(one_body(body), "");
  const auto in_hole = [](const Vec3& x) { return std::hypot(x.x - 0.1, x.z) < 0.03; };
  const auto removed = std::count_if(whole.position.begin(), whole.position.end(), in_hole);
  EXPECT_GT(removed, 50);
  EXPECT_NEAR(static_cast<double>(whole.size() - cut.size()), static_cast<double>(removed), 2.0);
  EXPECT_EQ(cut.bulk.at(0).young, whole.bulk.at(0).young);
  const double share = mass_of(cut) / mass_of(whole);
  EXPECT_NEAR(share, 1.0 - 3.14159 * 0.03 * 0.03 / 0.04, 0.01);
  std::size_t across = 0;
  for (const auto& link : cut.links) {
    const Vec3 a = cut.position[static_cast<std::size_t>(link.a)];
    const Vec3 b = cut.position[static_cast<std::size_t>(link.b)];
    if (link.parted || a.x * b.x >= 0.0) continue;
    const double height = a.z - a.x / (b.x - a.x) * (b.z - a.z);
    EXPECT_GT(height, -0.02);
    ++across;
  }
  EXPECT_GT(across, 40u);  // the ligament holds
}

TEST(Shapes, a_crack_pushes_nothing_apart) {
  for (const char* law : {"concrete", "parallel"}) {
    SCOPED_TRACE(law);
    dem::BodyConfig body = dem::box_body("cube", {0.1, 0.1, 0.1}, 500, 0.6);
    dem::CutConfig crack;
    crack.size = {0.05, 0.2, 0.0};
    body.cuts = {crack};
    dem::Config config = one_body(body);
    config.materials[0].law = law;
    const dem::Model model = build_model(config, "");
    const auto parted = std::count_if(model.links.begin(), model.links.end(),
                                      [](const dem::Model::Link& link) { return link.parted; });
    EXPECT_GT(parted, 10);  // between elements that overlap
    dem::World w = dem::make_world(config, model, {});
    EXPECT_EQ(dem::balance(w).elastic, 0.0);
    EXPECT_EQ(dem::count(w).broken_links(), parted);
    for (int step = 0; step < 50; ++step) dem::step(w);
    EXPECT_EQ(dem::balance(w).kinetic, 0.0);
    EXPECT_EQ(dem::count(w).broken_links(), parted);
  }
}

TEST(Shapes, a_bar_turns_with_its_body) {
  dem::Config config = one_body(dem::box_body("slab", {0.4, 0.3, 0.1}, 900, 0.55));
  config.bodies.push_back(dem::rebar_body("steel", "slab", 2, 10));
  const dem::Model upright = build_model(config, "");
  config.bodies[0].axis = {0.0, -1.0, 0.0};
  const dem::Model turned = build_model(config, "");
  ASSERT_EQ(turned.size(), upright.size());
  for (std::size_t e = 0; e < upright.position.size(); ++e)
    EXPECT_NEAR(turned.position[e].y, -upright.position[e].z, 1e-15);
}

TEST(Shapes, grains_of_a_body_of_ldpm_lose_their_facets_with_what_is_cut_out) {
  dem::Config config = dem::case_with_materials();
  config.materials[0].law = "ldpm";
  config.materials[0].mix.smallest = 0.01;
  config.materials[0].mix.largest = 0.02;
  dem::BodyConfig body = dem::box_body("cube", {0.1, 0.1, 0.1}, 0, 0.6);
  config.bodies = {body};
  const dem::Model whole = build_model(config, "");
  dem::CutConfig notch;
  notch.center = {0.0, 0.0, -0.05};
  notch.size = {0.004, 0.2, 0.04};
  config.bodies[0].cuts = {notch};
  config.bodies[0].axis = {1.0, 0.0, 0.0};
  const dem::Model cut = build_model(config, "");
  EXPECT_LT(cut.facets.size(), whole.facets.size());
  EXPECT_GT(cut.facets.size(), whole.facets.size() / 2);
  std::size_t links = 0;
  for (const auto& link : cut.links) {
    ASSERT_EQ(link.facet, static_cast<Index>(links++));
    const auto& facet = cut.facets[static_cast<std::size_t>(link.facet)];
    EXPECT_EQ(facet.a, link.a);
    EXPECT_EQ(facet.b, link.b);
    const Vec3 middle = 0.5 * (cut.position[static_cast<std::size_t>(link.a)] +
                               cut.position[static_cast<std::size_t>(link.b)]);
    EXPECT_LT(norm(facet.center - middle), 0.02);
  }
  EXPECT_EQ(links, cut.facets.size());
}

/// Spheres on both sides of a crack would push it open at once.
TEST(Shapes, grains_of_ldpm_on_both_sides_of_a_crack_do_not_overlap) {
  dem::Config config = dem::case_with_materials();
  config.materials[0].law = "ldpm";
  config.materials[0].mix.smallest = 0.01;
  config.materials[0].mix.largest = 0.02;
  config.bodies = {dem::box_body("cube", {0.1, 0.1, 0.1}, 0, 0.6)};
  dem::CutConfig crack;
  crack.size = {0.06, 0.2, 0.0};
  config.bodies[0].cuts = {crack};
  const dem::Model model = build_model(config, "");
  std::set<std::pair<Index, Index>> edges;
  for (const auto& link : model.links) edges.insert(std::minmax(link.a, link.b));
  int across = 0;
  for (Index a = 0; a < model.size(); ++a)
    for (Index b = a + 1; b < model.size(); ++b) {
      if (edges.contains({a, b})) continue;
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
      const double apart = norm(model.position[i] - model.position[j]);
      EXPECT_GE(apart, (1.0 - 1e-12) * (model.radius[i] + model.radius[j]));
      if (model.position[i].z * model.position[j].z < 0.0 && apart < 0.02) ++across;
    }
  EXPECT_GT(across, 10);
}

TEST(Shapes, wrong_ones_are_told_by_key) {
  dem::BodyConfig body = dem::box_body("part", {0.1, 0.1, 0.1}, 100, 0.6);
  const auto problems = [&](const std::function<void(dem::BodyConfig&)>& change) {
    dem::Config config = one_body(body);
    change(config.bodies[0]);
    std::string all;
    for (const std::string& problem : prepare::body_problems(config)) all += problem + "\n";
    return all;
  };
  EXPECT_EQ(problems([](dem::BodyConfig&) {}), "");
  EXPECT_EQ(problems([](dem::BodyConfig& b) { b.axis = {}; }), "body.part.axis is no direction\n");
  EXPECT_EQ(problems([](dem::BodyConfig& b) {
              b.across = {0.0, 0.0, 1.0};
            }),
            "body.part.across lies along axis: it says nothing of how the body is turned\n");
  EXPECT_EQ(problems([](dem::BodyConfig& b) { b.shape = "stl"; }),
            "body.part.file is missing: an STL file\n");
  EXPECT_EQ(problems([](dem::BodyConfig& b) { b.cuts.emplace_back(); }),
            "body.part.cut[0].size needs two lengths above 0, or three\n");
  EXPECT_EQ(problems([](dem::BodyConfig& b) { b.cuts.push_back(ball(0.0)); }),
            "body.part.cut[0].radius must be above 0\n");
  dem::Config config = one_body(body);
  config.bodies[0].cuts.push_back(ball(1.0));
  EXPECT_NE(message_of([&] { build_model(config, ""); }).find("body.part: nothing is left"),
            std::string::npos);
}

}  // namespace shapes_test
}  // namespace breccia
