#pragma once
// Cohesive links of concrete: arrays, forces, energies.

#include "dem/lanes/single_ends.hpp"
#include "dem/laws/concrete_link.hpp"
#include "dem/links/link_set.hpp"
#include "math/constants.hpp"
#include "math/lanes.hpp"
#include "math/rounding.hpp"

namespace breccia::dem {

/// History of cohesive links from step to step.
template <class Number>
struct LinkHistory {
  Buffer<Number> opening;   ///< largest so far, or link_broken, link_released  [m]  (pairs)
  PlanesOf<Number> shear;   ///< F_s on b  [N]  (pairs)
  PlanesOf<Number> moment;  ///< M on b  [N m]  (pairs)
};

/// Laws of the groups, and with constants in single precision for links that compute so.
template <>
struct GroupLaws<ConcreteLink> {
  Buffer<ConcreteLink> laws;
  Buffer<ConcreteLinkOf<float>> in_single;
  Buffer<Index> ends;  ///< as GroupLaws

  template <class Form>
  const Buffer<Form>& as() const {
    if constexpr (std::is_same_v<Form, ConcreteLink>)
      return laws;
    else
      return in_single;
  }
};

/// Cohesive links. Never removed: a broken one answers as the contact that is left of it.
template <>
struct LinkArrays<ConcreteLink> : LinkEnds {
  static constexpr LinkKind kind = LinkKind::concrete;
  static constexpr const char* name = "concrete";
  static constexpr bool swept = true;

  Precision precision = Precision::full;  ///< of `kept`
  Buffer<double> length;                  ///< D_eq  [m]  (set-up; pairs: compaction)
  Buffer<double> stiffness;               ///< K_n  [N/m]  (constant)
  Buffer<double> area;                    ///< S  [m2]  (constant)
  Stored<LinkHistory> kept;
  Buffer<double> slid;     ///< energy spent on sliding so far  [J]  (pairs)
  Buffer<double> yielded;  ///< energy spent on plastic moments so far  [J]  (pairs)
  Buffer<double> broke;    ///< energy that its rupture spent  [J]  (pairs)
  bool rated = false;  ///< whether the strength of some link depends on its strain rate  (constant)
  Buffer<double> rate;  ///< LinkState::rate; empty if not rated  [1/s or -]
  bool damped = false;  ///< whether some link has a damping branch; otherwise the next three are
                        ///< empty  (constant)
  Buffer<float> branch_normal;  ///< LinkState::branch; it fades, so that few digits do  [N] (pairs)
  PlanesOf<float> branch_shear;  ///< likewise  [N]  (pairs)
  Buffer<double> damped_away;    ///< energy that the branch has taken so far  [J]  (pairs)

  template <class Visit>
  void each_field(Visit&& field) {
    LinkEnds::each_field(field);
    field("length", "m", length);
    field("stiffness", "N/m", stiffness);
    field("area", "m2", area);
    with_number(precision, [&, this](auto number) {
      auto& history = kept.as<decltype(number)>();
      field("opening", "m", history.opening);
      field("shear", "N", history.shear);
      field("moment", "N m", history.moment);
    });
    field("slid", "J", slid);
    field("yielded", "J", yielded);
    field("broke", "J", broke);
    if (rated) field("rate", "1/s", rate);
    if (!damped) return;
    field("branch_normal", "N", branch_normal);
    field("branch_shear", "N", branch_shear);
    field("damped_away", "J", damped_away);
  }
  /// State of a link. All arrays on the host.
  LinkState<double> state_of(const ConcreteLink& law, Index i) const {
    return with_number(precision, [&](auto number) {
      const auto& history = kept.as<decltype(number)>();
      LinkState<double> state{history.opening.data()[i], history.shear.view()[i],
                              history.moment.view()[i]};
      if (law.damps()) state.branch = {branch_normal.data()[i], branch_shear.view()[i]};
      return state;
    });
  }
  /// Constants of a link as it stands. All arrays on the host.
  LinkConstants<double> constants(const ConcreteLink& law, Index i, double opening,
                                  double touching) const {
    LinkConstants<double> link{length.data()[i], stiffness.data()[i], area.data()[i],
                               0.5 * touching, touching};
    if (law.rated()) link.factor = law.factor_of(link, opening, rate.data()[i]);
    return link;
  }

  template <class Number>
  struct Below {
    View<const Number> opening;
    double limit;
    BR_HD bool operator()(Index i) const { return opening[i] < limit; }
  };
  template <class Number>
  Below<Number> broken() const {
    return {kept.as<Number>().opening.view(), 0.0};
  }
  template <class Number>
  Below<Number> released() const {
    return {kept.as<Number>().opening.view(), 0.5 * (link_broken + link_released)};
  }
};
using ConcreteLinks = LinkArrays<ConcreteLink>;

/// Cohesive links of one material, one link (R = double) or a pack of neighbours at a time.
/// @tparam Number   what the links' history and actions are stored in, and Single, too, what they
///                  are computed in
/// @tparam Actions  where actions go
template <class Number, class Actions = View<PairForceOf<StoredAs<Number>>>>
struct ConcreteLinkForces {
  static constexpr const char* name = "dem.concrete_links";
  static constexpr bool swept = ConcreteLinks::swept;
  static constexpr int least_blocks = 4;  // 128 registers
  using Stores = StoredAs<Number>;
  using Item = ComputedIn<Number>;
  using Law = ConcreteLinkOf<ConstantOf<Item>>;
  Law law;
  double dt;  ///< the step that moved the elements to where they are  [s]
  ElementsView elements;
  View<const Index> a, b;
  View<double> length;
  View<const double> stiffness, area;
  View<Stores> opening;
  PlanesView<Stores> shear, moment;
  View<double> slid, yielded, broke, rate;
  View<float> branch_normal;
  PlanesView<float> branch_shear;
  View<double> damped_away;
  Actions actions;
  Index first_action;  ///< action of link 0
  std::int64_t step;   ///< steps taken before
  bool evaluates;      ///< as StepTime: otherwise stiffnesses of actions stay as they are

  template <class R>
  struct Loaded {
    Indices<R> a, b;
    Wide<R> length;
    R stiffness, area;
    LinkState<R> state;
    LinkPair<R> ends;
  };
  template <class R>
  BR_HD void load_early(Index i, Loaded<R>& loaded) const {
    loaded.a = load_indices_now<R>(a, i);
    loaded.b = load_indices_now<R>(b, i);
    loaded.length = load_wide_now<R>(length, i);
    loaded.stiffness = load_now<R>(stiffness, i);
    loaded.area = load_now<R>(area, i);
    loaded.state = {load_now<R>(opening, i), load_now<R>(shear, i), load_now<R>(moment, i)};
  }
  template <class R>
  BR_HD void load_late(Index, Loaded<R>& loaded) const {
    if constexpr (is_single<R>)
      loaded.ends = load_single_pair(elements.state, loaded.a, loaded.b, loaded.length);
    else
      loaded.ends = load_pair<R>(elements.state, loaded.a, loaded.b);
  }
  template <class R>
  BR_HD void update(Index i, const Loaded<R>& loaded) const {
    update(law, i, loaded);
  }
  /// @tparam parts  those that `by` may have
  template <ConcreteParts parts = concrete_all, class R>
  BR_HD void update(const Law& by, Index i, const Loaded<R>& loaded) const {
    LinkState<R> state = loaded.state;
    if (by.template damps<parts>())
      state.branch = {load<R>(branch_normal, i), load<R>(branch_shear, i)};
    if constexpr (has_idle_together<Actions>) {
      const R distance = norm(loaded.ends.motion.way);
      const LinkConstants<R> link = constants(loaded, distance, loaded.ends.touching());
      if (by.template is_idle<parts>(link, distance, state))
        return leave_idle<parts>(by, i, link, distance, state.opening);
    }
    const PairMotion<R> motion = pair_motion<R>(loaded.ends.motion, loaded.ends.difference(), dt);
    const LinkConstants<R> link = constants(loaded, motion.distance, loaded.ends.touching());
    if (by.template rated<parts>()) state.rate = load<R>(rate, i);
    const LinkResponse<R> r = by.template response<parts>(link, motion, state);

    if constexpr (std::is_same_v<Number, float>) {
      const BitsOf<R> chance = chance_of(motion.distance, step);
      state.shear = rounded_by(chance, 0, state.shear);
      state.moment = rounded_by(chance, 18, state.moment);
      if (by.template wears<parts>()) state.opening = rounded_by<R>(chance >> 35, state.opening);
    }
    store(opening, i, state.opening);
    store(shear, i, state.shear);
    store(moment, i, state.moment);
    if (by.template rated<parts>()) store(rate, i, state.rate);
    if (by.template damps<parts>()) {
      store(branch_normal, i, state.branch.normal);
      store(branch_shear, i, state.branch.shear);
      if (any(r.damped != 0.0)) book(actions, damped_away, i, r.damped);
    }
    if (any(r.shortened != 0.0)) add_to(length, i, -r.shortened);
    if (any(r.slid != 0.0)) book(actions, slid, i, r.slid);
    if (any(r.yielded != 0.0)) book(actions, yielded, i, r.yielded);
    if (any(r.broke != 0.0)) book(actions, broke, i, r.broke);

    const Vec3Of<R> force = r.shear - r.normal * motion.normal;
    if (!evaluates) return write_push(actions, first_action + i, motion, force, r.moment);
    const R kn = r.active * link.stiffness, kt = by.shear_ratio * kn;
    const R kr = by.rolling_ratio * kt * link.radius * link.radius;
    write_pair_force(actions, first_action + i, motion, force, r.moment, kn, kt, kr, kr);
  }
  /// State of a link.
  BR_HD LinkState<double> state_of(Index i) const {
    LinkState<double> state{opening[i], shear[i], moment[i]};
    if (law.rated()) state.rate = rate[i];
    if (law.damps()) state.branch = {branch_normal[i], branch_shear[i]};
    return state;
  }
  BR_HD void set(const StepTime& now) {
    dt = now.last_dt;
    step = now.step;
    evaluates = now.evaluates;
  }
  BR_WHOLE BR_HD void operator()(Index i) const { run_at<Item>(*this, i); }

 private:
  /// Stores and writes as response() does for an idle link.
  template <ConcreteParts parts, class R>
  BR_HD void leave_idle(const Law& by, Index i, const LinkConstants<R>& link, const R& distance,
                        const R& kept) const {
    const R zero = constant<R>(0.0);
    const Vec3Of<R> none{zero, zero, zero};
    store(opening, i,
          select(Law::is_parted(link, distance, kept), constant<R>(link_released), kept));
    store(shear, i, none);
    store(moment, i, none);
    if (by.template damps<parts>()) {
      store(branch_normal, i, zero);
      store(branch_shear, i, none);
    }
    R nothing[9];
    for (R& number : nothing) number = zero;
    if (!evaluates) return write_numbers(actions, first_action + i, nothing);
    write_actions(actions, first_action + i, nothing, nothing);
  }
  template <class R>
  BR_HD LinkConstants<R> constants(const Loaded<R>& loaded, const R& distance,
                                   const R& touching) const {
    if constexpr (is_single<R>) {
      LinkConstants<R> link{narrowed(loaded.length), loaded.stiffness, loaded.area, 0.5 * touching,
                            touching};
      link.stretch = loaded.ends.excess / (distance + link.length);
      link.chance = chance_of(distance, step);
      return link;
    } else {
      return {loaded.length, loaded.stiffness, loaded.area, 0.5 * touching, touching};
    }
  }
};

/// @param actions  where they go
template <class Number, class Actions>
ConcreteLinkForces<Number, Actions> forces_of(ConcreteLinks& c, const ConcreteLink& law,
                                              const LinkSpace& in, const Actions& actions) {
  LinkHistory<StoredAs<Number>>& kept = c.kept.as<Number>();
  return {law.as<ConstantOf<ComputedIn<Number>>>(),
          in.dt,
          in.elements,
          c.a.view(),
          c.b.view(),
          c.length.view(),
          c.stiffness.view(),
          c.area.view(),
          kept.opening.view(),
          kept.shear.view(),
          kept.moment.view(),
          c.slid.view(),
          c.yielded.view(),
          c.broke.view(),
          c.rate.view(),
          c.branch_normal.view(),
          c.branch_shear.view(),
          c.damped_away.view(),
          actions,
          0,
          in.step,
          in.evaluates};
}

/// Parts of the law that some of the links have.
inline ConcreteParts parts_of(const LinkSet<ConcreteLink>& set) {
  ConcreteParts parts = 0;
  for (const LinkGroup<ConcreteLink>& group : set.groups) parts |= group.law.parts();
  return parts;
}

/// Energies of cohesive links.
template <class Number>
struct ConcreteShares {
  View<const ElementState> state_of;
  View<const Index> a, b;
  View<const double> length, stiffness, area;
  View<const Number> opening;
  PlanesView<const Number> shear, moment;
  View<const double> slid, yielded, broke, rate;
  View<const float> branch_normal;
  PlanesView<const float> branch_shear;
  View<const double> damped_away;

  /// Energies of link i, or of a pack.
  template <class R>
  BR_HD void add_to(EnergiesOf<R>& s, const ConcreteLink& law, Index i) const {
    const LinkPair<R> ends = load_pair<R>(state_of, load_indices<R>(a, i), load_indices<R>(b, i));
    const R touching = ends.touching();
    LinkConstants<R> link{load<R>(length, i), load<R>(stiffness, i), load<R>(area, i),
                          0.5 * touching, touching};
    LinkState<R> state{load<R>(opening, i), load<R>(shear, i), load<R>(moment, i)};
    if (law.rated()) link.factor = law.factor_of<R>(link, state.opening, load<R>(rate, i));
    const R stretch = norm(ends.motion.way) - link.length;
    if (law.damps()) {
      state.branch = {load<R>(branch_normal, i), load<R>(branch_shear, i)};
      s.damping.add(load<R>(damped_away, i));
    }
    s.elastic.add(law.stored(link, stretch, state));
    s.fracture.add(load<R>(broke, i));
    s.fracture.add(select(state.opening >= 0.0, law.spent(link, state.opening), constant<R>(0.0)));
    s.plastic.add(load<R>(yielded, i));
    s.friction.add(load<R>(slid, i));
  }
};

template <class Number>
ConcreteShares<Number> shares_of(const ConcreteLinks& c, const View<const ElementState>& state) {
  const LinkHistory<Number>& kept = c.kept.as<Number>();
  return {state,
          c.a.view(),
          c.b.view(),
          c.length.view(),
          c.stiffness.view(),
          c.area.view(),
          kept.opening.view(),
          kept.shear.view(),
          kept.moment.view(),
          c.slid.view(),
          c.yielded.view(),
          c.broke.view(),
          c.rate.view(),
          c.branch_normal.view(),
          c.branch_shear.view(),
          c.damped_away.view()};
}

/// How far a link has gone. All arrays on the host.
inline LinkStage stage_of(const ConcreteLink& law, const ConcreteLinks& c, const Elements&,
                          Index i) {
  const double opening = with_number(c.precision, [&](auto number) -> double {
    return c.kept.as<decltype(number)>().opening.data()[i];
  });
  if (opening < 0.0) return LinkStage::broken;
  const double onset = law.tension(c.constants(law, i, opening, 0.0)).onset();
  return opening > onset ? LinkStage::softened : LinkStage::whole;
}

}  // namespace breccia::dem
