#pragma once
// Couples as a device evaluates those with more to do than others: four threads take one. Forces
// are those of CoupleForces, to the bit.

#include "exec/early.hpp"
#include "exec/group_memory.hpp"
#include "exec/lockstep.hpp"
#include "fdem/contact/couples.hpp"
#include "fdem_shared/busy_items.hpp"

namespace breccia::fdem {

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

/// For lists of busy couples: what a broken joint hands to one it has when it is listed.
template <class Number>
struct BeginningCouples : CoupleForces<Number> {
  using Base = CoupleForces<Number>;
  BR_HD bool update(Index i, const typename Base::Loaded& loaded) const {
    if (Base::update(i, loaded)) return true;
    if (loaded.phase == CouplePhase::acts && this->parent_joint[i] >= 0 &&
        this->state[i].scale == 0.0)
      cold_begin<Number>(this, i);
    return false;
  }
};

/// CoupleForces by four threads a couple. Three of them have a corner of each triangle, which they
/// show to the others, and ask for one area coordinate of all: together they know which of the six
/// edges may overlap, three or four of most couples that touch. Each takes one of these; then
/// every corner adds up what edges do to it in their order.
/// @tparam any_couple  those that joints begin, too, conservative or with losses
template <class Number, bool any_couple>
struct CouplesWide {
  static constexpr const char* name = "fdem.couples";
  static constexpr Index width = 4;
  CoupleForces<Number> all;

  BR_HD void set(const StepTime& now) { all.set(now); }
  BR_HD Index items() const { return all.a.size; }

  struct Loaded {
    Index a, b, parent_joint, law;
    double scale, stiffness, work, slid, sprung;
    // Of a, then of b:
    double drag[2];          ///< of the own edges
    Vec2Of<Number> last[2];  ///< forces on the own corners before
    NodeState corner[2];     ///< the own ones
  };
  BR_HD void load_early(Index i, Loaded& loaded) const {
    const Index c = couple_of(i);
    const int own = corner_of(i);
    const CoupleState& kept = all.state[c];
    loaded.a = read_now(&all.a[c]);
    loaded.b = read_now(&all.b[c]);
    if constexpr (any_couple) loaded.parent_joint = read_now(&all.parent_joint[c]);
    loaded.scale = read_now(&kept.scale);
    loaded.stiffness = read_now(&kept.stiffness);
    loaded.work = read_now(&kept.work);
    loaded.slid = read_now(&kept.slid);
    loaded.sprung = read_now(&kept.sprung);
    for (int side = 0; side < 2; ++side) {
      loaded.drag[side] = read_now(&kept.drag[3 * side + own]);
      const Vec2Of<Number>* const last = force_at(c, side, own);
      loaded.last[side] = {read_now(&last->x), read_now(&last->y)};
    }
  }
  BR_HD void load_late(Index i, Loaded& loaded) const {
    const int own = corner_of(i);
    loaded.corner[0] = read_record_now(all.nodes[loaded.a].at + own);
    loaded.corner[1] = read_record_now(all.nodes[loaded.b].at + own);
    loaded.law = all.number_of_law(loaded.a, loaded.b);
  }
  BR_HD void update(Index i, Loaded& loaded) const { at(all.dt, i, loaded); }
  BR_HD void update_at(const StepTime& now, Index i, Loaded& loaded) const {
    at(now.last_dt, i, loaded);
  }

 private:
  /// Threads beyond the last couple look at it, too, and leave it alone.
  BR_HD Index couple_of(Index i) const {
    const Index last = items() - 1;
    return i / width < last ? i / width : last;
  }
  BR_HD static int corner_of(Index i) {
    const auto lane = static_cast<int>(i % width);
    return lane < 3 ? lane : 2;  // two threads have the last one
  }
  BR_HD Vec2Of<Number>* force_at(Index c, int side, int corner) const {
    CoupleForceOf<Number>& both = all.force[c];
    return (side == 0 ? both.on_a : both.on_b).at + corner;
  }

  /// Forces and work of an edge, as the others need to know them.
  struct ShownPush {
    Vec2 normal[2], friction[2];  ///< on its ends  [N/m]
    double taken, sprung;         ///< [J/m]
  };
  /// Memory in which the threads of a couple show each other what they know.
  struct alignas(16) Shown {
    NodeState corner[2][3];  ///< of a, of b
    ShownPush push[width];
    double in_other[2][3][3];  ///< coordinates of corners of a in b, and of b in a
    double drag[6];            ///< of edges, before
  };
  static_assert(sizeof(Shown) % 128 == 64);  // groups side by side write to banks of their own

  /// Whether boxes around the two have a point in common.
  BR_HD static bool near(const LaneGroup<width>& group, const Vec2& own, const Vec2 (&others)[3]) {
    const auto all_of = [&](bool a, bool b, bool c) {
      return (group.ballot(a && b && c) & 7U) == 7U;
    };
    const Vec2 &p = others[0], &q = others[1], &r = others[2];
    const bool left = all_of(own.x < p.x, own.x < q.x, own.x < r.x),
               right = all_of(own.x > p.x, own.x > q.x, own.x > r.x),
               below = all_of(own.y < p.y, own.y < q.y, own.y < r.y),
               above = all_of(own.y > p.y, own.y > q.y, own.y > r.y);
    return !(left || right || below || above);
  }
  /// Edges that may overlap the other triangle, a bit each: 0 to 2 of a, 3 to 5 of b. Fills
  /// `in_other`.
  BR_HD static unsigned may_overlap(const LaneGroup<width>& group, Shown& shown, int own,
                                    const Vec2 (&x)[2][3]) {
    const Target of[2] = {Target::of(x[0]), Target::of(x[1])};
    unsigned beyond = 0;  // edges that lie outside by the own coordinate
    for (int side = 0; side < 2; ++side) {
      double at[3];
      for (int k = 0; k < 3; ++k) {
        at[k] = of[1 - side].coordinate(own, x[side][k]);
        shown.in_other[side][k][own] = at[k];
      }
      for (int k = 0; k < 3; ++k)
        if (at[k] <= 0.0 && at[k == 2 ? 0 : k + 1] <= 0.0) beyond |= 1U << (3 * side + k);
    }
    return ~(group.from(0, beyond) | group.from(1, beyond) | group.from(2, beyond)) & 0x3fU;
  }
  /// Of a triangle's corners.
  struct Velocities {
    const NodeState (&corner)[3];
    BR_HD const Vec2& operator[](int k) const { return corner[k].velocity; }
  };

  BR_HD void at(double dt, Index i, Loaded& loaded) const {
    const Index c = couple_of(i);
    const bool is_item = i / width < items();
    const auto lane = static_cast<int>(i % width);
    const int own = corner_of(i);
    const LaneGroup<width> group;
    const bool leads = lane == 0;
    CoupleState& kept = all.state[c];
    const ContactPair law = all.laws[loaded.law];
    const bool waits = any_couple && all.phase[c] == CouplePhase::waits;
    const bool is_new = loaded.scale == 0.0 && !waits;
    if (is_new) loaded.scale = 1.0;

    const GroupMemory<Shown, width> memory;
    Shown& shown = memory.get();
    if (lane < 3)
      for (int side = 0; side < 2; ++side) {
        shown.corner[side][own] = loaded.corner[side];
        shown.drag[3 * side + own] = loaded.drag[side];
      }
    group.wait();
    Vec2 x[2][3];
    for (int side = 0; side < 2; ++side)
      for (int k = 0; k < 3; ++k) x[side][k] = shown.corner[side][k].position;
    const bool are_near = near(group, loaded.corner[0].position, x[1]) && is_item && !waits;
    unsigned edges = may_overlap(group, shown, own, x);
    group.wait();  // all have shown their coordinates
    if (!are_near) edges = 0;
    const bool begins = any_couple && are_near && is_new && loaded.parent_joint >= 0;
    if (any_couple && group.any_of_warp(begins)) {
      if (begins && leads) cold_begin(&all, c);
      group.wait();
      if (begins) {
        loaded.scale = kept.scale;
        loaded.stiffness = kept.stiffness;
        for (int side = 0; side < 2; ++side) shown.drag[3 * side + own] = kept.drag[3 * side + own];
        loaded.work = kept.work;
        loaded.sprung = kept.sprung;
      }
      group.wait();
    }
    double scale = loaded.scale;
    if (any_couple && all.rebound.loses()) {
      const double most = kept.most;
      group.wait();
      if (are_near) {
        const auto now = cold_unloading(&all, c, scale * law.penalty, most);
        scale *= now.share;
        if (leads) kept.most = now.most;
      }
    }

    if (are_near && lane < 3)
      for (int side = 0; side < 2; ++side)
        if ((edges >> (3 * side + own) & 1U) == 0) kept.drag[3 * side + own] = 0.0;
    FrictionWork friction_work;
    Vec2 sum[2] = {};  // on the own corners
    double stiffness = 0.0;
    bool touched = false;
    while (group.any_of_warp(edges != 0)) {
      unsigned rest = edges;  // from the own edge on
      for (int k = 0; k < width - 1; ++k)
        if (k < lane) rest &= rest - 1;
      const int edge = rest != 0 ? fdem_shared::lowest_bit(rest) : 0;
      const int side = edge < 3 ? 0 : 1, first = edge - 3 * side,
                second = first == 2 ? 0 : first + 1;
      EdgePush mine;
      mine.touches = false;
      if (rest != 0) {
        for (int k = 0; k < 3; ++k) {
          mine.overlap.at_a[k] = shown.in_other[side][first][k];
          mine.overlap.at_b[k] = shown.in_other[side][second][k];
        }
        push_edge(law, scale, loaded.stiffness, shown.drag[edge], dt, shown.corner[side][first],
                  shown.corner[side][second], Velocities{shown.corner[1 - side]}, mine);
        kept.drag[edge] = mine.drag;
      }
      const unsigned touching = group.ballot(mine.touches);
      if (mine.touches)
        shown.push[lane] = {{mine.normal[0], mine.normal[1]},
                            {mine.friction[0], mine.friction[1]},
                            mine.taken,
                            mine.sprung};
      const double own_stiffness = mine.touches ? mine.stiffness : 0.0;
      for (int k = 0; k < width; ++k) stiffness = max(stiffness, group.from(k, own_stiffness));
      touched = touched || touching != 0;
      group.wait();
      for (int k = 0; k < width; ++k) {
        const int pushing = fdem_shared::lowest_bit(edges);
        edges &= edges - 1;
        if ((touching >> k & 1U) != 0)
          add_push(shown, k, pushing, own, law.friction > 0.0, sum, friction_work);
      }
      group.wait();  // all have read
    }
    if (touched && leads) kept.stiffness = stiffness;
    if (any_couple && touched && all.conservative)
      for (int side = 0; side < 2; ++side)
        sum[side] += cold_shape_force(&all, c, scale * law.penalty, side == 0, own);
    if (is_item && is_new && leads) kept.scale = loaded.scale;
    if (is_item && leads && !waits) all.phase[c] = touched ? CouplePhase::acts : CouplePhase::rests;
    for (int side = 0; side < 2; ++side)
      loaded.corner[side].velocity = shown.corner[side][own].velocity;
    group.wait();  // what they show is written anew
    book(dt, i, loaded, sum, touched, friction_work);
  }

  /// Adds what an edge does to the own corners of both triangles.
  BR_HD static void add_push(const Shown& shown, int turn, int edge, int own, bool rubs,
                             Vec2 (&sum)[2], FrictionWork& friction_work) {
    const ShownPush& push = shown.push[turn];
    const bool of_a = edge < 3;
    const int side = of_a ? 0 : 1, first = edge - 3 * side, second = first == 2 ? 0 : first + 1;
    const double share_a = shown.in_other[side][first][own],
                 share_b = shown.in_other[side][second][own];
    const bool at_first = own == first, is_end = at_first || own == second;
    Vec2 on_edge = of_a ? sum[0] : sum[1], on_target = of_a ? sum[1] : sum[0];
    const auto add = [&](const Vec2& at_a, const Vec2& at_b) {
      const Vec2 more = on_edge + (at_first ? at_a : at_b);
      on_edge = is_end ? more : on_edge;
      on_target -= share_a * at_a + share_b * at_b;
    };
    add(push.normal[0], push.normal[1]);
    if (rubs) add(push.friction[0], push.friction[1]);
    friction_work.add(push.taken, push.sprung);
    sum[0] = of_a ? on_edge : on_target;
    sum[1] = of_a ? on_target : on_edge;
  }

  /// Stores the forces, and books the work that they have taken up.
  BR_HD void book(double dt, Index i, Loaded& loaded, const Vec2 (&sum)[2], bool touched,
                  const FrictionWork& friction_work) const {
    const Index c = couple_of(i);
    const bool is_item = i / width < items();
    const auto lane = static_cast<int>(i % width);
    const int own = corner_of(i);
    const LaneGroup<width> group;
    const bool leads = lane == 0;
    const bool rests = !touched && loaded.work == 0.0 && loaded.slid == 0.0;
    const bool works = is_item && !rests;
    Vec2Of<Number> now[2] = {converted<Number>(sum[0]), converted<Number>(sum[1])};
    if (is_item && lane < 3)
      for (int side = 0; side < 2; ++side)
        *force_at(c, side, own) = rests ? Vec2Of<Number>{} : now[side];
    if (!group.any_of_warp(works)) return;
    double taken[2];
    for (int side = 0; side < 2; ++side)
      taken[side] =
          0.5 * dt *
          dot(converted<double>(loaded.last[side]) + converted<double>(as_in_memory(now[side])),
              loaded.corner[side].velocity);
    for (int k = 0; k < 3; ++k) {
      loaded.work -= group.from(k, taken[0]);
      loaded.work -= group.from(k, taken[1]);
    }
    if (!works) return;
    CoupleState& kept = all.state[c];
    friction_work.book(loaded.slid, loaded.sprung);
    if (!touched) {
      if (lane < 3)
        for (int side = 0; side < 2; ++side) kept.drag[3 * side + own] = 0.0;
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
