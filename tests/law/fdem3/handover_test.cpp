// A joint that breaks under pressure: the contact of its faces goes on with its force and its
// energy.

#include <gtest/gtest.h>

#include <cmath>

#include "exec/for_each.hpp"
#include "fdem3/contact/couples.hpp"

namespace breccia::fdem3 {
namespace handover_test {

/// Two tetrahedra that overlap as their joint breaks, without friction, with a penalty of 1.
class Broken {
 public:
  Broken() {
    const Vec3 first[4] = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {.2, .9, 0.0}, {.3, .25, .8}};
    const Vec3 second[4] = {{.35, .3, .5}, {1.25, .4, .55}, {.5, 1.2, .6}, {.6, .5, 1.4}};
    nodes_.resize(2);
    for (int k = 0; k < 4; ++k) {
      nodes_.data()[0].at[k].position = first[k];
      nodes_.data()[1].at[k].position = second[k];
    }
    copy_to(material_, std::vector<Index>{0, 0});
    copy_to(laws_, std::vector<ContactPair>{{1.0, 0.0, 0.0}});
    copy_to(exposed_, std::vector<std::uint8_t>{15, 15});
    copy_to(a_, std::vector<Index>{0});
    copy_to(b_, std::vector<Index>{1});
    copy_to(parent_, std::vector<Index>{-1});
    failure_.resize(1), state_.resize(1), force_.resize(1), phase_.resize(1);
    phase_.data()[0] = fdem_shared::CouplePhase::acts;
  }
  void broke_with(double pressing, double held) {
    JointFailure& joint = failure_.make(0);
    joint.pressing = pressing;
    joint.held = {held, 0.0};
    parent_.data()[0] = 0;
  }
  void evaluate() {
    for_each(Exec{}, 1,
             CoupleForces{1.0, std::as_const(nodes_).view(), std::as_const(material_).view(),
                          std::as_const(laws_).view(), 1, std::as_const(exposed_).view(),
                          std::as_const(a_).view(), std::as_const(b_).view(),
                          std::as_const(parent_).view(), failure_.view(), state_.view(),
                          force_.view(), phase_.view()});
  }
  /// Of the overlap as it would press without a joint before it.
  Pressing whole() const {
    Broken other;
    other.state_.data()[0].scale = 1.0;
    other.evaluate();
    Pressing sum;
    sum.on_a = other.on_a();
    double best = 0.0;  // its energy: the work that parting gives back
    other.part(4000);
    best = -other.state_.data()[0].lost;
    sum.energy = best;
    return sum;
  }
  Vec3 on_a() const {
    const Corners& f = force_.data()[0].on_a;
    return f.at[0] + f.at[1] + f.at[2] + f.at[3];
  }
  /// Draws the second one away until nothing presses.
  void part(int steps) {
    for (int n = 0; n < steps; ++n) {
      for (NodeState& corner : nodes_.data()[1].at) {
        corner.velocity = {0.0, 0.0, 0.8 / steps};
        corner.position += corner.velocity;
      }
      evaluate();
    }
  }
  const CoupleState& state() const { return state_.data()[0]; }
  JointWork inherited() const { return failure_.item(0).inherited; }

 private:
  Buffer<TetrahedronNodes> nodes_;
  Buffer<Index> material_, a_, b_, parent_;
  Buffer<ContactPair> laws_;
  Buffer<std::uint8_t> exposed_;
  RareArray<JointFailure> failure_;
  Buffer<CoupleState> state_;
  Buffer<CoupleForce> force_;
  Buffer<fdem_shared::CouplePhase> phase_;
};

/// A tilted joint holds little beside what its overlap would: force and energy of the contact are
/// the joint's nevertheless, and parting gives back what was held.
TEST(HandoverInSpace, keeps_force_and_energy_of_the_joint) {
  const Pressing whole = Broken{}.whole();
  const double force = norm(whole.on_a);
  ASSERT_GT(whole.energy, 0.0);
  for (const double share : {0.05, 0.1, 0.3}) {
    Broken pair;
    pair.broke_with(0.3 * force, share * whole.energy);
    pair.evaluate();
    EXPECT_NEAR(norm(pair.on_a()), 0.3 * force, 1e-3 * force) << share;
    EXPECT_NEAR(pair.inherited().open, share * whole.energy, 1e-6 * whole.energy) << share;
    EXPECT_EQ(pair.state().work, pair.inherited().open);
    pair.part(4000);
    EXPECT_EQ(norm(pair.on_a()), 0.0);
    EXPECT_NEAR(pair.state().lost, 0.0, 2e-3 * share * whole.energy) << share;
  }
}

/// Where force and energy together ask for more than twice the penalty the force gives way.
TEST(HandoverInSpace, never_makes_energy) {
  const Pressing whole = Broken{}.whole();
  for (const double pressing : {0.001, 0.3, 3.0, 30.0})
    for (const double held : {1e-6, 1e-3, 0.1, 10.0}) {
      Broken pair;
      pair.broke_with(pressing * norm(whole.on_a), held * whole.energy);
      pair.evaluate();
      EXPECT_LE(pair.inherited().open, held * whole.energy * (1.0 + 1e-12));
      EXPECT_LE(norm(pair.on_a()), 2.0 * norm(whole.on_a) * (1.0 + 1e-12));
      pair.part(4000);
      EXPECT_GE(pair.state().lost, -2e-3 * whole.energy) << pressing << ' ' << held;
    }
}

}  // namespace handover_test
}  // namespace breccia::fdem3
