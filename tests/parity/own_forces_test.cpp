// Forces of the program that holds a simulation: same bits on threads and by a device's schedule,
// and a ledger that closes with them.

#include <gtest/gtest.h>

#include <cmath>

#include "physics/dem/scene.hpp"
#include "physics/fdem/scene.hpp"
#include "run/method/dem_method.hpp"
#include "run/method/fdem_method.hpp"

namespace breccia {
namespace own_forces_test {

dem::testing::Scene column() {
  dem::testing::Scene s;
  s.material("c", "concrete", 30e9, 0.2, 2400.0);
  s.config.time = {.end = 1.0, .safety = 0.3};
  for (int i = 0; i < 6; ++i) {
    s.sphere({0.0, 0.0, 0.0101 + 0.0201 * i}, 0.01);
    if (i > 0) s.link(i - 1, i);
  }
  s.config.gravity = {0.0, 0.0, -10.0};
  s.wall({0.0, 0.0, 0.0}, {0.0, 0.0, 1.0});
  dem::SupportConfig head;
  head.name = "head";
  head.min.z = 0.1;
  head.fix = {"x"};
  s.config.supports = {head};
  return s;
}

fdem::testing::Scene strip(const char* joints) {
  using fdem::testing::far;
  fdem::testing::Scene s;
  s.material(30e9, 0.2, 2500.0).joints = joints;
  s.body("strip", prepare::crossed_rectangle({{0.0, 0.0}, {0.08, 0.02}}, 0.01));
  s.support("left", {-far, -far}, {0.0001, far}, {"x", "y"});
  s.config.time.end = 1.0;
  s.config.time.evaluate_every = 20;
  return s;
}

struct End {
  std::uint64_t hash = 0;
  double work = 0.0;    ///< of the own forces  [J]
  double booked = 0.0;  ///< in the ledger  [J]
  double missing = 0.0;
};
/// Every third item is pushed, the same one twice, by forces that grow from zero and shrink with
/// the work they have done.
template <class Scene>
End end_of(const Scene& s, const Exec& exec, double size) {
  const auto method = make_method(s.config, s.model, exec, nullptr);
  OwnForces own;
  for (Index i = 0; i < method->force_items(); i += 3) own.items.push_back(i);
  own.items.push_back(0);
  const auto each = static_cast<std::size_t>(method->force_numbers());
  End end;
  const auto push = [&] {
    own.numbers.assign(each * own.items.size(), 0.0);
    for (std::size_t k = 0; k < own.numbers.size(); ++k)
      own.numbers[k] = size * 1e4 * method->time() * static_cast<double>(1 + k % 5) - end.work;
    method->add_forces(own);
    end.work += method->book_forces(own);
  };
  push();
  for (int i = 0; i < 150; ++i) {
    method->advance({1.0, method->steps() + 1});
    end.work += method->book_forces(own);
    push();
  }
  const EnergyBalance energy = method->energy();
  end.hash = method->state_hash();
  end.booked = energy.work;
  end.missing = energy.error_relative;
  return end;
}

constexpr double warned_of = 1e-3;  ///< by a run, of missing energy  [-]

template <class Scene>
void expect_alike(const Scene& s, double size) {
  const End host = end_of(s, {}, size);
  EXPECT_NE(host.hash, end_of(s, {}, 0.5 * size).hash);
  EXPECT_LT(host.missing, warned_of);
  EXPECT_GT(std::abs(host.work), 0.0);
  Exec threads, shadow;
  threads.threads = 3;
  shadow.space = Space::shadow;
  for (const Exec& exec : {threads, shadow}) {
    const End other = end_of(s, exec, size);
    EXPECT_EQ(other.hash, host.hash);
    EXPECT_EQ(other.work, host.work);
    EXPECT_EQ(other.booked, host.booked);
  }
}

TEST(OwnForces, on_spheres_have_the_same_bits_on_threads_and_by_a_devices_schedule) {
  expect_alike(column(), 20.0);
}
TEST(OwnForces, on_joined_triangles_have_the_same_bits_on_threads_and_by_a_devices_schedule) {
  expect_alike(strip("intrinsic"), 2e3);
}
/// Corners that move as one get one acceleration, whichever of them is pushed.
TEST(OwnForces, on_corners_that_move_as_one_are_shared_by_them) {
  expect_alike(strip("extrinsic"), 2e3);
}

}  // namespace own_forces_test
}  // namespace breccia
