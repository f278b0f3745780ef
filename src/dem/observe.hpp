#pragma once
// Observations of a DEM run: hash, probes, counts, and whether its numbers are sound.

#include <array>
#include <numeric>

#include "core/probe.hpp"
#include "core/unsound.hpp"
#include "dem/world.hpp"

namespace breccia::dem {

/// Hash of positions, velocities, spins and orientations of all elements by global id.
/// A rank's is that of its own; the sum over all ranks is that of the whole.
std::uint64_t state_hash(const World& w);

/// The first element of its own whose state is not finite or that moves more than its radius in a
/// step.
UnsoundLater find_unsound_later(const World& w);
inline Unsound find_unsound(const World& w) {
  return find_unsound_later(w)();
}
/// The element of its own that moves fastest: where energy is lost, it may be the one to look at.
Fastest fastest(const World& w);

/// Share of each element's initial cohesive and interface links that are damaged or broken.  [-]
std::vector<double> damage(const World& w);
/// Mean damage of the links of each element, where the world lies; a broken link counts 1.  [-]
Buffer<double> damage_of(const World& w);

/// Velocities and spins of all elements at the time of the positions; those of ghosts mean nothing.
struct MotionNow {
  std::vector<Vec3> velocity, spin;  ///<  [m/s], [rad/s]
};
MotionNow motion_now(const World& w);

/// A probe's reading, when it is asked for: until then the host can go on.
std::function<double()> probe_later(const World& w, const ProbeConfig& probe);
inline double probe(const World& w, const ProbeConfig& probe) {
  return probe_later(w, probe)();
}
/// A probe's reading of a rank's own elements; the sum over all ranks is the reading of the
/// whole.
Readings read_own(World& part, const ProbeConfig& probe);

/// Notes the present time in links that have broken since the last call. On a device: there.
void note_breaks(World& w);

/// Counts of broken links and the like.
struct Counts {
  std::array<Index, link_kinds> broken{};  ///< links, by kind
  Index removed = 0;              ///< broken links between elements that have been taken out
  Index touching = 0;             ///< contacts that press now
  Index fragments = 0;            ///< pieces held together by links
  double largest_fragment = 0.0;  ///< share of the mass  [-]

  Index broken_links() const { return std::accumulate(broken.begin(), broken.end(), Index{0}); }
  Index broken_of(LinkKind kind) const { return broken[static_cast<std::size_t>(kind)]; }
};
Counts count(const World& w);

/// Largest opening of concrete link i so far, or link_broken, link_released. On the host.  [m]
double link_opening(const ConcreteLinks& links, Index i);

/// Force of concrete link i on its end b, from what the link keeps. All arrays on the host.  [N]
Vec3 link_force(const ConcreteLink& law, const ConcreteLinks& links, const Elements& elements,
                Index i);

}  // namespace breccia::dem
