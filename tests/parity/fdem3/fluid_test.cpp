// Fluid in cracks of tetrahedra: threads, a device's schedule, ranks and resumed runs agree, and
// the ledger books its work.

#include <map>

#include "parity/staged_runs.hpp"
#include "physics/fdem3/scene.hpp"

namespace breccia {
namespace fluid3_test {

using namespace breccia::testing;
using fdem3::testing::far;

/// Opens the faces at z = 0 whose corners all are in a square.
void open_square(fdem3::testing::Scene& s, double half) {
  const auto taken = [&](Index v) {
    const Vec3& x = s.model.point[at(v)];
    return std::abs(x.z) < 1e-9 && std::max(std::abs(x.x), std::abs(x.y)) < half + 1e-9;
  };
  std::set<std::array<Index, 3>> faces;
  for (const auto& t : s.model.tetrahedron)
    for (int k = 0; k < 4; ++k) {
      std::array<Index, 3> face{};
      for (int c = 0; c < 3; ++c) face[at(c)] = t[at(fdem3::corner_of_face(k, c))];
      std::sort(face.begin(), face.end());
      if (std::all_of(face.begin(), face.end(), taken)) faces.insert(face);
    }
  for (const auto& face : faces) s.model.discontinuities.push_back({face, -1});
}

/// A cube with an open square crack of 20 mm in its middle, to one edge of which fluid comes.
fdem3::testing::Scene flooded(const char* joints, double speed) {
  fdem3::testing::Scene s;
  fdem3::MaterialConfig& rock = s.material(30e9, 0.2, 2500.0);
  rock.joints = joints;
  rock.joint.tension = 4e6;
  rock.joint.cohesion = 20e6;
  rock.joint.energy_open = 20.0;
  rock.friction = 0.5;
  s.body("rock", prepare::kuhn_box({}, {0.04, 0.04, 0.04}, 0.01));
  open_square(s, 0.01);
  fdem3::LoadConfig& water =
      s.load("water", "fluid", {-0.011, -0.001, -0.001}, {0.001, 0.001, 0.001});
  water.pressure.times = {0.0, 5e-6, 1e-4};
  water.pressure.values = {0.0, 40e6, 10e6};
  water.speed = speed;
  s.config.time.end = 1.0;
  s.config.time.max_step = 1e-7;
  fdem3::StageConfig fill, more;
  fill.name = "fill";
  fill.until = 1e-5;
  more.name = "more";
  more.until = 5e-6;
  more.loads = {{"water", 20e6, {}, {}, 0.0}};
  s.config.stages = {fill, more};
  return s;
}
/// A cube with a cube in its middle left out, which an explosive breaks.
fdem3::testing::Scene blasted() {
  fdem3::testing::Scene s;
  fdem3::MaterialConfig& rock = s.material(30e9, 0.2, 2500.0);
  rock.joints = "intrinsic";
  rock.joint.tension = 4e6;
  rock.joint.cohesion = 20e6;
  rock.joint.energy_open = 20.0;
  rock.friction = 0.5;
  const prepare::TetMesh whole = prepare::kuhn_box({}, {0.04, 0.04, 0.04}, 0.01);
  prepare::TetMesh pierced;
  std::map<Index, Index> number;
  for (const prepare::Tetrahedron& t : whole.tetrahedron) {
    Vec3 middle{};
    for (const Index v : t) middle += 0.25 * whole.point[at(v)];
    if (std::max({std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)}) < 0.01) continue;
    prepare::Tetrahedron corners{};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto [found, is_new] = number.emplace(t[k], static_cast<Index>(pierced.point.size()));
      if (is_new) pierced.point.push_back(whole.point[at(t[k])]);
      corners[k] = found->second;
    }
    pierced.tetrahedron.push_back(corners);
  }
  s.body("rock", pierced);
  fdem3::LoadConfig& anfo =
      s.load("anfo", "fluid", {-0.011, -0.011, -0.011}, {0.011, 0.011, 0.011});
  anfo.explosive = {49.46e9, 1.891e9, 3.907, 1.118, 0.333, 2.484e9, 1.6e-6, false};
  s.config.time.end = 1.0;
  s.config.time.max_step = 5e-8;
  fdem3::StageConfig first, second;
  first.name = "first";
  first.until = 1e-5;
  second.name = "second";
  second.until = 5e-6;
  s.config.stages = {first, second};
  return s;
}
TEST(Fluid3, of_an_explosive_is_alike_on_threads_schedule_and_ranks) {
  const fdem3::testing::Scene s = blasted();
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, s.config, nullptr);
  for (const Fact& fact : method->facts())
    if (fact.path == "fluid.anfo.area") {
      EXPECT_GT(fact.value, 0.0);  // it has entered cracks
    }
  expect_alike(s);
}
TEST(Fluid3, of_an_explosive_is_resumed) {
  expect_resumed(blasted());
}

/// The water flows: into the crack at a given pressure, then at a given rate.
fdem3::testing::Scene flowing(const char* joints) {
  fdem3::testing::Scene s = flooded(joints, 0.0);
  fdem3::LoadConfig& water = s.config.loads.back();
  water.viscosity = 1e-3;
  water.filled = true;
  s.config.stages[1].loads[0].pressure = 0.0;
  s.config.stages[1].loads[0].rate = 5e-3;
  return s;
}
double fact(Method& method, const std::string& path) {
  for (const Fact& f : method.facts())
    if (f.path == path) return f.value;
  ADD_FAILURE() << path;
  return 0.0;
}

TEST(Fluid3, in_cracks_is_alike_on_threads_schedule_and_ranks) {
  expect_alike(flooded("intrinsic", 800.0));
}
TEST(Fluid3, in_cracks_is_resumed) {
  expect_resumed(flooded("intrinsic", 800.0));
}
TEST(Fluid3, that_flows_is_alike_on_threads_schedule_and_ranks) {
  expect_alike(flowing("extrinsic"));
}
TEST(Fluid3, that_flows_is_resumed) {
  expect_resumed(flowing("intrinsic"));
}
/// Fluid that came in is in the cracks, besides what they held at the start: 8 closed faces of half
/// a square centimetre.
TEST(Fluid3, that_flows_is_neither_lost_nor_made) {
  const fdem3::testing::Scene s = flowing("intrinsic");
  ASSERT_EQ(s.model.discontinuities.size(), 8U);
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, s.config, nullptr);
  const double injected = fact(*method, "fluid.water.injected"),
               volume = fact(*method, "fluid.water.volume");
  EXPECT_GT(injected, 5e-9);
  EXPECT_GT(fact(*method, "fluid.water.area"), 2e-4);
  EXPECT_NEAR(volume - injected, 4e-4 * 1e-5, 1e-12 * volume + 1e-18);
  EXPECT_LT(method->energy().error_relative, 2e-3);
}
TEST(Fluid3, that_runs_faster_fills_more) {
  double last = 0.0;
  for (const double speed : {300.0, 1500.0, 0.0}) {
    const fdem3::testing::Scene s = flooded("intrinsic", speed);
    const auto method = make_method(s.config, s.model, {}, nullptr);
    run_to(*method, s.config, nullptr);
    const double area = fact(*method, "fluid.water.area");
    EXPECT_GT(area, 1.2 * last) << speed;
    last = area;
    EXPECT_LT(method->energy().error_relative, 2e-3) << speed;
    EXPECT_GT(method->energy().work, 0.0);
  }
  EXPECT_GT(last, 6e-4);  // it has left the crack of 4 cm2
}

/// The pressure on both faces of a crack is one: what it does to the body as a whole is nothing.
/// Where the crack meets the border it presses there, too.
TEST(Fluid3, presses_on_both_faces_and_on_the_border) {
  fdem3::testing::Scene s;
  s.material(30e9, 0.0, 2500.0);
  s.body("rock", prepare::kuhn_box({}, {0.02, 0.02, 0.02}, 0.01));
  open_square(s, 0.01);  // through all of it: two slabs
  fdem3::LoadConfig& water = s.load("water", "fluid", {-far, -far, -far}, {-0.00999, far, far});
  water.pressure = 2e6;
  s.config.time.max_step = 1e-8;
  fdem3::World w = s.world();
  fdem3::advance(w, {1.0, 1});
  Vec3 above{}, below{};
  for (Index t = 0; t < w.tetrahedra.size(); ++t) {
    double z = 0.0;
    for (const auto& n : w.tetrahedra.nodes.data()[t].at) z += n.position.z;
    for (const Vec3& f : w.tetrahedra.external.data()[t].at) (z > 0.0 ? above : below) += f;
  }
  EXPECT_NEAR(above.z, 2e6 * 4e-4, 1e-3 * 2e6 * 4e-4);
  EXPECT_NEAR(below.z, -above.z, 1e-9 * above.z);
  EXPECT_NEAR(above.x + below.x, 2e6 * 4e-4, 1e-3 * 2e6 * 4e-4);
  EXPECT_NEAR(above.x, below.x, 1e-3 * above.x);
}

/// Two slabs that water has pushed apart fly on without it. Work went on there as if it pressed.
TEST(Fluid3, that_has_left_does_no_work) {
  fdem3::testing::Scene s;
  s.material(30e9, 0.0, 2500.0);
  s.body("rock", prepare::kuhn_box({}, {0.02, 0.02, 0.02}, 0.01));
  open_square(s, 0.01);
  fdem3::LoadConfig& water = s.load("water", "fluid", {-far, -far, -1e-3}, {-0.00999, far, 1e-3});
  water.viscosity = 1e-3;
  water.filled = true;
  water.rate = 6e-4;
  s.config.time.end = 1.0;
  s.config.time.max_step = 1e-7;
  s.config.stages.resize(2);
  s.config.stages[0].name = "fill";
  s.config.stages[0].until = 2e-6;
  s.config.stages[1].name = "fly";
  s.config.stages[1].until = 3e-5;
  s.config.stages[1].loads = {{"water", 0.0, {}, {}, 0.0}};
  s.config.stages[1].loads[0].rate = 1e-12;
  const auto method = make_method(s.config, s.model, {}, nullptr);
  run_to(*method, s.config, nullptr);
  EXPECT_GT(method->energy().work, 0.005);
  EXPECT_LT(method->energy().error_relative, 2e-3);
}

/// A region with one vertex has no edge through which fluid could come.
TEST(Fluid3, needs_an_edge_to_come_from) {
  fdem3::testing::Scene s = flooded("intrinsic", 0.0);
  s.config.loads[0].region.min.x = -0.001;
  EXPECT_THROW(s.world(), InputError);
}

}  // namespace fluid3_test
}  // namespace breccia
