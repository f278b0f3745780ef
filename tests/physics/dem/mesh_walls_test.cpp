// Walls of triangles: against the walls that they stand for, and against closed answers where one
// element touches them at several places.

#include <gtest/gtest.h>

#include "dem/free_walls.hpp"
#include "dem/setup/wall_meshes.hpp"
#include "dem/setup/walls.hpp"
#include "physics/dem/meshes.hpp"
#include "physics/dem/scene.hpp"

namespace breccia::dem {
namespace mesh_walls_test {

using testing::box_mesh;
using testing::Corners;
using testing::quad;
using testing::Scene;

WallConfig named(const char* shape) {
  WallConfig w;
  w.name = "wall";
  w.shape = shape;
  if (w.shape == "stl") w.file = "in_the_model.stl";
  return w;
}

/// A surface in the frame of its file.
struct Held {
  WallMeshes arrays;
  explicit Held(const Corners& corners) {
    Config config;
    config.walls.push_back(named("stl"));
    Model model;
    model.wall_meshes.push_back(corners);
    arrays = wall_meshes(config, model, Space::host);
  }
  WallMesh view() const {
    const WallMeshes::Part& part = arrays.parts.at(0);
    return {arrays.nodes.view(),
            arrays.triangles.view(),
            arrays.starts.view(),
            arrays.ends.view(),
            arrays.out.view(),
            part.first,
            part.last,
            part.closed};
  }
};

TEST(MeshWalls, that_are_boxes_are_touched_as_boxes) {
  WallConfig w = named("box");
  w.size = {4.0, 2.0};
  w.length = 3.0;
  w.along = {1.0, 0.0, 0.0};
  const Wall box = wall_of(w, {});
  const Held held(box_mesh({-2.0, -1.0, -3.0}, {2.0, 1.0, 0.0}, 3));
  EXPECT_TRUE(held.view().closed);
  int outside = 0, inside = 0;
  for (int i = 0; i < 4000; ++i) {  // on a lattice that hits edges, corners and diagonals, too
    const Vec3 x{-3.0 + 0.5 * (i % 13), -2.0 + 0.5 * (i / 13 % 9), -4.0 + 0.25 * (i / 117 % 21)};
    const WallTouch expected = touch(box, x);
    const MeshTouches touches(held.view(), x, 0.9);
    if (expected.height >= 0.9 || expected.height <= -0.9) continue;
    ASSERT_EQ(touches.count, 1) << x.x << " " << x.y << " " << x.z;
    EXPECT_NEAR(touches.item[0].height, expected.height, 1e-14);
    if (expected.height <= 0.0) {  // inside several faces may be as near
      ++inside;
      continue;
    }
    EXPECT_LT(norm(touches.item[0].normal - expected.normal), 1e-12) << x.x << " " << x.y;
    ++outside;
  }
  EXPECT_GT(outside, 500);
  EXPECT_GT(inside, 100);
}

/// Two faces at right angles, an element's centre `off` from each.
TEST(MeshWalls, are_touched_once_by_each_face_of_a_groove) {
  Corners groove = quad({0.0, 0.0, 0.0}, {0.0, 4.0, 0.0}, {-3.0, 4.0, 3.0}, {-3.0, 0.0, 3.0});
  for (const Vec3& c : quad({3.0, 0.0, 3.0}, {3.0, 4.0, 3.0}, {0.0, 4.0, 0.0}, {0.0, 0.0, 0.0}))
    groove.push_back(c);
  const Held held(groove);
  EXPECT_FALSE(held.view().closed);
  const double rise = 0.8 * std::sqrt(2.0);
  const MeshTouches touches(held.view(), {0.0, 1.3, rise}, 1.0);
  ASSERT_EQ(touches.count, 2);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(touches.item[k].height, 0.8, 1e-14);
  EXPECT_NEAR(dot(touches.item[0].normal, touches.item[1].normal), 0.0, 1e-14);
  EXPECT_NEAR(touches.item[0].normal.z, std::sqrt(0.5), 1e-14);
  // From below the ridge alone.
  const MeshTouches below(held.view(), {0.0, 1.3, -0.5}, 1.0);
  ASSERT_EQ(below.count, 1);
  EXPECT_NEAR(below.item[0].normal.z, -1.0, 1e-14);
}

/// A frame around a square hole: an element that sits in it touches all four edges; one beside it
/// the face.
TEST(MeshWalls, are_touched_by_all_edges_of_a_hole) {
  const Held held(testing::frame_mesh(1.0, 3.0));
  const MeshTouches sunk(held.view(), {0.0, 0.0, 0.5}, 1.3);
  EXPECT_EQ(sunk.count, 4);
  for (int k = 0; k < sunk.count; ++k) EXPECT_NEAR(sunk.item[k].height, std::sqrt(1.25), 1e-14);
  const MeshTouches beside(held.view(), {1.7, 0.2, 0.5}, 0.6);
  ASSERT_EQ(beside.count, 1);
  EXPECT_NEAR(beside.item[0].normal.z, 1.0, 1e-14);
}

Scene thrown(const WallConfig& wall, const Vec3& from, const Vec3& velocity) {
  Scene s;
  s.material("grain", "grain", 1e9, 0.2, 2500.0);
  s.config.contact.friction = 0.4;
  s.config.contact.restitution = 0.7;
  s.config.contact.rolling_limit = 0.1;
  s.config.contact.rolling_stiffness = 0.5;
  s.sphere(from, 0.01, velocity, {3.0, -20.0, 5.0});
  s.config.walls.push_back(wall);
  s.config.time.safety = 0.1;
  s.config.time.end = 1.0;
  s.config.gravity = {0.0, 0.0, -9.81};
  return s;
}

/// A grain thrown on a floor of triangles smaller than itself slides, turns and bounces as on a
/// plane: no inner edge is felt. Without the contacts' memory it would lose its friction's spring
/// at each of them.
TEST(MeshWalls, that_are_flat_are_felt_as_planes) {
  const WallConfig plane = named("plane");
  WallConfig mesh = named("stl");
  mesh.point = {0.02, 0.01, 0.0};
  for (const bool hertz : {false, true}) {
    Scene s = thrown(plane, {0.0, 0.0, 0.0101}, {0.5, 0.2, -0.2});
    Scene t = thrown(mesh, {0.0, 0.0, 0.0101}, {0.5, 0.2, -0.2});
    t.model.wall_meshes.push_back(testing::floor_mesh(0.1, 40));
    if (hertz) s.config.contact.law = t.config.contact.law = "hertz";
    World on_plane = s.world(), on_mesh = t.world();
    while (on_plane.time < 0.08) {
      step(on_plane);
      step(on_mesh);
    }
    const ElementState &p = on_plane.elements.state.data()[0],
                       &q = on_mesh.elements.state.data()[0];
    EXPECT_GT(norm(p.position), 0.02);
    EXPECT_LT(norm(p.position - q.position), 1e-12);
    EXPECT_LT(norm(p.velocity - q.velocity), 1e-9);
    EXPECT_LT(norm(p.spin - q.spin), 1e-7);
    const EnergyBalance a = balance(on_plane), b = balance(on_mesh);
    EXPECT_NEAR(a.friction, b.friction, 1e-9 * a.friction);
    EXPECT_LT(b.error_relative, 1.01 * a.error_relative + 1e-12);
  }
}

/// A flap that turns and throws grains, and one with mass that grains push.
TEST(MeshWalls, that_move_do_as_the_box_that_they_are) {
  for (const bool free : {false, true}) {
    WallConfig box = named("box");
    box.normal = {0.3, 0.1, 1.0};
    box.along = {1.0, 0.2, 0.0};
    box.size = {0.2, 0.1};
    box.length = 0.02;
    WallConfig mesh = box;
    mesh.shape = "stl";
    mesh.file = "in_the_model.stl";
    mesh.size = {};
    mesh.length = 0.0;
    for (WallConfig* wall : {&box, &mesh}) {
      if (free) {
        wall->mass = 0.03;
        wall->free = {"x", "z"};
      } else {
        wall->spin = {1.0, -30.0, 2.0};
      }
    }
    Scene s = thrown(box, {0.04, 0.0, 0.004}, {0.0, 0.0, -1.0});
    Scene t = thrown(mesh, {0.04, 0.0, 0.004}, {0.0, 0.0, -1.0});
    for (Scene* scene : {&s, &t}) {
      scene->model.position[0].z += 0.01;
      scene->sphere({-0.07, 0.01, 0.04}, 0.01, {0.0, 0.0, -2.0});
      scene->sphere({0.12, 0.03, -0.03}, 0.015, {-2.0, 0.0, 0.0});
    }
    t.model.wall_meshes.push_back(box_mesh({-0.1, -0.05, -0.02}, {0.1, 0.05, 0.0}, 5));
    World with_box = s.world(), with_mesh = t.world();
    while (with_box.time < 0.02) {
      step(with_box);
      step(with_mesh);
    }
    for (Index e = 0; e < 3; ++e) {
      const ElementState &p = with_box.elements.state.data()[e],
                         &q = with_mesh.elements.state.data()[e];
      EXPECT_LT(norm(p.position - q.position), 1e-10) << e << free;
      EXPECT_LT(norm(p.velocity - q.velocity), 1e-8) << e << free;
    }
    EXPECT_LT(norm(with_box.walls[0].point - with_mesh.walls[0].point), 1e-10);
    const EnergyBalance a = balance(with_box), b = balance(with_mesh);
    EXPECT_GT(a.kinetic, 1e-3);
    EXPECT_NEAR(a.work, b.work, 1e-7 * a.kinetic);
    ProbeConfig torque;
    torque.name = "torque";
    torque.on = "wall";
    torque.quantity = "torque_y";
    EXPECT_NEAR(probe(with_box, torque), probe(with_mesh, torque), 1e-5);
  }
}

/// At rest in a groove of right angles each face bears m g / sqrt(2).
TEST(MeshWalls, bear_what_rests_on_them) {
  WallConfig mesh = named("stl");
  Scene s = thrown(mesh, {0.0, 0.0, 0.01 * std::sqrt(2.0)}, {});
  s.model.spin[0] = {};
  s.config.local_damping = 0.3;
  Corners groove = quad({0.0, -0.1, 0.0}, {0.0, 0.1, 0.0}, {-0.1, 0.1, 0.1}, {-0.1, -0.1, 0.1});
  for (const Vec3& c : quad({0.1, -0.1, 0.1}, {0.1, 0.1, 0.1}, {0.0, 0.1, 0.0}, {0.0, -0.1, 0.0}))
    groove.push_back(c);
  s.model.wall_meshes.push_back(groove);
  s.config.contact.friction = 0.0;
  World w = s.world();
  while (w.time < 0.02) step(w);
  const double weight = s.model.mass[0] * 9.81;
  int bearing = 0;
  for (Index i = 0; i < w.wall_contacts.size(); ++i) {
    const Vec3 force = w.wall_contacts.history.on_wall.data()[i];
    if (norm(force) == 0.0) continue;
    ++bearing;
    EXPECT_NEAR(norm(force), weight / std::sqrt(2.0), 1e-3 * weight);
    EXPECT_NEAR(force.z, -0.5 * weight, 1e-3 * weight);
  }
  EXPECT_EQ(bearing, 2);
}

/// A closed surface whose triangles are turned over is a room: an element stays in it.
TEST(MeshWalls, that_are_turned_over_hold_what_is_in_them) {
  Corners room = box_mesh({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}, 2);
  for (std::size_t t = 0; t < room.size(); t += 3) std::swap(room[t], room[t + 1]);
  Scene s = thrown(named("stl"), {0.01, 0.0, 0.0}, {3.0, 2.0, 1.0});
  s.config.contact.restitution = 1.0;
  s.model.wall_meshes.push_back(room);
  World w = s.world();
  while (w.time < 0.2) {
    step(w);
    const Vec3& x = w.elements.state.data()[0].position;
    ASSERT_LT(std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}), 0.0401);
  }
}

TEST(MeshWalls, are_refused_where_they_are_no_surface) {
  Corners good = box_mesh({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, 1);
  EXPECT_EQ(wall_mesh_problem(good), "");
  EXPECT_EQ(wall_mesh_problem({}), "it has no triangles");
  Corners turned = good;
  std::swap(turned[0], turned[1]);
  EXPECT_NE(wall_mesh_problem(turned).find("in the same direction"), std::string::npos);
  Corners flat = good;
  flat[0] = flat[1];
  EXPECT_NE(wall_mesh_problem(flat).find("triangle 0 has no area"), std::string::npos);
  WallConfig w = named("stl");
  EXPECT_TRUE(wall_problems(w).empty());
  w.file.clear();
  ASSERT_EQ(wall_problems(w).size(), 1U);
  EXPECT_EQ(wall_problems(w)[0], "wall.wall.file: a wall of shape stl needs it");
  w = named("plane");
  w.file = "a.stl";
  EXPECT_EQ(wall_problems(w).size(), 1U);
}

}  // namespace mesh_walls_test
}  // namespace breccia::dem
