#pragma once
// Facets of the lattice discrete particle model: arrays, forces, energies.

#include <algorithm>
#include <utility>
#include <vector>

#include "dem/links/ldpm_edges.hpp"

namespace breccia::dem {

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
  LdpmEdges edges;               ///< no state: of the facets here  (derive)

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

/// Numbers that all facets of an edge share in a step.
template <class R>
struct LdpmEdgeOf {
  Vec3Of<R> turn;  ///< of b against a, in the frame n, m, l = n x m  [rad]
  Vec3Of<R> jump;  ///< of b against a in the middle of the edge, less turn x half the edge  [m]
  R over;          ///< one over the length of the edge  [1/m]
  R parted;        ///< 1 where the facets have let go, or are to, of their ends; else 0
  Vec3Of<R> m;     ///< unit vector across the edge  [-]
  R fill;          ///< an even number
};

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
  View<LdpmShare> shares;
  Index first_share;               ///< share of facet 0
  View<const Index> edges, leads;  ///< LdpmEdges: of each facet, first facets

  template <class R>
  struct Facet {
    R length, area;
    Vec3Of<R> center;
    R volume;
    LdpmFrameOf<R> frame;
    LdpmFacetStateOf<R> state;
  };
  /// A facet in the middle of its step.
  template <class R>
  struct Moving {
    Vec3Of<R> center;
    R area, weight;
    LdpmFacet::Step<R> step;
  };
  template <class R>
  struct Loaded {
    Indices<R> a, b;
    Facet<R> facet;
    LinkEnd<R> end_a, end_b;
  };
  /// e_V of the tetrahedra of a facet and its neighbours, from their corners.
  template <class R>
  struct Volumetric {
    const LdpmFacetForces& kernel;
    Index i;
    const R& volume;

    BR_HD R operator()() const {
      const R now =
          six_volumes(corner(kernel.a), corner(kernel.b), corner(kernel.c), corner(kernel.d));
      return (now - volume) / (3.0 * volume);
    }
    BR_HD Vec3Of<R> corner(const View<const Index>& of) const {
      R numbers[4];
      gather_records(kernel.elements.state, load_indices<R>(of, i), numbers);
      return {numbers[0], numbers[1], numbers[2]};
    }
  };
  BR_HD void set(const StepTime& now) { dt = now.last_dt; }
  template <class R>
  BR_HD void load_early(Index i, Loaded<R>& loaded) const {
    loaded.a = load_indices_now<R>(a, i);
    loaded.b = load_indices_now<R>(b, i);
    load_facet(i, loaded.facet);
  }
  template <class R>
  BR_HD void load_late(Index, Loaded<R>& loaded) const {
    loaded.end_a = load_end<R>(elements.state, loaded.a);
    loaded.end_b = load_end<R>(elements.state, loaded.b);
  }
  BR_WHOLE BR_HD void operator()(Index i) const { run_at<double>(*this, i); }
  template <class R>
  BR_HD bool update(Index i, const Loaded<R>& loaded) const {
    return update(law, i, loaded);
  }
  /// @returns false, having done nothing, if the facets of a pack are to be taken one by one
  template <class R>
  BR_HD bool update(const LdpmFacet& by, Index i, const Loaded<R>& loaded) const {
    const LdpmEdgeOf<R> edge =
        edge_of(loaded.end_a, loaded.end_b, loaded.facet.length, loaded.facet.frame);
    if (any(edge.parted > 0.0)) {
      if constexpr (width_of<R> == 1) release(by, i, loaded.facet);
      return width_of<R> == 1;
    }
    move(by, i, loaded.facet, edge);
    return true;
  }

#if !defined(__CUDACC__)
  /// Packs of the facets [begin, end), as long as there are whole ones: neighbours on one edge
  /// share its motion, which is computed once for them. @returns the first facet that is left
  template <class R>
  Index sweep(Index begin, Index end) const {
    constexpr Index width = width_of<R>, room = 4 * width;
    static_assert(sizeof(LdpmEdgeOf<double>) == 12 * sizeof(double));
    if (edges.size != a.size || end - begin < width) return begin;
    alignas(64) LdpmEdgeOf<double> motions[room];  // a ring: packs of them, made ahead
    View<LdpmEdgeOf<double>> ring;
    ring.data = motions;
    ring.size = room;
    const Index first = edges[begin], last = edges[end - 1];
    Index made = first;
    const LdpmFacet by = law;  // no store can change it
    Waiting<R> waiting;
    Index i = begin;
    for (; i + width <= end; i += width) {
      fetch(i + 4 * width, width);
      for (; edges[i + width - 1] >= made; made += width)
        make_edges<R>(made, begin, last, ring, (made - first) % room);
      Index of[width];
      for (Index k = 0; k < width; ++k) of[k] = (edges[i + k] - first) & (room - 1);
      Facet<R> facet;
      load_facet(i, facet);
      R e[12];
      gather_records(View<const LdpmEdgeOf<double>>(ring), indices<R>(of), e);
      const LdpmEdgeOf<R> own{
          {e[0], e[1], e[2]}, {e[3], e[4], e[5]}, e[6], e[7], {e[8], e[9], e[10]}, e[11]};
      if (any(own.parted > 0.0)) {
        for (Index k = 0; k < width; ++k) (*this)(i + k);
        continue;
      }
      Moving<R> now;
      begin_move(by, i, facet, own, now);
      if (now.step.decays())
        wait(by, i, now, waiting);
      else
        end_move(by, i, now, constant<R>(1.0));
    }
    end_moves(by, waiting);
    return i;
  }
#endif

 private:
#if !defined(__CUDACC__)
  /// Packs that wait until as many are together as are taken side by side.
  template <class R>
  struct Waiting {
    static constexpr Index room = 4;
    Moving<R> pack[room];
    Index first[room];  ///< facet of each pack
    Index count = 0;
  };
  template <class R>
  void wait(const LdpmFacet& by, Index i, const Moving<R>& now, Waiting<R>& waiting) const {
    waiting.pack[waiting.count] = now;
    waiting.first[waiting.count] = i;
    if (++waiting.count < waiting.room) return;
    end_moves(by, waiting);
    waiting.count = 0;
  }
  /// The rest of steps of packs that wait, what decays in them side by side.
  template <class R>
  void end_moves(const LdpmFacet& by, Waiting<R>& waiting) const {
    if (waiting.count == 0) return;
    using Step = LdpmFacet::Step<R>;
    bool softens = false;
    for (Index k = 0; k < waiting.room; ++k) {
      if (k >= waiting.count) waiting.pack[k].step = waiting.pack[0].step;
      softens = softens || waiting.pack[k].step.softens;
    }
    const auto four = [&](const auto& of) {
      const auto& pack = waiting.pack;
      using Item = decltype(of(pack[0].step));
      return Two<Two<Item>>{{of(pack[0].step), of(pack[1].step)},
                            {of(pack[2].step), of(pack[3].step)}};
    };
    const Two<Two<R>> decay =
        by.decay_of(softens, four([](const Step& s) { return s.strain.x > 0.0; }),
                    four([](const Step& s) { return s.half_tangent; }),
                    four([](const Step& s) { return s.exponent; }));
    const R of[] = {decay.one.one, decay.one.other, decay.other.one, decay.other.other};
    for (Index k = 0; k < waiting.count; ++k)
      end_move(by, waiting.first[k], waiting.pack[k], of[k]);
  }
  /// A pack of edges from `edge_number` on into a ring. Each is read from the first of its facets
  /// that is not yet behind, `begin` or later: those before may have moved on.
  /// @param last  edge beyond which there is no use
  template <class R>
  void make_edges(Index edge_number, Index begin, Index last, const View<LdpmEdgeOf<double>>& ring,
                  Index place_in_ring) const {
    constexpr Index width = width_of<R>;
    Index lead[width], from[width], to[width];
    for (Index k = 0; k < width; ++k) {
      lead[k] = std::max(leads[std::min(edge_number + k, last)], begin);
      from[k] = a[lead[k]];
      to[k] = b[lead[k]];
    }
    R p[2], f[4];
    gather_records(place, indices<R>(lead), p);
    gather_records(View<const LdpmFrame>(frame), indices<R>(lead), f);
    const LdpmEdgeOf<R> all =
        edge_of(load_end<R>(elements.state, indices<R>(from)),
                load_end<R>(elements.state, indices<R>(to)), p[0], {{f[0], f[1], f[2]}, f[3]});
    const R numbers[12] = {all.turn.x, all.turn.y, all.turn.z, all.jump.x, all.jump.y, all.jump.z,
                           all.over,   all.parted, all.m.x,    all.m.y,    all.m.z,    all.fill};
    write_records(ring, place_in_ring, numbers);
  }
#endif
  /// Asks the memory for what facets keep: more arrays than the processor foresees.
  void fetch(Index first, Index count) const {
    const auto ask = [=](const auto& array) {
      const auto* items = reinterpret_cast<const char*>(array.data + first);
      const auto bytes = static_cast<Index>(sizeof *array.data) * count;
      for (Index byte = 0; byte < bytes; byte += 64) __builtin_prefetch(items + byte);
    };
    ask(place), ask(frame), ask(state), ask(opened), ask(compacted), ask(slid);
  }
  template <class R>
  BR_HD void load_facet(Index i, Facet<R>& facet) const {
    R p[6], f[4], s[8];
    load_records(place, i, p);
    load_records(frame, i, f);
    load_records(state, i, s);
    facet.length = p[0];
    facet.area = p[1];
    facet.center = {p[2], p[3], p[4]};
    facet.volume = p[5];
    facet.frame = {{f[0], f[1], f[2]}, f[3]};
    facet.state = {{s[0], s[1], s[2]}, {s[3], s[4], s[5]}, s[6], s[7]};
  }
  /// @param old  frame of the edge before the step, the bond of one of its facets
  template <class R>
  BR_HD LdpmEdgeOf<R> edge_of(const LinkEnd<R>& end_a, const LinkEnd<R>& end_b, const R& length,
                              const LdpmFrameOf<R>& old) const {
    const PairEnd<R>&one = end_a.motion, &other = end_b.motion;
    const R none = constant<R>(0.0);
    const PairMotion<R> motion = pair_motion<R>(one, other, none, dt);
    const R reach = 1.5 * max(length, end_a.radius + end_b.radius);
    LdpmEdgeOf<R> edge;
    edge.parted = select(old.bond < 0.0 || motion.distance > reach, constant<R>(1.0), none);
    edge.over = 1.0 / length;
    edge.fill = none;
    // Newton's step from 1 makes m a unit vector: it was one.
    const Vec3Of<R>& n = motion.normal;
    const Vec3Of<R> across = motion.tangential(motion.rotated_with_pair(old.m));
    edge.m = (1.5 - 0.5 * dot(across, across)) * across;
    const Vec3Of<R> l = cross(n, edge.m);
    edge.turn = {dot(n, motion.turn), dot(edge.m, motion.turn), dot(l, motion.turn)};
    const R half = 0.5 * motion.distance;
    edge.jump = {stretched(one, other, motion.distance),
                 dot(edge.m, motion.slip) - half * edge.turn.z,
                 dot(l, motion.slip) + half * edge.turn.y};
    return edge;
  }
  /// A facet that holds: its strains, and its step up to what decays.
  template <class R>
  BR_HD void begin_move(const LdpmFacet& by, Index i, const Facet<R>& facet,
                        const LdpmEdgeOf<R>& edge, Moving<R>& moving) const {
    const Vec3Of<R> jump = cross(edge.turn, facet.center) + edge.jump;
    by.begin(facet.length, facet.state.strain + edge.over * jump,
             Volumetric<R>{*this, i, facet.volume}, facet.state, dt, moving.step);
    moving.center = facet.center;
    moving.area = facet.area;
    moving.weight = facet.area * facet.length;
    const LdpmFacetStateOf<R> now{{}, {}, moving.step.largest_normal, moving.step.largest_square};
    const R bond = select(by.has_cracked(facet.length, now), constant<R>(0.0), facet.frame.bond);
    const R f[4] = {edge.m.x, edge.m.y, edge.m.z, bond};
    write_records(frame, i, f);
  }
  /// Ends the move of a facet: stresses and energies, force and torque.
  template <class R>
  BR_HD void end_move(const LdpmFacet& by, Index i, const Moving<R>& moving, const R& decay) const {
    LdpmFacetStateOf<R> now;
    const LdpmSpentOf<R> spent = by.end(moving.step, decay, now);
    add(opened, i, moving.weight * spent.fracture);
    add(compacted, i, moving.weight * spent.plastic);
    add(slid, i, moving.weight * spent.friction);
    const R s[8] = {now.strain.x, now.strain.y, now.strain.z,       now.stress.x,
                    now.stress.y, now.stress.z, now.largest_normal, now.largest_square};
    write_records(state, i, s);
    const Vec3Of<R> force = -moving.area * now.stress, turn = cross(moving.center, force);
    const R none = constant<R>(0.0);
    const R share[8] = {force.x, force.y, force.z, turn.x, turn.y, turn.z, none, none};
    write_records(shares, first_share + i, share);
  }
  /// A facet that holds.
  template <class R>
  BR_HD void move(const LdpmFacet& by, Index i, const Facet<R>& facet,
                  const LdpmEdgeOf<R>& edge) const {
    Moving<R> moving;
    begin_move(by, i, facet, edge, moving);
    end_move(by, i, moving, by.decay_of(moving.step));
  }
  /// Change of the distance in the last step: a rigid turn is none. With the old distance D sqrt(1
  /// - y) it is D (1 - sqrt(1 - y)), by its series: y^6 is below rounding.
  template <class R>
  BR_HD R stretched(const PairEnd<R>& one, const PairEnd<R>& other, const R& distance) const {
    const Vec3Of<R> apart = other.position - one.position;
    const Vec3Of<R> step = constant<R>(dt) * (other.velocity - one.velocity);
    const R over = 1.0 / distance;
    const R half = 0.5 * over * dot(step, (apart + apart) - step);  // D y / 2
    const R y = 2.0 * over * half;
    return half * (1.0 + y * (0.25 + y * (0.125 + y * (5.0 / 64.0 + y * (7.0 / 128.0)))));
  }
  template <class R>
  BR_HD static void add(const View<double>& energy, Index i, const R& spent) {
    // Whether a pack has something to add could not be foreseen.
    if (width_of<R> != 1 || any(spent != 0.0)) store(energy, i, load<R>(energy, i) + spent);
  }
  /// A facet whose ends have parted for good.
  BR_HD void release(const LdpmFacet& by, Index i, const Facet<double>& facet) const {
    if (facet.frame.bond >= 0.0) {
      opened[i] += facet.area * facet.length * by.stored(facet.state.stress);
      const LdpmFacetState& s = facet.state;
      state[i] = {s.strain, {}, s.largest_normal, s.largest_square};
      frame[i] = {facet.frame.m, ldpm_released};
    }
    shares[first_share + i] = {};
  }
};
template <class>
LdpmFacetForces forces_of(LdpmFacets& f, const LdpmFacet& law, const LinkSpace& in,
                          Buffer<PairForce>&) {
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
          f.edges.shares.view(),
          0,
          std::as_const(f.edges.of).view(),
          std::as_const(f.edges.leads).view()};
}
inline LdpmEdgeForces edge_forces_of(LdpmFacets& f, const ElementsView& elements,
                                     Buffer<PairForce>& actions, Index first_action) {
  return {elements.state,
          std::as_const(f.a).view(),
          std::as_const(f.b).view(),
          std::as_const(f.edges.leads).view(),
          std::as_const(f.frame).view(),
          std::as_const(f.edges.stiffness).view(),
          std::as_const(f.edges.shares).view(),
          0,
          actions.view(),
          first_action};
}

/// Finds the edges of all facets and their stiffness.
inline void find_edges(LinkSet<LdpmFacet>& set) {
  std::vector<Index> a, b, of(static_cast<std::size_t>(set.size())), leads;
  std::vector<LdpmPlace> place;
  std::vector<LdpmStiffness> stiffness;
  copy_to(a, set.a);
  copy_to(b, set.b);
  copy_to(place, set.place);
  for (const LinkGroup<LdpmFacet>& group : set.groups)
    for (Index i = group.begin; i < group.end; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (i == group.begin || a[at] != a[at - 1] || b[at] != b[at - 1]) {
        leads.push_back(i);
        stiffness.push_back({0.0, 0.0, 0.0, 0.0, group.law.shear_ratio, 0.0});
      }
      of[at] = static_cast<Index>(leads.size()) - 1;
      const Vec3& c = place[at].center;
      const double k =
          max(group.law.young, group.law.densified) * place[at].area / place[at].length;
      LdpmStiffness& sum = stiffness.back();
      sum.straight += k;
      sum.first += k * c.x;
      sum.second += k * c.x * c.x;
      sum.aside += k * (c.y * c.y + c.z * c.z);
    }
  leads.push_back(set.size());
  copy_to(set.edges.of, of);
  copy_to(set.edges.leads, leads);
  copy_to(set.edges.stiffness, stiffness);
}

/// Energies of facets.
struct LdpmShares {
  View<const Index> a;
  View<const LdpmPlace> place;
  View<const LdpmFacetState> state;
  View<const double> opened, compacted, slid;

  BR_HD void add_to(Energies& s, const LdpmFacet& law, Index i) const {
    s.elastic.add(place[i].area * place[i].length * law.stored(state[i].stress));
    s.fracture.add(opened[i]);
    s.plastic.add(compacted[i]);
    s.friction.add(slid[i]);
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
