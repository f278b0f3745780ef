// Cracks of bodies that a stage takes out leave with them: frames, lists and counts have those of
// what is left, on ranks as on one; what was broken before is told apart, and its work stays
// booked.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "parity/staged_runs.hpp"
#include "physics/dem/scene.hpp"
#include "physics/fdem/scene.hpp"
#include "physics/fdem3/scene.hpp"

namespace breccia {
namespace removed_cracks_test {

using namespace breccia::testing;

constexpr double border = 0.01;  ///< what lies right of it is taken out  [m]

template <class Config>
void pull_and_dig(Config& config, double pull) {
  config.time.end = 1.0;
  config.stages.resize(2);
  auto &before = config.stages[0], &after = config.stages[1];
  before.name = "pull";
  before.until = pull;
  after.name = "dig";
  after.remove = {"right"};
  after.until = 2e-6;
}
template <class Model, class Corners>
void part(Model& model, const Corners& corners) {
  model.groups.emplace_back("right");
  for (std::size_t t = 0; t < corners.size(); ++t) {
    double x = 0.0;
    for (const Index v : corners[t]) x += model.point[static_cast<std::size_t>(v)].x;
    if (x > border * static_cast<double>(corners[t].size())) model.group[t] = 1;
  }
}

/// Two edges of a mesh that are open from the start, at this x.
void open_at(fdem::Model& model, double x) {
  const auto at_x = [&](std::size_t v) {
    return std::abs(model.point[v].x - x) < 1e-9 && model.point[v].y < 1e-3;
  };
  for (std::size_t a = 0; a < model.point.size(); ++a)
    for (std::size_t b = 0; b < model.point.size(); ++b)
      if (at_x(a) && at_x(b) && std::abs(model.point[b].y - model.point[a].y - 0.005) < 1e-9)
        model.discontinuities.push_back({{static_cast<Index>(a), static_cast<Index>(b)}, -1});
}

/// A strip that breaks near both of its ends. From the start it is open at three places: within
/// each body, and between them.
fdem::testing::Scene strip() {
  using fdem::testing::far;
  fdem::testing::Scene s;
  s.material(30e9, 0.2, 2500.0).joints = "intrinsic";
  s.config.materials[0].joint.tension = 1e6;
  s.config.materials[0].joint.energy_open = 1.0;
  s.body("left", prepare::crossed_rectangle({{0.0, 0.0}, {0.08, 0.02}}, 0.005));
  part(s.model, s.model.triangle);
  for (const double x : {-0.01, border, 0.02}) open_at(s.model, x);
  s.support("foot", {-far, -far}, {-0.0399, far}, {"x", "y"}, {-1.0, 0.0});
  s.support("head", {0.0399, -far}, {far, far}, {"x", "y"}, {1.0, 0.0});
  pull_and_dig(s.config, 1.5e-5);
  return s;
}
fdem3::testing::Scene bar() {
  using fdem3::testing::far;
  fdem3::testing::Scene s;
  s.material(30e9, 0.2, 2500.0).joints = "intrinsic";
  s.config.materials[0].joint.tension = 1e6;
  s.config.materials[0].joint.energy_open = 1.0;
  s.body("left", prepare::kuhn_box({}, {0.06, 0.01, 0.01}, 0.005));
  part(s.model, s.model.tetrahedron);
  s.support("foot", {-far, -far, -far}, {-0.0299, far, far}, {"x", "y", "z"}, {-1.0, 0.0, 0.0});
  s.support("head", {0.0299, -far, -far}, {far, far, far}, {"x", "y", "z"}, {1.0, 0.0, 0.0});
  pull_and_dig(s.config, 1.5e-5);
  return s;
}
/// Links 0-1 and 3-4 break; those from 2 on are taken out, and 1-2 is cut.
dem::testing::Scene chain() {
  dem::testing::Scene s;
  s.material("c", "concrete", 30e9, 0.2, 2400.0);
  const double speed[] = {-60.0, 0.0, 0.0, 0.0, 60.0};
  for (int i = 0; i < 5; ++i) s.sphere({-0.0301 + 0.02 * i, 0.0, 0.0}, 0.01, {speed[i], 0.0, 0.0});
  for (int i = 0; i < 4; ++i) s.link(i, i + 1);
  s.model.groups = {"left", "right"};
  for (std::size_t i = 2; i < 5; ++i) s.model.group[i] = 1;
  pull_and_dig(s.config, 1e-5);
  return s;
}

double fact(Method& method, const std::string& path) {
  for (const Fact& one : method.facts())
    if (one.path == path) return one.value;
  return -1.0;
}
/// Joints of the frame, and how many lie on the border or right of it.
struct Joints {
  std::size_t all = 0, right = 0;
};
Joints joints_in(const Frame& frame) {
  const bool solid = !frame.tetrahedra.empty();
  const auto& ends = solid ? frame.triangles : frame.lines;
  const std::size_t each = solid ? 3 : 2;
  Joints joints{ends.size() / each, 0};
  for (std::size_t i = 0; i < joints.all; ++i) {
    double x = 0.0;
    for (std::size_t k = 0; k < each; ++k)
      x += frame.position[static_cast<std::size_t>(ends[each * i + k])].x;
    joints.right += x > (border - 2e-4) * static_cast<double>(each) ? 1 : 0;
  }
  return joints;
}
std::size_t rows_of(Method& method, const char* name) {
  for (const Table& table : method.tables())
    if (table.name == name) return table.rows.size();
  return 0;
}

/// @param what  "joints" or "links"  @param list  the table of those that broke
template <class Scene>
void expect_left_behind(const Scene& s, const std::string& what, const char* list) {
  const auto method = make_method(s.config, s.model, {}, nullptr);
  const std::string broken = "fracture.broken_" + what, removed = "fracture.removed_" + what;
  StageControl stages(*method, s.config.probes, "", nullptr);
  double before = 0.0;
  Joints seen;
  while (method->stage().index == 0) {
    method->advance(stages.limited({1.0, 1'000'000}));
    seen = joints_in(method->frame());
    before = fact(*method, broken);
    EXPECT_EQ(fact(*method, removed), -1.0) << "told before a body has been taken out";
    stages.look();
  }
  EXPECT_GT(seen.right, 0U);
  EXPECT_GT(seen.all, seen.right);
  const Joints left = joints_in(method->frame());
  EXPECT_GT(left.all, 0U);
  EXPECT_EQ(left.right, 0U);
  EXPECT_GT(fact(*method, removed), 0.0);
  EXPECT_GT(fact(*method, broken), 0.0);
  EXPECT_EQ(fact(*method, broken) + fact(*method, removed), before);
  EXPECT_EQ(static_cast<double>(rows_of(*method, list)), fact(*method, broken));
  run_to(*method, s.config, nullptr);
  const Frame whole = method->frame();
  const double removed_at_end = fact(*method, removed);
  simulate_ranks(3, 5, [&](Communicator& ranks) {
    const auto part = make_method(s.config, s.model, {}, &ranks);
    run_to(*part, s.config, &ranks);
    const Frame frame = part->frame();
    const double out = fact(*part, removed);
    if (ranks.rank() != 0) return;
    EXPECT_EQ(out, removed_at_end);
    EXPECT_EQ(frame.lines, whole.lines);
    EXPECT_EQ(frame.triangles, whole.triangles);
    ASSERT_EQ(frame.position.size(), whole.position.size());
    for (std::size_t i = 0; i < whole.position.size(); ++i)
      EXPECT_EQ(frame.position[i].x, whole.position[i].x);
    ASSERT_EQ(frame.line_fields.size(), whole.line_fields.size());
    for (std::size_t i = 0; i < whole.line_fields.size(); ++i)
      EXPECT_EQ(frame.line_fields[i].values, whole.line_fields[i].values);
  });
}

std::size_t open_sides(const Frame& frame) {
  for (const FrameField& field : frame.line_fields)
    if (field.name == "mode")
      return static_cast<std::size_t>(std::count(field.values.begin(), field.values.end(), -1.0F));
  return 0;
}

TEST(RemovedCracks, of_triangles_leave_with_their_body) {
  expect_left_behind(strip(), "joints", "cracks");
}
/// An open crack between what goes and what stays is a border afterwards.
TEST(RemovedCracks, that_were_open_leave_with_their_body) {
  const fdem::testing::Scene s = strip();
  const auto method = make_method(s.config, s.model, {}, nullptr);
  EXPECT_EQ(open_sides(method->frame()), 12U);
  run_to(*method, s.config, nullptr);
  EXPECT_EQ(open_sides(method->frame()), 4U);
}
TEST(RemovedCracks, of_tetrahedra_leave_with_their_body) {
  expect_left_behind(bar(), "joints", "cracks");
}
TEST(RemovedCracks, links_of_spheres_leave_with_their_body) {
  expect_left_behind(chain(), "links", "broken_links");
}

}  // namespace removed_cracks_test
}  // namespace breccia
