// Keys of two numbers, of points and of lists of numbers.

#include <gtest/gtest.h>

#include "exec/error.hpp"
#include "fdem/setup/body_config.hpp"
#include "io/case/case_file.hpp"

namespace breccia {
namespace case_points_test {

struct Plane {
  std::vector<fdem::BodyConfig> bodies;
  std::vector<fdem::DiscontinuityConfig> discontinuities;
  std::vector<double> times;

  template <class Visit>
  void each_key(Visit&& key) {
    key("times", times, "s", not_negative, "times");
    key.list("body", bodies, "bodies");
    key.list("discontinuity", discontinuities, "cracks");
  }
};

Plane read_text(const std::string& text) {
  return read_case<Plane>(CaseText{text, "plane.toml"}, {});
}
std::string message_of(const std::string& text) {
  try {
    read_text(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no problem";
}

const std::string good = R"(times = ["2 ms", 0.5]
[[body]]
name = "disc"
shape = "disc"
material = "rock"
center = ["10 mm", -1.0]
[[body.notch]]
from = [0.0, 0.0]
to = [0.0, "5 mm"]
[[body.hole]]
center = [1.0, 2.0]
radius = "2 mm"
[body.weibull]
modulus = 4.0
[[discontinuity]]
name = "dyke"
points = [[0.0, "1 mm"], [0.5, 1.0], [2.0, 2.0]]
)";

TEST(CasePoints, ArriveInSi) {
  const Plane plane = read_text(good);
  EXPECT_EQ(plane.times, (std::vector<double>{2e-3, 0.5}));
  EXPECT_EQ(plane.bodies.at(0).center.x, 0.01);
  EXPECT_EQ(plane.bodies.at(0).center.y, -1.0);
  EXPECT_EQ(plane.bodies.at(0).notches.at(0).to.y, 5e-3);
  EXPECT_EQ(plane.bodies.at(0).holes.at(0).radius, 2e-3);
  EXPECT_EQ(plane.bodies.at(0).weibull.modulus, 4.0);
  ASSERT_EQ(plane.discontinuities.at(0).points.size(), 3U);
  EXPECT_EQ(plane.discontinuities.at(0).points[0].y, 1e-3);
}

TEST(CasePoints, CompletedCaseReadsBackToItself) {
  const std::string completed = completed_case(read_text(good));
  EXPECT_EQ(completed_case(read_text(completed)), completed);
  EXPECT_EQ(completed.find("[body.grains]"), std::string::npos) << "a table that was not given";
  EXPECT_NE(completed.find("points = [[0.0, 0.001], [0.5, 1.0], [2.0, 2.0]]"), std::string::npos);
}

TEST(CasePoints, WrongOnesAreNamed) {
  const auto with = [](const std::string& line) {
    return message_of("[[discontinuity]]\nname = \"d\"\npoints = " + line + "\n");
  };
  EXPECT_NE(with("1.0").find("discontinuity.d.points wants points, as in"), std::string::npos);
  EXPECT_NE(with("[[1.0, 2.0], [3.0]]").find("discontinuity.d.points[1] wants two numbers"),
            std::string::npos);
  EXPECT_NE(with("[[1.0, \"2 s\"]]").find("discontinuity.d.points[0][1]"), std::string::npos);
  EXPECT_NE(message_of("times = [1.0, -2.0]").find("times[1] = -2 is outside"), std::string::npos);
  EXPECT_NE(message_of("times = 3.0").find("times wants a list of numbers"), std::string::npos);
  EXPECT_NE(message_of("[[body]]\nname = \"b\"\nmaterial = \"m\"\nsize = [1.0, 2.0, 3.0]")
                .find("body.b.size wants two numbers"),
            std::string::npos);
}

TEST(CasePoints, AreListedWithTheirTypes) {
  std::string types;
  for (const KeyInfo& key : list_keys<Plane>("")) types += key.path + " " + key.type + "\n";
  EXPECT_NE(types.find("body[].center 2 numbers\n"), std::string::npos);
  EXPECT_NE(types.find("discontinuity[].points points\n"), std::string::npos);
  EXPECT_NE(types.find("times numbers\n"), std::string::npos);
}

}  // namespace case_points_test
}  // namespace breccia
