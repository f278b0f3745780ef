#pragma once
// Observations of a mesh that both finite-discrete methods make: hash, probes, damage, fragments,
// whether its numbers are sound, and what rules its time step.
//
// Written in fdem_shared/observations.hpp and fdem_shared/readings.hpp; made for each method in its
// observe.cpp and probes.cpp.

#include "core/probe.hpp"
#include "core/unsound.hpp"

namespace breccia::fdem_shared {

/// Hash of positions and velocities of all corners by global id. A rank's is that of its own; the
/// sum over all ranks is that of the whole.
template <class World>
std::uint64_t state_hash(const World& w);

/// The first element of its own that is inside out, not finite, or moves more than its size in a
/// step.
template <class World>
UnsoundLater find_unsound_later(const World& w);
template <class World>
Unsound find_unsound(const World& w) {
  return find_unsound_later(w)();
}
/// The element of its own that moves fastest: where energy is lost, it may be the one to look at.
template <class World>
Fastest fastest(const World& w);

/// Largest damage of the joints of each element.  [-]
template <class World>
std::vector<double> damage(const World& w);
/// Share of sliding in what a broken joint has spent on its fracture: 0 opening, 1 sliding  [-]
template <class Joints>
double mode_of(const Joints& joints, Index i) {
  const auto &work = joints.work.data()[i], &inherited = inherited_work(joints, i);
  const double open = work.open - inherited.open,
               slide = work.slide - inherited.slide - friction_of_broken(joints, i);
  const double opened = open > 0.0 ? open : 0.0, slid = slide > 0.0 ? slide : 0.0;
  return opened + slid > 0.0 ? slid / (opened + slid) : 0.0;
}

/// A probe's reading of the whole, when it is asked for: until then the host can go on.
template <class World>
std::function<double()> probe_later(const World& w, const ProbeConfig& probe);
template <class World>
double probe(const World& w, const ProbeConfig& probe) {
  return probe_later(w, probe)();
}
/// Readings of a probe on a rank's own elements; their sum over all ranks is that of the mesh.
template <class World>
Readings read_own(World& part, const ProbeConfig& probe);

/// The least stable step of all, without its safety, and what rules it, in a word.
struct RuledStep {
  double step;  ///<  [s]
  const char* term;
};
/// @param pressed  as if something touched wherever it can
template <class World>
RuledStep ruled_step(const World& w, bool pressed);
/// The stable step of an element, with the joints and contacts that it has now, and the mass that
/// bounds it.
struct StepOfElement {
  double step;   ///< the least of its corners, with all that move with them  [s]
  double bears;  ///< of a corner by itself its own; where corners move as one, of all their mass
                 ///< its share by rows: the more it has of them, the more of it  [kg], [kg/m]
};
template <class World>
std::vector<StepOfElement> stable_steps(const World& w);
/// Which term rules the time step now: elements, joints, contact or viscosity.
template <class World>
const char* ruling_term(const World& w) {
  return ruled_step(w, false).term;
}

}  // namespace breccia::fdem_shared
