// A joint between two triangles: forces on its nodes, work, break, both sides alike.

#include <gtest/gtest.h>

#include "fdem/stepping/step.hpp"
#include "physics/fdem/scene.hpp"

namespace breccia::fdem {
namespace joint_test {

using testing::nodes;
using testing::Scene;

/// Triangle A stands on the joint, from (0, 0) to (1 mm, 0), B hangs under it. The side with the
/// lower number is side a of the joint.
Scene two_triangles(bool a_first = true) {
  Scene scene;
  MaterialConfig& m = scene.material(30e9);
  m.joints = "intrinsic";
  m.joint.stiffness = 5.0;
  m.joint.tension = 3e6;
  m.joint.cohesion = 15e6;
  m.joint.friction_angle = std::atan(0.7);
  m.joint.energy_open = 10.0;
  m.joint.energy_slide = 50.0;
  scene.config.joints.softening_factor = 3.0;
  scene.config.joints.criterion = "edge";  // as in the classical codes
  prepare::Mesh mesh;
  mesh.point = {{0.0, 0.0}, {1e-3, 0.0}, {0.5e-3, 0.8e-3}, {0.5e-3, -0.8e-3}};
  mesh.triangle = {{0, 1, 2}, {0, 3, 1}};
  if (!a_first) std::swap(mesh.triangle[0], mesh.triangle[1]);
  scene.body("pair", mesh);
  return scene;
}

struct Reference {
  const char* name;
  double slide, first, second;  ///< displacement of A, opening of the ends
  double damage[3];
  Vec2 on_first, on_second;  ///< forces on A
};
const Reference references[] = {
    {"elastic",
     2e-8,
     1e-8,
     3e-8,
     {0.0, 0.0, 0.0},
     {-1425.001562, -968.7555},
     {-1425.003562, -1218.758}},
    {"softening",
     2e-6,
     3e-6,
     1e-6,
     {.346448265, .266124784, .204005883},
     {-3926.968675, -781.3105041},
     {-4483.785979, -892.0949908}},
    {"compression and slip",
     3e-7,
     -1e-8,
     -2e-8,
     {.009202140, .008729657, .008208175},
     {-8188.239289, 999.9284412},
     {-8363.844243, 1249.929319}},
};

/// Displaces A and evaluates the joint.
void displace(World& w, Index a, const Reference& r) {
  for (NodeState& n : nodes(w, a).at) {
    const double opening = r.first + (r.second - r.first) * n.position.x / 1e-3;
    n.position += Vec2{r.slide, opening};
  }
  HostRun{}.joint_forces(w);
}

TEST(Joint, has_the_reference_forces_and_damage) {
  for (const Reference& r : references) {
    World w = two_triangles().world();
    ASSERT_EQ(w.joints.size(), 1);
    displace(w, 0, r);
    const JointForce& f = w.joints.force.in_double.data()[0];
    // They count the length of the middle line now, this program the one at the start: apart by
    // half the square of its turn, 1e-3 at most.
    const double tolerance = 1e-6;
    EXPECT_NEAR(f.first.x, r.on_first.x, tolerance * norm(r.on_first)) << r.name;
    EXPECT_NEAR(f.first.y, r.on_first.y, tolerance * norm(r.on_first)) << r.name;
    EXPECT_NEAR(f.second.x, r.on_second.x, tolerance * norm(r.on_second)) << r.name;
    EXPECT_NEAR(f.second.y, r.on_second.y, tolerance * norm(r.on_second)) << r.name;
    for (int q = 0; q < 3; ++q)
      EXPECT_NEAR(w.joints.points.data()[0].point[q].damage, r.damage[q], 3e-8) << r.name << q;
  }
}

/// Which side is a must not matter: nor the forces on the triangles.
TEST(Joint, is_the_same_from_either_side) {
  for (const Reference& r : references) {
    World one = two_triangles(true).world(), other = two_triangles(false).world();
    displace(one, 0, r);
    displace(other, 1, r);
    const JointForce &f = one.joints.force.in_double.data()[0],
                     &g = other.joints.force.in_double.data()[0];
    const double size = norm(f.first) + norm(f.second);
    EXPECT_LT(norm(f.first + g.second), 1e-12 * size) << r.name;
    EXPECT_LT(norm(f.second + g.first), 1e-12 * size) << r.name;
    for (int q = 0; q < 3; ++q)
      EXPECT_NEAR(one.joints.points.data()[0].point[q].damage,
                  other.joints.points.data()[0].point[2 - q].damage, 1e-12);
  }
}

/// Two held triangles, A moved away: the joint's books show the energy of the law.
TEST(Joint, pulled_apart_books_its_fracture_energy_and_breaks) {
  for (const auto& [factor, expected] :
       {std::pair{3.0, 11.66922}, {exact_softening_factor, 10.08}}) {
    for (const bool rotated : {false, true}) {
      Scene scene = two_triangles();
      scene.config.joints.softening_factor = factor;
      const double angle = rotated ? 0.7 : 0.0;
      for (Vec2& x : scene.model.point) x = testing::rotated(x, angle);
      World w = scene.world();
      const Vec2 velocity = testing::rotated({0.0, 0.05}, angle);
      // A moves as a rigid body, by hand: velocity and position of each corner
      const double dt = 1e-8;
      int steps = 0;
      while (w.joints.stage.data()[0] != JointStage::broken && steps < 100000) {
        for (NodeState& n : nodes(w, 0).at) {
          n.velocity = velocity;
          n.position += dt * velocity;
        }
        w.last_dt = dt;
        w.time += dt;
        HostRun{}.joint_forces(w);
        ++steps;
      }
      const JointWork& work = w.joints.work.data()[0];
      // trapezoids of v dt = 5e-10 m over 1e-5 m: 2 (o_p / v dt)^-2 of the elastic part
      EXPECT_NEAR(work.open / 1e-3, expected, 1e-4 * expected);
      EXPECT_NEAR(work.slide / 1e-3, 0.0, 1e-9);
      EXPECT_NEAR(steps * dt * 0.05, 4e-8 + factor * 10.0 / 3e6, 6e-10);
      EXPECT_NEAR(w.joints.broke_at.data()[0], w.time, 1e-12);
      HostRun{}.joint_forces(w);
      EXPECT_EQ(norm(w.joints.force.in_double.data()[0].first), 0.0);
    }
  }
}

/// Carries triangle 0 straight on from one offset from its start to another, and evaluates its
/// joint on the way: visit(way) after each step, which went that way.
template <class Visit>
void carry(World& w, const TriangleNodes& start, Vec2& from, const Vec2& to, const Visit& visit) {
  const int steps = 1000;
  w.last_dt = 1e-8;
  const Vec2 way = (1.0 / steps) * (to - from);
  for (int i = 1; i <= steps; ++i) {
    for (int k = 0; k < 3; ++k) {
      NodeState& n = nodes(w, 0).at[k];
      n.velocity = (1.0 / w.last_dt) * way;
      n.position = start.at[k].position + from + static_cast<double>(i) * way;
    }
    HostRun{}.joint_forces(w);
    visit(way);
  }
  from = to;
}

/// Pressed, slipped, let go, slipped back: the way round takes T^3/(12 p_f/h) times
/// (1/c - 1/(c + sigma tan phi)), T = p_f s/h, an area, which a joint that stays whole does not
/// store.
TEST(Joint, books_what_pressure_takes_on_its_slip) {
  const double slope = 150e9 / 1e-3, slid = 20e6, pressed = 40e6;
  const double taken = 1e-3 * slid * slid * slid / (12.0 * slope) * (1.0 / 15e6 - 1.0 / 43e6);
  for (const Lanes lanes : {Lanes::one, widest_lanes()}) {
    World w = two_triangles().world();
    w.lanes = lanes;
    ASSERT_EQ(w.joints.size(), 1);
    const TriangleNodes start = nodes(w, 0);
    const auto& force = w.joints.force.in_double;
    const auto booked = [&] { return w.joints.work.data()[0].slide; };
    double given = 0.0;
    Vec2 from{};
    Vec2 before{};
    const auto go = [&](const Vec2& to) {
      carry(w, start, from, to, [&](const Vec2& way) {
        const Vec2 now = force.data()[0].first + force.data()[0].second;
        given -= 0.5 * dot(before + now, way);
        before = now;
      });
    };
    const double p = -pressed / slope, s = slid / slope;
    go({0.0, p});
    EXPECT_EQ(booked(), 0.0);
    go({s, p});
    EXPECT_NEAR(booked(), 0.0, 1e-9 * taken);
    go({s, 0.0});
    EXPECT_NEAR(booked(), taken, 1e-4 * taken);
    go({});
    EXPECT_NEAR(booked(), taken, 1e-4 * taken);
    EXPECT_NEAR(given, taken, 2e-3 * taken);
    EXPECT_EQ(w.joints.work.data()[0].open, 0.0);
    EXPECT_EQ(w.joints.stage.data()[0], JointStage::whole);
    // It gives that on the way back, so it counts as held.
    const EnergyBalance b = energies(w).balance;
    EXPECT_NEAR(b.elastic, taken, 1e-3 * taken);
    EXPECT_EQ(b.fracture, 0.0);
    go({s, 0.0});
    go({s, p});
    EXPECT_NEAR(booked(), 0.0, 1e-3 * taken);
    EXPECT_EQ(energies(w).balance.fracture, 0.0);
  }
}

/// Slipped first and pressed then, a joint would give back more than it took up: as it softens it
/// has spent nothing yet, not less than nothing. The modes count together.
TEST(Joint, has_never_spent_less_than_nothing) {
  const auto expect = [](const JointWork& beyond, double open, double slide) {
    const JointWork spent = beyond.spent();
    EXPECT_DOUBLE_EQ(spent.open, open);
    EXPECT_DOUBLE_EQ(spent.slide, slide);
  };
  expect({3.0, 5.0}, 3.0, 5.0);
  expect({0.0, -2.0}, 0.0, 0.0);
  expect({1.0, -2.0}, 0.0, 0.0);
  expect({3.0, -2.0}, 1.0, 0.0);
  expect({-2.0, 3.0}, 0.0, 1.0);

  World w = two_triangles().world();
  const TriangleNodes start = nodes(w, 0);
  Vec2 from{};
  double least = 0.0, most = 0.0, taken = 0.0;
  const auto go = [&](const Vec2& to) {
    carry(w, start, from, to, [&](const Vec2&) {
      taken = std::min(taken, w.joints.work.data()[0].slide);
      const double fracture = energies(w).balance.fracture;
      least = std::min(least, fracture);
      EXPECT_GE(fracture, (1.0 - 1e-9) * most);
      most = std::max(most, fracture);
    });
  };
  const double slope = 150e9 / 1e-3, p = -40e6 / slope, s = 28e6 / slope;
  go({s, 0.0});
  go({s, p});
  EXPECT_LT(taken, -1e-7);
  go({15.0 * s, p});
  EXPECT_EQ(w.joints.stage.data()[0], JointStage::softened);
  EXPECT_GE(least, 0.0);
  EXPECT_GT(most, 0.0);
}

TEST(Joint, two_of_three_failed_points_break_it) {
  World w = two_triangles().world();
  // 1e-5 m of softening, 4e-8 of elastic opening: one end beyond, then the middle as well
  displace(w, 0, {"", 0.0, 0.0, 1.9e-5, {}, {}, {}});
  EXPECT_EQ(w.joints.stage.data()[0], JointStage::softened);
  World broken = two_triangles().world();
  displace(broken, 0, {"", 0.0, 0.0, 2.1e-5, {}, {}, {}});
  EXPECT_EQ(broken.joints.stage.data()[0], JointStage::broken);
}

/// The joint of two materials takes the weaker strength of each kind.
TEST(Joint, between_two_materials_is_the_weaker_one) {
  Scene scene = two_triangles();
  MaterialConfig strong = scene.config.materials[0];
  strong.name = "strong";
  strong.young *= 2.0;
  strong.joint.tension *= 2.0;
  strong.joint.energy_open *= 0.5;
  scene.config.materials.push_back(strong);
  scene.model.material[1] = 1;
  const World w = scene.world();
  const JointBond& b = w.given->bonds.data()[w.joints.law.data()[0]];
  EXPECT_EQ(b.tension, 3e6);
  EXPECT_NEAR(b.softening_open, 3.0 * 5.0, 1e-12);
  EXPECT_NEAR(b.stiffness, 150e9, 1.0);
}

}  // namespace joint_test
}  // namespace breccia::fdem
