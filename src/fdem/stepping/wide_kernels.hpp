#pragma once
// Kernels that a device alone runs: they give several threads to one item, or bound the registers
// of one thread. Forces are those of the kernels of all machines, to the bit.

#include "core/timed.hpp"
#include "exec/early.hpp"
#include "exec/lockstep.hpp"
#include "fdem/contact/couples.hpp"
#include "fdem/triangles/triangle_kernels.hpp"

namespace breccia::fdem {

/// BundleForces by sixteen threads a vertex, each with a corner: all see every corner's force and
/// add those of their own bundle up, in the same order.
struct BundlesWide {
  static constexpr const char* name = "fdem.bundles_wide";
  static constexpr Index width = 16;
  BundleForces all;
  BR_HD void set(const StepTime&) {}
  struct Loaded {
    Index count, leader, node;
    double mass;
    Vec2 force;
  };
  BR_HD void load_early(Index i, Loaded& loaded) const {
    const Index vertex = i / width, part = i % width;
    loaded.count = 0;
    loaded.leader = -1;
    loaded.mass = 0.0;
    if (vertex + 1 >= all.starts.size) return;
    const Index first = read_now(&all.starts[vertex]);
    loaded.count = read_now(&all.starts[vertex + 1]) - first;
    if (part >= loaded.count) return;
    loaded.leader = read_now(&all.leader[first + part]) - first;
    loaded.node = read_now(&all.nodes[first + part]);
    loaded.mass = read_now(&all.mass[loaded.node / 3]);
  }
  BR_HD void load_late(Index i, Loaded& loaded) const {
    loaded.force = {};
    if (i % width < loaded.count)
      loaded.force = read_record_now(&all.force[loaded.node / 3].at[loaded.node % 3]);
  }
  BR_HD void update(Index i, const Loaded& loaded) const {
    const bool fits = loaded.count <= width;
    const Index corners = fits ? loaded.count : 0;
    const LaneGroup<width> group;
    Vec2 sum{};
    double total = 0.0;
    for (int k = 0; group.any_of_warp(k < corners); ++k) {
      const Vec2 other{group.from(k, loaded.force.x), group.from(k, loaded.force.y)};
      const double other_mass = group.from(k, loaded.mass);
      if (group.from(k, loaded.leader) != loaded.leader || k >= corners) continue;
      sum += other;
      total += other_mass;
    }
    if (!fits && i % width == 0) all(i / width);
    if (i % width < corners)
      all.force[loaded.node / 3].at[loaded.node % 3] = loaded.mass * ((1.0 / total) * sum);
  }
};

/// Work that few couples need.
template <class Number>
BR_COLD void cold_begin(const CoupleForces<Number>* couples, Index c) {
  stay_in_place(couples);
  couples->begin(c);
}
template <class Number>
BR_COLD Vec2 cold_shape_force(const CoupleForces<Number>* couples, Index c, double penalty,
                              bool of_a, int corner) {
  stay_in_place(couples);
  return couples->shape_force(c, penalty, of_a, corner);
}

template <class Number>
BR_COLD typename CoupleForces<Number>::Unloading cold_unloading(const CoupleForces<Number>* couples,
                                                                Index c, double penalty,
                                                                double most) {
  stay_in_place(couples);
  return couples->unloading(c, penalty, most);
}

/// CoupleForces by eight threads a couple, of which six each take an edge, and then a corner: every
/// corner adds up what edges do to it in their order.
template <class Number>
struct CouplesWide {
  static constexpr const char* name = "fdem.couples";
  static constexpr Index width = 8;
  CoupleForces<Number> all;

  BR_HD void set(const StepTime& now) { all.set(now); }
  BR_HD Index items() const { return all.a.size; }
  /// Threads beyond the last couple look at it, too, and leave it alone.
  BR_HD Index couple_of(Index i) const {
    const Index last = items() - 1;
    return i / width < last ? i / width : last;
  }

  struct Loaded {
    Index a, b, parent_joint;
    double scale, stiffness, drag, work, slid, sprung;
    Vec2Of<Number> last;  ///< force on the own corner before
    Index law;
    NodeState corner[3];  ///< of the own triangle, from the own one on
    NodeState other[3];
  };
  struct Place {
    int edge;  ///< and corner: 0 to 2 of a, 3 to 5 of b; two threads repeat the last
    int of;    ///< in its triangle
    bool of_a, repeats;
    BR_HD explicit Place(Index i) {
      const int lane = i % width;
      edge = lane < 6 ? lane : 5;
      repeats = lane >= 6;
      of_a = edge < 3;
      of = of_a ? edge : edge - 3;
    }
  };
  BR_HD void load_early(Index i, Loaded& loaded) const {
    const Index c = couple_of(i);
    const CoupleState& kept = all.state[c];
    loaded.a = read_now(&all.a[c]);
    loaded.b = read_now(&all.b[c]);
    loaded.parent_joint = read_now(&all.parent_joint[c]);
    loaded.scale = read_now(&kept.scale);
    loaded.stiffness = read_now(&kept.stiffness);
    loaded.drag = read_now(&kept.drag[Place(i).edge]);
    loaded.work = read_now(&kept.work);
    loaded.slid = read_now(&kept.slid);
    loaded.sprung = read_now(&kept.sprung);
    const Vec2Of<Number>* const last = force_at(c, Place(i));
    loaded.last = {read_now(&last->x), read_now(&last->y)};
  }
  BR_HD void load_late(Index i, Loaded& loaded) const {
    const Place place(i);
    const NodeState* const own = all.nodes[place.of_a ? loaded.a : loaded.b].at;
    const NodeState* const others = all.nodes[place.of_a ? loaded.b : loaded.a].at;
    for (int k = 0; k < 3; ++k) {
      const int at = place.of + k;
      loaded.corner[k] = read_record_now(own + (at < 3 ? at : at - 3));
      loaded.other[k] = read_record_now(others + k);
    }
    loaded.law = all.number_of_law(loaded.a, loaded.b);
  }
  BR_HD void update(Index i, Loaded& loaded) const { at(all.dt, i, loaded); }
  BR_HD void update_at(const StepTime& now, Index i, Loaded& loaded) const {
    at(now.last_dt, i, loaded);
  }

 private:
  BR_HD Vec2Of<Number>* force_at(Index c, const Place& place) const {
    CoupleForceOf<Number>& both = all.force[c];
    return (place.of_a ? both.on_a : both.on_b).at + place.of;
  }
  BR_HD void at(double dt, Index i, Loaded& loaded) const {
    const Index c = couple_of(i);
    const bool is_item = i / width < items();
    const Place place(i);
    const LaneGroup<width> group;
    const auto from = [group](int lane, double x) { return group.from(lane, x); };
    const auto vector_from = [&](int thread, const Vec2& v) {
      return Vec2{from(thread, v.x), from(thread, v.y)};
    };
    const bool leads = place.edge == 0;
    CoupleState& kept = all.state[c];
    const ContactPair law = all.laws[loaded.law];
    const bool waits = all.phase[c] == CouplePhase::waits;
    const bool is_new = loaded.scale == 0.0 && !waits;
    if (is_new) loaded.scale = 1.0;

    Vec2 own[3], other[3], other_v[3];
    for (int k = 0; k < 3; ++k) {
      own[k] = loaded.corner[k].position;
      other[k] = loaded.other[k].position;
      other_v[k] = loaded.other[k].velocity;
    }
    const bool near = is_item && !waits && boxes_meet(own, other);
    const bool begins = near && is_new && loaded.parent_joint >= 0;
    if (group.any_of_warp(begins)) {
      if (begins && leads) cold_begin(&all, c);
      group.wait();
      if (begins) {
        loaded.scale = kept.scale;
        loaded.stiffness = kept.stiffness;
        loaded.drag = kept.drag[place.edge];
        loaded.work = kept.work;
        loaded.sprung = kept.sprung;
      }
      group.wait();
    }
    EdgePush mine{};
    double scale = loaded.scale;
    if (all.rebound.loses()) {
      const double most = kept.most;
      group.wait();
      if (near) {
        const auto now = cold_unloading(&all, c, scale * law.penalty, most);
        scale *= now.share;
        if (leads) kept.most = now.most;
      }
    }
    if (near) {
      edge_push(law, scale, loaded.stiffness, loaded.drag, dt, loaded.corner[0], loaded.corner[1],
                Target::of(other), other_v, mine);
      kept.drag[place.edge] = mine.drag;
    }
    FrictionWork friction_work;
    Vec2 sum{};
    double stiffness = 0.0;
    const unsigned touching = group.ballot(mine.touches) & 0x3fU;  // edges that do
    for (int s = 0; s < 6; ++s) {
      const bool touches = (touching >> s & 1U) != 0;
      if (!group.any_of_warp(touches)) continue;
      const double stiffness_of = from(s, mine.stiffness), taken = from(s, mine.taken),
                   sprung = from(s, mine.sprung);
      const double at_a[3] = {from(s, mine.overlap.at_a[0]), from(s, mine.overlap.at_a[1]),
                              from(s, mine.overlap.at_a[2])};
      const double at_b[3] = {from(s, mine.overlap.at_b[0]), from(s, mine.overlap.at_b[1]),
                              from(s, mine.overlap.at_b[2])};
      const Vec2 normal[2] = {vector_from(s, mine.normal[0]), vector_from(s, mine.normal[1])},
                 friction[2] = {vector_from(s, mine.friction[0]), vector_from(s, mine.friction[1])};
      if (!touches) continue;
      stiffness = max(stiffness, stiffness_of);
      friction_work.add(taken, sprung);
      const double share_a = at_a[place.of == 0 ? 0 : place.of == 1 ? 1 : 2];
      const double share_b = at_b[place.of == 0 ? 0 : place.of == 1 ? 1 : 2];
      const bool of_own = (s < 3) == place.of_a;
      const int k = s < 3 ? s : s - 3, next = k == 2 ? 0 : k + 1;
      const auto add = [&](const Vec2(&at_end)[2]) {
        if (!of_own)
          sum -= share_a * at_end[0] + share_b * at_end[1];
        else if (place.of == k)
          sum += at_end[0];
        else if (place.of == next)
          sum += at_end[1];
      };
      add(normal);
      if (law.friction > 0.0) add(friction);
    }
    if (touching != 0 && leads) kept.stiffness = stiffness;
    if (touching != 0 && all.conservative)
      sum += cold_shape_force(&all, c, scale * law.penalty, place.of_a, place.of);
    if (is_item && is_new && leads) kept.scale = loaded.scale;

    if (is_item && leads && !waits)
      all.phase[c] = touching != 0 ? CouplePhase::acts : CouplePhase::rests;
    Vec2Of<Number>& stored = *force_at(c, place);
    const bool rests = touching == 0 && loaded.work == 0.0 && loaded.slid == 0.0;
    const bool works = is_item && !rests;
    if (is_item && rests) stored = {};
    if (!group.any_of_warp(works)) return;
    const Vec2Of<Number> now = converted<Number>(sum);
    group.wait();  // all have read what three threads write, the sixth corner
    if (works) stored = now;
    const double taken =
        0.5 * dt *
        dot(converted<double>(loaded.last) + converted<double>(now), loaded.corner[0].velocity);
    for (int k = 0; k < 3; ++k) {
      loaded.work -= from(k, taken);
      loaded.work -= from(k + 3, taken);
    }
    if (!works) return;
    friction_work.book(loaded.slid, loaded.sprung);
    if (touching == 0) {
      kept.drag[place.edge] = 0.0;
      if (leads) {
        kept.lost += loaded.work - loaded.slid;
        kept.rubbed += loaded.slid;
        kept.scale = 1.0;
        kept.most = kept.stiffness = 0.0;
      }
      loaded.work = loaded.slid = 0.0;
    }
    if (leads) {
      kept.work = loaded.work;
      kept.slid = loaded.slid;
      kept.sprung = loaded.sprung;
    }
  }
};

}  // namespace breccia::fdem
