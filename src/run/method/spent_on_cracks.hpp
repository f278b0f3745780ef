#pragma once
// Energies that cracks keep when a stage changes the law of their links or joints.

#include "core/energy.hpp"

namespace breccia {

/// Energy that links and joints had spent on cracks by laws that stages have changed, beyond what
/// their laws of now tell.  [J; in 2D J/m]
struct SpentOnCracks {
  double all = 0.0;
  double sliding = 0.0;  ///< where modes are told apart

  double opening() const { return all - sliding; }
  /// Takes over what a change of laws would take from cracks, and returns it.
  double add(double fracture, const Energies& before, const Energies& after) {
    all += fracture;
    sliding += before.sliding.value() - after.sliding.value();
    return fracture;
  }
  template <class Visit>
  void each_stored(const Visit& visit) {
    visit("spent_on_cracks", all);
    visit.where_kept("spent_sliding", sliding);
  }
};

}  // namespace breccia
