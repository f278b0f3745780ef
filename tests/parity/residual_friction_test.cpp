// Residual friction of joints: the ledger tells it with the same bits on threads, by a device's
// schedule, on ranks and from a checkpoint, and no force depends on that.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "domain/simulated_ranks.hpp"
#include "physics/fdem/scene.hpp"
#include "physics/fdem3/scene.hpp"
#include "run/method/fdem3_method.hpp"
#include "run/method/fdem_method.hpp"

namespace breccia {
namespace residual_friction_test {

/// Columns of the ledger that residual friction moves energy between.
struct Told {
  std::uint64_t hash = 0;
  double fracture = 0.0, friction = 0.0, elastic = 0.0, missing = 0.0;

  explicit Told(Method& method) : hash(method.state_hash()) {
    const EnergyBalance e = method.energy();
    fracture = e.fracture, friction = e.friction, elastic = e.elastic, missing = e.error_relative;
  }
  Told() = default;
};
void expect_same(const Told& one, const Told& other, const char* where) {
  EXPECT_EQ(one.hash, other.hash) << where;
  EXPECT_EQ(one.fracture, other.fracture) << where;
  EXPECT_EQ(one.friction, other.friction) << where;
  EXPECT_EQ(one.elastic, other.elastic) << where;
}

void go_on(Method& method, int steps) {
  while (method.steps() < steps) method.advance({1.0, steps});
}
template <class Scene>
Told told(const Scene& s, int steps, Exec exec = {}, Communicator* ranks = nullptr) {
  const auto method = make_method(s.config, s.model, exec, ranks);
  go_on(*method, steps);
  return Told(*method);
}

template <class Scene>
void expect_same_everywhere(const Scene& s, int steps) {
  const Told host = told(s, steps);
  EXPECT_LT(host.missing, 1e-3);
  Exec threads, shadow;
  threads.threads = 3;
  shadow.space = Space::shadow;
  expect_same(told(s, steps, threads), host, "threads");
  expect_same(told(s, steps, shadow), host, "a device's schedule");
  for (const Space space : {Space::host, Space::shadow})
    simulate_ranks(3, 5, [&](Communicator& ranks) {
      Exec own;
      own.space = space;
      const Told of_all = told(s, steps, own, &ranks);
      if (ranks.rank() == 0) expect_same(of_all, host, "3 ranks");
    });

  const std::string path =
      std::filesystem::temp_directory_path() / ("residual_" + std::to_string(::getpid()) + ".br");
  const auto before = make_method(s.config, s.model, {}, nullptr);
  go_on(*before, steps / 2);
  CheckpointWriter writer;
  before->save(writer);
  writer.write(path);
  const CheckpointReader reader(path);
  const auto after = make_method(s.config, s.model, {}, nullptr);
  after->load(&reader);
  std::filesystem::remove(path);
  go_on(*after, steps);
  expect_same(Told(*after), host, "a checkpoint");
}

/// A block of joints that are as rough as their faces, pressed and sheared.
fdem::testing::Scene block(const char* criterion) {
  using fdem::testing::far;
  fdem::testing::Scene s;
  fdem::MaterialConfig& m = s.material(30e9, 0.2, 2500.0);
  m.joints = "intrinsic";
  m.damping = 0.5;
  m.friction = std::tan(0.5);
  m.joint.tension = 20e6;
  m.joint.cohesion = 15e6;
  m.joint.energy_open = 5.0;
  m.joint.energy_slide = 50.0;
  m.joint.friction_angle = m.joint.residual_angle = 0.5;
  s.config.joints.criterion = criterion;
  s.config.time.end = 1.0;
  s.config.time.evaluate_every = 100;
  s.body("block", prepare::equilateral_rectangle({{0.0, 0.0}, {8e-3, 8e-3}}, 1e-3));
  s.support("top", {-far, 4e-3 - 1e-9}, {far, far}, {"y"}, {0.0, -4.0});
  s.support("bottom", {-far, -far}, {far, -4e-3 + 1e-9}, {"y"}, {0.0, 4.0});
  return s;
}

TEST(ResidualFriction, of_triangles_is_told_alike_by_threads_schedule_ranks_and_checkpoints) {
  for (const char* const criterion : {"edge", "rock"}) {
    SCOPED_TRACE(criterion);
    const fdem::testing::Scene s = block(criterion);
    fdem::World w = s.world(1);
    while (w.step < 700) fdem::step(w);
    double rubbed = 0.0;
    for (const double each : w.joints.rubbed.host()) rubbed += each;
    std::printf("%s: %zu cracks, rubbed %.3g of %.3g J/m\n", criterion, fdem::cracks(w).size(),
                rubbed, fdem::energies(w).balance.fracture);
    EXPECT_GT(rubbed, 0.02 * fdem::energies(w).balance.fracture);
    EXPECT_GT(fdem::cracks(w).size(), 10U);
    expect_same_everywhere(s, 700);
  }
}

TEST(ResidualFriction, of_tetrahedra_is_told_alike_by_threads_schedule_ranks_and_checkpoints) {
  fdem3::testing::Scene s = fdem3::testing::meeting_cubes();
  s.config.time.end = 1.0;
  auto& joint = s.config.materials[0].joint;
  joint.residual_angle = joint.friction_angle = 0.5;
  fdem3::World w = s.world();
  while (w.step < 420) fdem3::step(w);
  double rubbed = 0.0;
  for (Index i = 0; i < w.joints.size(); ++i) rubbed += fdem3::rubbed(w.joints, i);
  std::printf("%zu cracks, rubbed %.3g of %.3g J\n", fdem3::cracks(w).size(), rubbed,
              fdem3::energies(w).balance.fracture);
  EXPECT_GT(rubbed, 0.005 * fdem3::energies(w).balance.fracture);
  EXPECT_GT(fdem3::cracks(w).size(), 20U);
  expect_same_everywhere(s, 420);
}

}  // namespace residual_friction_test
}  // namespace breccia
