// Notes on tools of meshes that touch nothing at the start.

#include "prepare/checks/check_tools.hpp"

#include <gtest/gtest.h>

#include "unit/prepare/fdem3_scenes.hpp"
#include "unit/prepare/fdem_scenes.hpp"

namespace breccia {
namespace check_tools_test {

using prepare::doubtful_tools;
using Notes = std::vector<std::string>;

/// Rock, and a tool so far above it.
fdem3::Config in_space(double away) {
  fdem3::BodyConfig rock = fdem3::regular_box({0.1, 0.1, 0.1}, 0.05), tool = rock;
  rock.name = "rock";
  tool.name = "tool";
  tool.center = {0.0, 0.0, 0.1 + away};
  fdem3::Config config = fdem3::case_of({rock, tool});
  config.supports.emplace_back();
  config.supports[0].name = "press";
  config.supports[0].region.on = "tool";
  config.supports[0].velocity = Vec3{0.0, 0.0, -1.0};
  return config;
}

TEST(CheckTools, tells_how_far_a_tool_is_from_what_is_nearest) {
  const std::string note =
      "support.press.on: tool, which it holds as a whole, touches no body at the start; rock is "
      "nearest, 3 mm away";
  EXPECT_EQ(doubtful_tools(in_space(3e-3), "."), Notes{note});
  EXPECT_EQ(doubtful_tools(in_space(0.0), "."), Notes{});
  fdem3::Config config = in_space(3e-3);
  config.supports[0].velocity = Vec3{};
  EXPECT_EQ(doubtful_tools(config, "."), Notes{});  // a body that is held still is no tool
  config.supports[0].free = {"z"};
  EXPECT_EQ(doubtful_tools(config, "."), Notes{note});
  config.supports[0].free = {};
  config.stages.emplace_back();
  config.stages[0].supports.emplace_back();
  config.stages[0].supports[0].name = "press";
  config.stages[0].supports[0].servo.speed = 1.0;
  EXPECT_EQ(doubtful_tools(config, "."), Notes{note});
  config.supports[0].region.max = {1.0, 1.0, 0.1};  // a part of it
  EXPECT_EQ(doubtful_tools(config, "."), Notes{});
}

TEST(CheckTools, tells_it_of_triangles) {
  fdem::BodyConfig rock = fdem::regular_plate({0.1, 0.1}, 0.05), tool = rock;
  rock.name = "rock";
  tool.name = "tool";
  tool.center = {0.104, 0.0};
  fdem::Config config;
  config.bodies = {rock, tool};
  config.supports.emplace_back();
  config.supports[0].name = "turn";
  config.supports[0].region.on = "tool";
  config.supports[0].spin = 3.0;
  EXPECT_EQ(doubtful_tools(config, "."),
            Notes{"support.turn.on: tool, which it holds as a whole, touches no body at the start; "
                  "rock is nearest, 4 mm away"});
}

}  // namespace check_tools_test
}  // namespace breccia
