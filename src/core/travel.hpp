#pragma once
// How long a list of pairs stays valid: each element has a margin of its own to travel in.
//
// At a search, element e stands at x_e and its box is grown by its margin m_e on every side. The
// list holds all pairs whose grown boxes overlap. Claim: as long as no element is further than its
// margin from where it stood, every pair that touches is in the list.
//
// Proof. Let e and f touch now. Then the box of e, moved from x_e by d_e, and the box of f, moved
// by d_f, share a point p. From |d_e| <= m_e follows that p lies in the box of e at the search
// grown by m_e, since no component of d_e exceeds its length; the same holds for f. So the two
// grown boxes shared p at the search, and the pair is in the list.
//
// With equal margins m = s/2, for a skin s between two elements, this is the rule of two times the
// largest travel (2 max |d| <= s): two elements may approach each other, so that a search at one
// time the travel would come too late. Own margins let a fast flyer have a large one without making
// the boxes of all others larger. Rounding is covered by `sphere_boxes`.

#include "core/broad_phase.hpp"
#include "core/drift.hpp"

namespace breccia {

/// How margins are chosen: m = min(base / 2 + |v| horizon, largest).
struct MarginRule {
  double base = 0.0;     ///< skin between two elements at rest  [m]
  double horizon = 0.0;  ///< time for which the velocity at the search is expected to last  [s]
  double largest = 0.0;  ///< no margin exceeds this, however fast the element  [m]

  BR_HD double margin(const Vec3& velocity) const {
    const double wanted = 0.5 * base + norm(velocity) * horizon;
    return wanted > largest ? largest : wanted;
  }
};

/// Where the elements (or nodes) stood at the last search, and how far each may go. One item each,
/// written by the search.
struct Travel {
  Buffer<Vec3> reference;  ///< position at the last search  [m]
  Buffer<double> margin;   ///< how far from there, the drift taken off  [m]
  Drift drift;

  explicit Travel(Space space = Space::host) : reference(space), margin(space) {}

  template <class Visit>
  void each_field(Visit&& field) {
    field("reference", "m", reference);
    field("margin", "m", margin);
  }
};

/// Starts anew: elements stand at `position`, and get margins by the rule. @throws NumericsError
/// if a margin is not finite (the velocity went wrong; names the element's place in memory)
/// @param velocity  less that of the drift  [m/s]
void begin_travel(const Exec& exec, const MarginRule& rule, const Buffer<Vec3>& position,
                  const Buffer<Vec3>& velocity, Travel& travel);

/// Boxes of spheres, grown by their margins and by a few roundings of the coordinates, so that the
/// claim above holds in floating-point numbers too.
/// @param radius    reach of each element: two touch within the sum of theirs  [m]
/// @param farthest  way of the drift whose rounding is covered, too  [m]
void sphere_boxes(const Exec& exec, const Buffer<Vec3>& centre, const Buffer<double>& radius,
                  const Buffer<double>& margin, Buffer<Box>& boxes, double farthest = 0.0);

}  // namespace breccia
