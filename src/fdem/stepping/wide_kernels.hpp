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
    const Index first = read_now(&all.starts[vertex]);
    loaded.count = read_now(&all.starts[vertex + 1]) - first;
    loaded.leader = -1;
    loaded.mass = 0.0;
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
    if (loaded.count > width) {
      if (i % width == 0) all(i / width);
      return;
    }
    const LaneGroup<width> group;
    Vec2 sum{};
    double total = 0.0;
    for (int k = 0; k < loaded.count; ++k) {
      const Vec2 other{group.from(k, loaded.force.x), group.from(k, loaded.force.y)};
      const double other_mass = group.from(k, loaded.mass);
      if (group.from(k, loaded.leader) != loaded.leader) continue;
      sum += other;
      total += other_mass;
    }
    if (i % width < loaded.count)
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

  struct Loaded {
    Index a, b, parent_joint;
    double scale, stiffness, drag, work, slid, sprung;
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
    const Index c = i / width;
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
  }
  BR_HD void update(Index i, Loaded& loaded) const { at(all.dt, i, loaded); }
  BR_HD void update_at(const StepTime& now, Index i, Loaded& loaded) const {
    at(now.last_dt, i, loaded);
  }

 private:
  BR_HD void at(double dt, Index i, Loaded& loaded) const {
    const Index c = i / width;
    const Place place(i);
    const LaneGroup<width> group;
    const auto from = [group](int lane, double x) { return group.from(lane, x); };
    const auto vector_from = [&](int thread, const Vec2& v) {
      return Vec2{from(thread, v.x), from(thread, v.y)};
    };
    const bool leads = place.edge == 0;
    CoupleState& kept = all.state[c];
    const bool is_new = loaded.scale == 0.0;
    if (is_new) loaded.scale = 1.0;

    Vec2 own[3], other[3], other_v[3];
    for (int k = 0; k < 3; ++k) {
      own[k] = loaded.corner[k].position;
      other[k] = loaded.other[k].position;
      other_v[k] = loaded.other[k].velocity;
    }
    EdgePush mine;
    FrictionWork friction_work;
    Vec2 sum{};
    unsigned touching = 0;  // edges that do
    if (boxes_meet(own, other)) {
      const ContactPair law = all.law_of(c);
      if (is_new && loaded.parent_joint >= 0) {
        if (leads) cold_begin(&all, c);
        group.wait();
        loaded.scale = kept.scale;
        loaded.stiffness = kept.stiffness;
        loaded.drag = kept.drag[place.edge];
        loaded.work = kept.work;
        loaded.sprung = kept.sprung;
        group.wait();
      }
      double scale = loaded.scale;
      if (all.rebound.loses()) {
        const double most = kept.most;
        group.wait();
        const auto now = cold_unloading(&all, c, scale * law.penalty, most);
        scale *= now.share;
        if (leads) kept.most = now.most;
      }
      mine = edge_push(law, scale, loaded.stiffness, loaded.drag, dt, loaded.corner[0],
                       loaded.corner[1], Target::of(other), other_v);
      kept.drag[place.edge] = mine.drag;
      touching = group.ballot(mine.touches) & 0x3fU;
      double stiffness = 0.0;
      for (int s = 0; s < 6; ++s) {
        if ((touching >> s & 1U) == 0) continue;
        stiffness = max(stiffness, from(s, mine.stiffness));
        friction_work.add(from(s, mine.taken), from(s, mine.sprung));
        const double at_a[3] = {from(s, mine.overlap.at_a[0]), from(s, mine.overlap.at_a[1]),
                                from(s, mine.overlap.at_a[2])};
        const double at_b[3] = {from(s, mine.overlap.at_b[0]), from(s, mine.overlap.at_b[1]),
                                from(s, mine.overlap.at_b[2])};
        const double share_a = at_a[place.of == 0 ? 0 : place.of == 1 ? 1 : 2];
        const double share_b = at_b[place.of == 0 ? 0 : place.of == 1 ? 1 : 2];
        const bool of_own = (s < 3) == place.of_a;
        const int k = s < 3 ? s : s - 3, next = k == 2 ? 0 : k + 1;
        const auto add = [&](const Vec2& first, const Vec2& second) {
          if (!of_own)
            sum -= share_a * first + share_b * second;
          else if (place.of == k)
            sum += first;
          else if (place.of == next)
            sum += second;
        };
        add(vector_from(s, mine.normal[0]), vector_from(s, mine.normal[1]));
        if (law.friction > 0.0)
          add(vector_from(s, mine.friction[0]), vector_from(s, mine.friction[1]));
      }
      if (touching != 0 && leads) kept.stiffness = stiffness;
      if (touching != 0 && all.conservative)
        sum += cold_shape_force(&all, c, scale * law.penalty, place.of_a, place.of);
    }
    if (is_new && leads) kept.scale = loaded.scale;

    CoupleForceOf<Number>& both = all.force[c];
    Vec2Of<Number>& stored = (place.of_a ? both.on_a : both.on_b).at[place.of];
    if (touching == 0 && loaded.work == 0.0 && loaded.slid == 0.0) {
      stored = {};
      return;
    }
    const Vec2 last = converted<double>(stored);
    group.wait();  // two threads read and write the sixth corner
    const Vec2Of<Number> now = converted<Number>(sum);
    stored = now;
    const double taken = 0.5 * dt * dot(last + converted<double>(now), loaded.corner[0].velocity);
    for (int k = 0; k < 3; ++k) {
      loaded.work -= from(k, taken);
      loaded.work -= from(k + 3, taken);
    }
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
