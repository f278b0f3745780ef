#pragma once
// Couples and joints of triangles that a device lists (fdem_shared/kept_lists.hpp).

#include "fdem/world.hpp"

namespace breccia::fdem {

/// Couples that have begun and act.
struct ActingCouple {
  View<const CouplePhase> phase;
  View<const CoupleState> state;

  explicit ActingCouple(const World& w)
      : phase(w.couple_phase.view()), state(w.couples.history.state.view()) {}
  BR_HD bool operator()(Index i) const {
    return phase[i] == CouplePhase::acts && state[i].scale != 0.0;
  }
};
struct SoftenedJoint {
  View<const JointStage> stage;

  explicit SoftenedJoint(const World& w) : stage(w.joints.stage.view()) {}
  BR_HD bool operator()(Index i) const { return stage[i] == JointStage::softened; }
};

/// Whether launches list them from step to step, or anew in each step, a launch more: of many
/// couples most rest, and a kernel of their own looks at them faster. Tests in Space::shadow see
/// both ways.
inline bool keeps_lists(const World& w) {
  return w.couples.size() < (w.exec.space == Space::shadow ? 500 : 20'000);
}

}  // namespace breccia::fdem
