#pragma once
// Energies that joints store: one by one, and of whole ones by packs.

#include "core/energy.hpp"
#include "exec/lanes.hpp"
#include "fdem/joints/joints.hpp"
#include "fdem/laws/rock_failure.hpp"
#include "fdem/triangles/triangles.hpp"
#include "math/lanes.hpp"

namespace breccia::fdem {

/// Energy that a joint would give back if it were unloaded now.
struct StoredByJoints {
  View<const NodeState> nodes;
  View<const JointBond> bonds;
  View<const JointEnds> ends;
  View<const Index> law;
  View<const double> length, strength;
  View<const Vec2> preset;
  View<const JointPoints> points;
  Lanes lanes;

  BR_HD StoredEnergy operator()(Index i) const {
    const JointEnds& e = ends[i];
    const JointOpening<double> o = opening_of(nodes[e.a0].position, nodes[e.a1].position,
                                              nodes[e.b0].position, nodes[e.b1].position);
    const Vec2 offset = preset.size > 0 ? preset[i] : Vec2{};
    return stored_in(bonds[law[i]], strength[i], length[i], offset, o, points[i]);
  }
  /// Adds what whole joints from `begin` on store, and have taken up, by packs. @returns where that
  /// ends: at a pack that has others in it, or at what does not fill one
  Index add_whole(ExactSum& elastic, const View<const JointStage>& stage,
                  const View<const JointWork>& work, Index begin, Index end) const;
  Index width() const { return static_cast<Index>(lanes); }
};

/// Whole joints, a pack at a time.
struct WholeJoints {
  StoredByJoints by;
  View<const JointStage> stage;
  View<const JointWork> work;

  template <class R>
  bool are_whole(Index i) const {
    for (Index k = 0; k < width_of<R>; ++k)
      if (stage[i + k] != JointStage::whole) return false;
    return true;
  }
  /// As JointShares adds it for each of them.
  template <class R>
  R elastic(Index i) const {
    Index at[4][width_of<R>];
    list_ends<R>(by.ends, i, at);
    R corner[4][2], bond[4], taken[2], offset[2] = {};
    for (int k = 0; k < 4; ++k) gather_records(by.nodes, indices<R>(at[k]), corner[k]);
    gather_records(by.bonds, load_indices<R>(by.law, i), bond);  // stiffness, f_t, c, friction
    gather_records(work, consecutive<R>(i), taken);
    if (by.preset.size > 0) gather_records(by.preset, consecutive<R>(i), offset);
    const auto place = [&](int k) { return Vec2Of<R>{corner[k][0], corner[k][1]}; };
    const JointOpening<R> o = opening_of<R>(place(0), place(1), place(2), place(3));
    const R h = load<R>(by.length, i), share = load<R>(by.strength, i);
    R open = constant<R>(0.0), slide = open;
    for (int q = 0; q < 3; ++q) {
      const StoredUndamaged<R> e =
          stored_undamaged<R>(bond[0], bond[1] * share, bond[2] * share, bond[3], h,
                              o.open[q] + offset[0], o.slide[q] + offset[1]);
      const R weight = (q == 1 ? 4.0 : 1.0) * h / 6.0;
      open += weight * e.open;
      slide += weight * e.slide;
    }
    return (open + slide) + (taken[0] + taken[1]);
  }
};

}  // namespace breccia::fdem
