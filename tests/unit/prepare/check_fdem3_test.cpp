// Rules of cases of tetrahedra that keys cannot state one by one.

#include <gtest/gtest.h>

#include "fdem3/setup/flatness.hpp"
#include "prepare/checks/check_case.hpp"
#include "prepare/checks/check_regions.hpp"
#include "prepare/tetrahedra/kuhn_box.hpp"
#include "unit/prepare/fdem3_scenes.hpp"

namespace breccia::fdem3 {
namespace check_fdem3_test {

Config good_case() {
  BodyConfig block = regular_box({0.1, 0.1, 0.1}, 0.02), ball = block;
  ball.name = "ball";
  ball.shape = "sphere";
  ball.structured = false;
  ball.size = {};
  ball.radius = 0.05;
  ball.center.z = 0.1;
  Config config = case_of({block, ball});
  config.supports.emplace_back();
  config.supports.back().name = "floor";
  config.supports.back().region.max.z = -0.0499;
  config.loads.emplace_back();
  config.loads.back().name = "top";
  config.loads.back().region.on = "ball";
  config.loads.back().region.min.z = 0.14;
  config.loads.back().pressure = 1e6;
  config.probes.emplace_back();
  config.probes.back().name = "reaction";
  config.probes.back().on = "floor";
  config.probes.back().quantity = "force_z";
  config.probes.emplace_back();
  config.probes.back().name = "crack";
  config.probes.back().quantity = "opening";
  return config;
}

std::string problems_with(const std::function<void(Config&)>& change) {
  Config config = good_case();
  change(config);
  return refusal_of([&] {
    check_case(config);
    prepare::check_regions(config);
  });
}

TEST(CheckFdem3, AcceptsAGoodCase) {
  EXPECT_EQ(problems_with([](Config&) {}), "");
}

TEST(CheckFdem3, RefusesWhatDoesNotFit) {
  const std::pair<std::function<void(Config&)>, const char*> changes[] = {
      {[](Config& c) { c.materials[0].poisson = 0.5; }, "material.rock.poisson: must be below 0.5"},
      {[](Config& c) {
         c.frictions.push_back({{"rock", "ice"}, 0.1});
       },
       "friction[0].between = \"ice\" is no material; there are: rock"},
      {[](Config& c) {
         c.joint_laws[0].between = {"rock", "ice"};
       },
       "joint.vein.between = \"ice\" is no material; there are: rock"},
      {[](Config& c) { c.supports[0].name = "ball"; }, "the name is taken by a body or support"},
      {[](Config& c) {
         c.supports[0].fix = {"x", "spin"};
       },
       "support.floor.fix: \"spin\" is no direction; allowed: x, y, z"},
      {[](Config& c) { c.supports[0].region.on = "wall"; },
       "support.floor.on = \"wall\" is not a body; there are: block, ball"},
      {[](Config& c) { c.supports[0].region.min.z = 0.0; },
       "support.floor: min must not be above max"},
      {[](Config& c) { c.supports[0].region.around = "x"; }, "a cylinder needs a radius"},
      {[](Config& c) { c.loads[0].kind = "traction"; },
       "load.top.pressure has no use: the load is of kind \"traction\""},
      {[](Config& c) {
         c.loads[0].force = Vec3{0.0, 0.0, 1.0};
       },
       "load.top.force has no use: the load is of kind \"pressure\""},
      {[](Config& c) { c.probes[0].on = "roof"; },
       "probe.reaction.on = \"roof\" is neither a body (block, ball) nor a support (floor)"},
      {[](Config& c) { c.stages.emplace_back().name = "one", c.stages[0].loads.push_back({}); },
       "stage.one.load.name = \"\" is no load; there are: top"},
      {[](Config& c) {
         c.supports[0].fix = {"x"};
         c.supports[0].servo.speed = 1.0;
         c.supports[0].servo.axis = "z";
       },
       "support.floor.servo.axis = \"z\": it does not fix that direction"},
      {[](Config& c) { c.bodies[1].center.z = 0.07; }, "body.block and body.ball overlap"},
      {[](Config& c) { c.bodies[0].velocity.x = 1.0, c.time.mass_scaling = 2.0; },
       "body.block begins with a velocity"},
      {[](Config& c) { c.loads[0].region.min.z = 0.2; },
       "load.top.min = 200 mm: the region takes nothing; ball is nearest, 50 mm away"},
      {[](Config& c) {
         c.supports[0].region.radius = 0.01;
         c.supports[0].region.center = {0.2, 0.0, 0.0};
         c.supports[0].region.around = "z";
       },
       "support.floor.min = 190 mm: the region takes nothing"},
      {[](Config& c) {
         fdem3::DiscontinuityConfig disc;
         disc.name = "far";
         disc.center = {0.0, 0.0, -0.3};
         disc.normal = {0.0, 0.0, 2.0};
         disc.radius = 1.0;
         c.discontinuities = {disc};
       },
       "discontinuity.far.center: it lies in no body; block is nearest, "},
  };
  for (const auto& [change, words] : changes) {
    const std::string text = problems_with(change);
    EXPECT_TRUE(mentions(text, words)) << words << "\nin: " << text;
  }
}

TEST(CheckFdem3, RefusesPartsThatTakeNothing) {
  const auto part_at = [](const Vec3& center, double radius, double height) {
    return problems_with([&](Config& c) {
      BodyConfig part;
      part.name = "core";
      part.shape = "part";
      part.material = "rock";
      part.of = "block";
      part.center = center;
      if (radius > 0.0)
        part.radius = radius;
      else
        part.size = {0.02, 0.02, 0.02};
      part.height = height;
      c.bodies.push_back(part);
    });
  };
  EXPECT_EQ(part_at({0.0, 0.0, 0.0}, 0.0, 0.0), "");
  EXPECT_EQ(part_at({0.055, 0.0, 0.0}, 0.0, 0.0), "");
  for (const double radius : {0.0, 0.01})
    for (const double height : {0.0, 0.02}) {
      if (radius == 0.0 && height > 0.0) continue;
      EXPECT_TRUE(mentions(part_at({0.061, 0.0, 0.0}, radius, height),
                           "body.core: lies wholly outside of body.block: it is at x 0.051"));
    }
  EXPECT_TRUE(mentions(part_at({0.06, 0.0, 0.0}, 0.0, 0.0), "lies wholly outside"));  // it touches
}

TEST(CheckFdem3, TellsOfDiscontinuitiesThatAreNone) {
  const std::pair<std::function<void(DiscontinuityConfig&)>, const char*> changes[] = {
      {[](DiscontinuityConfig&) {}, "a disc needs a radius above 0, and a polygon points"},
      {[](DiscontinuityConfig& d) { d.radius = 1.0, d.normal = {}; }, "normal has no length"},
      {[](DiscontinuityConfig& d) {
         d.points = {{0, 0, 0}, {1, 0, 0}};
       },
       "three or more corners"},
      {[](DiscontinuityConfig& d) {
         d.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
       },
       "the polygon has no area"},
      {[](DiscontinuityConfig& d) {
         d.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.1}};
       },
       "a discontinuity is flat"},
      {[](DiscontinuityConfig& d) { d.radius = 1.0, d.kind = "cohesive", d.material = "glue"; },
       "material = \"glue\" is not a joint law; there are: vein"},
  };
  for (const auto& [change, words] : changes) {
    const std::string text = problems_with([&](Config& c) {
      c.discontinuities.emplace_back().name = "crack";
      change(c.discontinuities[0]);
    });
    EXPECT_TRUE(mentions(text, "discontinuity.crack")) << text;
    EXPECT_TRUE(mentions(text, words)) << words << "\nin: " << text;
  }
}

TEST(CheckFdem3, KnowsWhichBodiesShareSpace) {
  const auto overlap = [](const std::string& a, const std::string& b, const Vec3& apart) {
    const auto body = [](const std::string& shape) {
      BodyConfig one = regular_box({}, 1e-4);
      one.name = shape;
      one.shape = shape.substr(0, shape.find(' '));
      one.structured = false;
      if (one.shape == "box")
        one.size = {2.0, 2.0, 2.0};
      else
        one.radius = 1.0;
      if (one.shape == "cylinder") one.height = 2.0;
      if (shape.ends_with(" x")) one.axis = "x";
      return one;
    };
    Config config = case_of({body(a), body(b)});
    config.bodies[1].name = "other";
    config.bodies[1].center = apart;
    config.bodies[0].mesh_size = config.bodies[1].mesh_size = 0.02;
    return mentions(refusal_of([&] { check_case(config); }), "overlap");
  };
  // Corner to corner 1.8 apart along each axis; touching is no overlap.
  EXPECT_TRUE(overlap("box", "box", {1.8, 1.8, 1.8}));
  EXPECT_FALSE(overlap("box", "box", {2.0, 0.0, 0.0}));
  EXPECT_TRUE(overlap("box", "sphere", {1.5, 1.5, 1.5}));   // 0.866 from the corner
  EXPECT_FALSE(overlap("sphere", "box", {1.6, 1.6, 1.6}));  // 1.04 from it
  EXPECT_TRUE(overlap("sphere", "sphere", {1.1, 1.1, 1.1}));
  EXPECT_FALSE(overlap("sphere", "sphere", {1.2, 1.2, 1.2}));
  EXPECT_TRUE(overlap("cylinder", "cylinder", {1.3, 1.3, 1.8}));
  EXPECT_FALSE(overlap("cylinder", "cylinder", {1.5, 1.5, 0.0}));
  EXPECT_FALSE(overlap("cylinder", "cylinder", {0.0, 0.0, 2.0}));
  EXPECT_TRUE(overlap("box", "cylinder", {1.6, 1.6, 1.8}));
  EXPECT_FALSE(overlap("cylinder", "box", {1.8, 1.8, 0.0}));
  EXPECT_TRUE(overlap("cylinder x", "box", {0.0, 1.6, 1.6}));
  EXPECT_FALSE(overlap("cylinder x", "box", {0.0, 1.8, 1.8}));
  EXPECT_TRUE(overlap("cylinder x", "sphere", {1.5, 1.2, 1.2}));
  EXPECT_FALSE(overlap("sphere", "cylinder x", {1.5, 1.4, 1.4}));
  EXPECT_FALSE(overlap("cylinder", "cylinder x", {1.9, 1.9, 0.0})) << "not looked at";
}

Model regular_model() {
  const prepare::TetMesh mesh = prepare::kuhn_box({}, {1.0, 1.0, 1.0}, 0.25);
  Model model;
  model.groups.push_back("rock");
  model.point = mesh.point;
  for (const prepare::Tetrahedron& t : mesh.tetrahedron) {
    model.tetrahedron.push_back({t[0], t[1], t[2], t[3]});
    model.group.push_back(0);
  }
  return model;
}

TEST(Flatness, of_a_regular_mesh_is_not_told) {
  EXPECT_FALSE(flat_tetrahedron(regular_model()));
}

// Its apex is brought to a hundredth of a median height, 0.177 of 1 m, over its face.
TEST(Flatness, of_one_tetrahedron_is_told_with_its_body) {
  Model model = regular_model();
  const auto corners = model.tetrahedron[7];
  const auto at = [&](std::size_t k) { return static_cast<std::size_t>(corners[k]); };
  const Vec3 a = model.point[at(0)], b = model.point[at(1)], c = model.point[at(2)];
  const Vec3 normal = cross(b - a, c - a);
  model.point.push_back((1.0 / 3.0) * (a + b + c) + (0.0018 / norm(normal)) * normal);
  model.tetrahedron[7][3] = static_cast<Index>(model.point.size()) - 1;
  const auto told = flat_tetrahedron(model);
  ASSERT_TRUE(told);
  EXPECT_NE(told->find("tetrahedron 7 (rock) is 0.0018 m high"), std::string::npos) << *told;
}

}  // namespace check_fdem3_test
}  // namespace breccia::fdem3
