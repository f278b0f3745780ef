#pragma once
// Facets of the lattice discrete particle model: arrays, forces, energies.

#include "dem/laws/ldpm_facet.hpp"
#include "dem/links/link_set.hpp"
#include "math/lanes.hpp"

namespace breccia::dem {

/// Where a facet lies, in the frame n, m, l = n x m of its edge.
struct LdpmPlace {
  double length;  ///< L of the edge  [m]
  double area;    ///< A, projected across the edge  [m2]
  Vec3 center;    ///< from particle a, along n, m, l  [m]
  double volume;  ///< six times V_0 of its tetrahedron, signed (six_volumes)  [m3]
};
/// How the frame of a facet's edge has turned, and whether the facet holds.
template <class R>
struct LdpmFrameOf {
  Vec3Of<R> m;  ///< unit vector across the edge  [-]
  R bond;       ///< 1; 0 once cracked; ldpm_released when its ends have parted  [-]
};
using LdpmFrame = LdpmFrameOf<double>;
inline constexpr double ldpm_released = -1.0;

/// Six times the volume of a tetrahedron; the sign is that of its orientation.
template <class R>
BR_HD inline R six_volumes(const Vec3Of<R>& a, const Vec3Of<R>& b, const Vec3Of<R>& c,
                           const Vec3Of<R>& d) {
  return dot(b - a, cross(c - a, d - a));
}

/// Facets between particles a and b, in a tetrahedron with c and d.
template <>
struct LinkArrays<LdpmFacet> : LinkEnds {
  static constexpr LinkKind kind = LinkKind::ldpm;
  static constexpr const char* name = "ldpm";
  static constexpr bool swept = false;

  Buffer<Index> c, d;            ///< the other corners of its tetrahedron  [-]  (ends)
  Buffer<LdpmPlace> place;       ///< (constant)
  Buffer<LdpmFrame> frame;       ///< (pairs)
  Buffer<LdpmFacetState> state;  ///< (pairs)
  Buffer<double> opened;         ///< energy spent while open: on fracture  [J]  (pairs)
  Buffer<double> compacted;      ///< while closed, by normal strains  [J]  (pairs)
  Buffer<double> slid;           ///< while closed, by tangential strains  [J]  (pairs)

  template <class Visit>
  void each_field(Visit&& field) {
    LinkEnds::each_field(field);
    field("c", "-", c);
    field("d", "-", d);
    field("place", "SI", place);
    field("frame", "-", frame);
    field("state", "SI", state);
    field("opened", "J", opened);
    field("compacted", "J", compacted);
    field("slid", "J", slid);
  }
  template <class Visit>
  void each_end(Visit&& visit) {
    LinkEnds::each_end(visit);
    visit("c", c);
    visit("d", d);
  }
  template <class Visit>
  void each_end(Visit&& visit) const {
    LinkEnds::each_end(visit);
    visit("c", c);
    visit("d", d);
  }
  struct Below {
    View<const LdpmFrame> frame;
    double limit;
    BR_HD bool operator()(Index i) const { return frame[i].bond < limit; }
  };
  template <class>
  Below broken() const {
    return {frame.view(), 0.5};
  }
  template <class>
  Below released() const {
    return {frame.view(), 0.5 * ldpm_released};
  }
};
using LdpmFacets = LinkArrays<LdpmFacet>;

/// Forces of facets, one facet or a pack of neighbours at a time.
struct LdpmFacetForces {
  static constexpr const char* name = "dem.ldpm_facets";
  using Law = LdpmFacet;
  Law law;
  double dt;
  ElementsView elements;
  View<const Index> a, b, c, d;
  View<const LdpmPlace> place;
  View<LdpmFrame> frame;
  View<LdpmFacetState> state;
  View<double> opened, compacted, slid;
  View<PairForce> actions;
  Index first_action;  ///< action of facet 0

  template <class R>
  struct Loaded {
    Indices<R> a, b, c, d;
    R length, area;
    Vec3Of<R> center;
    R volume;
    LdpmFrameOf<R> frame;
    LdpmFacetStateOf<R> state;
    LinkEnd<R> end_a, end_b;
    Vec3Of<R> at_c, at_d;
  };
  BR_HD void set(const StepTime& now) { dt = now.last_dt; }
  template <class R>
  BR_HD void load_early(Index i, Loaded<R>& loaded) const {
    loaded.a = load_indices_now<R>(a, i);
    loaded.b = load_indices_now<R>(b, i);
    loaded.c = load_indices_now<R>(c, i);
    loaded.d = load_indices_now<R>(d, i);
    R p[6], f[4], s[8];
    gather_records(place, consecutive<R>(i), p);
    gather_records(View<const LdpmFrame>(frame), consecutive<R>(i), f);
    gather_records(View<const LdpmFacetState>(state), consecutive<R>(i), s);
    loaded.length = p[0];
    loaded.area = p[1];
    loaded.center = {p[2], p[3], p[4]};
    loaded.volume = p[5];
    loaded.frame = {{f[0], f[1], f[2]}, f[3]};
    loaded.state = {{s[0], s[1], s[2]}, {s[3], s[4], s[5]}, s[6], s[7]};
  }
  template <class R>
  BR_HD void load_late(Index, Loaded<R>& loaded) const {
    loaded.end_a = load_end<R>(elements.state, loaded.a);
    loaded.end_b = load_end<R>(elements.state, loaded.b);
    loaded.at_c = place_of(loaded.c);
    loaded.at_d = place_of(loaded.d);
  }
  BR_WHOLE BR_HD void operator()(Index i) const { run_at<double>(*this, i); }
  template <class R>
  BR_HD bool update(Index i, const Loaded<R>& loaded) const {
    return update(law, i, loaded);
  }
  /// @returns false, having done nothing, if the facets of a pack are to be taken one by one
  template <class R>
  BR_HD bool update(const LdpmFacet& by, Index i, const Loaded<R>& loaded) const {
    const PairEnd<R>&one = loaded.end_a.motion, &other = loaded.end_b.motion;
    const R none = constant<R>(0.0), length = loaded.length;
    const PairMotion<R> motion = pair_motion<R>(one, other, none, dt);
    const R reach = 1.5 * max(length, loaded.end_a.radius + loaded.end_b.radius);
    const auto parted = loaded.frame.bond < 0.0 || motion.distance > reach;
    if (any(parted)) {
      if constexpr (width_of<R> == 1) release(by, i, loaded);
      return width_of<R> == 1;
    }
    // The frame of the edge, and the facet's centre from the middle of the edge in it
    const Vec3Of<R>& n = motion.normal;
    const Vec3Of<R> across = motion.tangential(motion.rotated_with_pair(loaded.frame.m));
    const Vec3Of<R> m = (1.0 / norm(across)) * across, l = cross(n, m);
    const Vec3Of<R> from_a = loaded.center.x * n + loaded.center.y * m + loaded.center.z * l;
    const Vec3Of<R> lever = from_a - motion.arm_a * n;

    LdpmFacetStateOf<R> kept = loaded.state;
    const Vec3Of<R> jump = motion.slip + cross(motion.turn, lever);
    const R over = 1.0 / length;
    const Vec3Of<R> strain =
        kept.strain + over * Vec3Of<R>{stretched(one, other, motion.distance) + dot(n, jump),
                                       dot(m, jump), dot(l, jump)};
    const R volume = six_volumes(one.position, other.position, loaded.at_c, loaded.at_d);
    const R volumetric = (volume - loaded.volume) / (3.0 * loaded.volume);
    const LdpmSpentOf<R> spent = by.update(length, strain, volumetric, kept);

    const R weight = loaded.area * length;
    add(opened, i, weight * spent.fracture);
    add(compacted, i, weight * spent.plastic);
    add(slid, i, weight * spent.friction);
    const R s[8] = {kept.strain.x, kept.strain.y, kept.strain.z,       kept.stress.x,
                    kept.stress.y, kept.stress.z, kept.largest_normal, kept.largest_tangential};
    store_records(state, i, s);
    const R bond = select(by.has_cracked(length, kept), none, loaded.frame.bond);
    const R f[4] = {m.x, m.y, m.z, bond};
    store_records(frame, i, f);

    const R area = -loaded.area;
    const Vec3Of<R> force =
        (area * kept.stress.x) * n + (area * kept.stress.y) * m + (area * kept.stress.z) * l;
    write(by, i, motion, from_a, force, loaded.area * over);
    return true;
  }

 private:
  /// Change of the distance in the last step, exactly: a rigid turn is none.
  template <class R>
  BR_HD R stretched(const PairEnd<R>& one, const PairEnd<R>& other, const R& distance) const {
    const Vec3Of<R> apart = other.position - one.position;
    const Vec3Of<R> step = constant<R>(dt) * (other.velocity - one.velocity);
    const Vec3Of<R> before = apart - step;
    return dot(step, apart + before) / (distance + norm(before));
  }
  template <class R>
  BR_HD static void add(const View<double>& energy, Index i, const R& spent) {
    if (any(spent != 0.0)) store(energy, i, load<R>(energy, i) + spent);
  }
  /// Writes force and torques of a facet, and its stiffness: with k = E A / L and r from a particle
  /// to the facet, K = k (alpha I + (1 - alpha) n n^T), and K^theta is at most k (alpha r.r + (1 -
  /// alpha) |r x n|^2) I.
  template <class R>
  BR_HD void write(const LdpmFacet& by, Index i, const PairMotion<R>& motion,
                   const Vec3Of<R>& from_a, const Vec3Of<R>& force, const R& area_by_length) const {
    const Vec3Of<R>& n = motion.normal;
    const Vec3Of<R> from_b = from_a - motion.distance * n;
    const Vec3Of<R> on_a = -cross(from_a, force), on_b = cross(from_b, force);
    const R numbers[9] = {on_a.x,  on_a.y, on_a.z, force.x, force.y,
                          force.z, on_b.x, on_b.y, on_b.z};
    const double alpha = by.shear_ratio;
    const R k = max(by.young, by.densified) * area_by_length;
    const R across = alpha * k, stretch = (1.0 - alpha) * k;
    const Vec3Of<R> turn = cross(from_a, n), along = stretch * n;  // turn of b, too
    const R tilt = stretch * dot(turn, turn);
    const R stiffness[9] = {across * dot(from_a, from_a) + tilt,
                            across + along.x * n.x,
                            across + along.y * n.y,
                            across + along.z * n.z,
                            along.x * n.y,
                            along.x * n.z,
                            along.y * n.z,
                            across * dot(from_b, from_b) + tilt,
                            constant<R>(0.0)};
    write_actions(actions, first_action + i, numbers, stiffness);
  }
  /// A facet whose ends have parted for good.
  BR_HD void release(const LdpmFacet& by, Index i, const Loaded<double>& loaded) const {
    if (loaded.frame.bond >= 0.0) {
      opened[i] += loaded.area * loaded.length * by.stored(loaded.state.stress);
      const LdpmFacetState& s = loaded.state;
      state[i] = {s.strain, {}, s.largest_normal, s.largest_tangential};
      frame[i] = {loaded.frame.m, ldpm_released};
    }
    const double nothing[9] = {};
    write_actions(actions, first_action + i, nothing, nothing);
  }
  template <class R>
  BR_HD Vec3Of<R> place_of(const Indices<R>& i) const {
    R numbers[4];
    gather_records(elements.state, i, numbers);
    return {numbers[0], numbers[1], numbers[2]};
  }
};
template <class>
LdpmFacetForces forces_of(LdpmFacets& f, const LdpmFacet& law, const LinkSpace& in,
                          Buffer<PairForce>& actions) {
  return {law,
          in.dt,
          in.elements,
          f.a.view(),
          f.b.view(),
          f.c.view(),
          f.d.view(),
          f.place.view(),
          f.frame.view(),
          f.state.view(),
          f.opened.view(),
          f.compacted.view(),
          f.slid.view(),
          actions.view(),
          0};
}

/// Energies of facets.
struct LdpmShares {
  View<const Index> a;
  View<const LdpmPlace> place;
  View<const LdpmFacetState> state;
  View<const double> opened, compacted, slid;

  BR_HD Energies operator()(const LdpmFacet& law, Index i) const {
    Energies s;
    s.elastic.add(place[i].area * place[i].length * law.stored(state[i].stress));
    s.fracture.add(opened[i]);
    s.plastic.add(compacted[i]);
    s.friction.add(slid[i]);
    return s;
  }
};
template <class>
LdpmShares shares_of(const LdpmFacets& f, const View<const ElementState>&) {
  return {f.a.view(),      f.place.view(),     f.state.view(),
          f.opened.view(), f.compacted.view(), f.slid.view()};
}

/// How far a facet has gone. All arrays on the host.
inline LinkStage stage_of(const LdpmFacet& law, const LdpmFacets& f, const Elements&, Index i) {
  if (f.frame.data()[i].bond < 0.5) return LinkStage::broken;
  return law.has_softened(f.place.data()[i].length, f.state.data()[i]) ? LinkStage::softened
                                                                       : LinkStage::whole;
}

}  // namespace breccia::dem
