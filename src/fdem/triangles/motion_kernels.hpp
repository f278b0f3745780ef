#pragma once
// The motion of triangles: what acts on their corners, and how far they may go.

#include "core/drift.hpp"
#include "core/kernel.hpp"
#include "fdem/triangles/columns.hpp"
#include "fdem/triangles/triangles.hpp"

namespace breccia::fdem {

/// Prescribed motion of a triangle's corners: bits 2 k and 2 k + 1 fix x and y of corner k, whose
/// motion is motion[k].
struct Hold {
  std::uint8_t fixed = 0;
  std::uint8_t gone = 0;  ///< 1: the triangle has been taken out of the model
  std::int16_t motion[3] = {-1, -1, -1};
};
/// @param hold  of a triangle
BR_HD inline bool is_gone(const View<const Hold>& holds, Index hold) {
  return hold >= 0 && holds[hold].gone != 0;
}

/// A velocity that follows a table of factors over time, here and now.
struct Motion {
  Vec2 velocity;  ///< over the step to come  [m/s]
};

/// Newton's second law for every corner, by leapfrog with a variable step (Munjiza 2004, 5.12).
struct Kick {
  double last_dt, next_dt;  ///< steps before and after the forces  [s]
  Vec2 gravity;             ///<  [m/s2]
  double damping;           ///< of Cundall's local damping  [-]
  View<const Hold> holds;
  View<const Motion> motions;
  View<const double> mass;
  View<const TriangleNodes> nodes;
  View<const Corners> force;
  View<const Index> hold;

  struct Result {
    Vec2 velocity[3];  ///< half a step later
    Vec2 damped[3];    ///< force that damping took off
  };

  BR_HD void set(const StepTime& now) {
    last_dt = now.last_dt;
    next_dt = now.next_dt;
  }
  BR_HD double span() const { return 0.5 * (last_dt + next_dt); }
  BR_HD static double opposed(double force, double velocity) {
    return velocity > 0.0 ? abs(force) : velocity < 0.0 ? -abs(force) : 0.0;
  }
  /// A velocity at the time of the forces, from those half a step before and after.
  BR_HD Vec2 between(const Vec2& before, const Vec2& after) const {
    return span() > 0.0 ? before + (0.5 * last_dt / span()) * (after - before) : before;
  }
  /// A triangle, and what acts on it.
  struct Given {
    TriangleNodes nodes;
    Corners force;
    double mass;
    Index hold;
  };
  BR_HD Given given(Index t) const { return {nodes[t], force[t], mass[t], hold[t]}; }

  BR_HD Result operator()(Index t) const { return (*this)(given(t)); }
  BR_HD Result operator()(const Given& of) const {
    Result r{};
    const double m = of.mass, scale = span() / m;
    for (int k = 0; k < 3; ++k) {
      const Vec2 before = of.nodes.at[k].velocity;
      Vec2 f = of.force.at[k] + m * gravity;
      if (damping > 0.0) {
        const Vec2 drift = before + (0.5 * scale) * f;
        r.damped[k] = {damping * opposed(f.x, drift.x), damping * opposed(f.y, drift.y)};
        f -= r.damped[k];
      }
      r.velocity[k] = before + scale * f;
    }
    if (of.hold >= 0) {
      const Hold& h = holds[of.hold];
      for (int k = 0; k < 3; ++k) {
        const Vec2 given = h.motion[k] >= 0 ? motions[h.motion[k]].velocity : Vec2{};
        if ((h.fixed >> (2 * k) & 1) != 0) {
          r.velocity[k].x = given.x;
          r.damped[k].x = 0.0;  // what is held is not damped
        }
        if ((h.fixed >> (2 * k + 1) & 1) != 0) {
          r.velocity[k].y = given.y;
          r.damped[k].y = 0.0;
        }
      }
    }
    return r;
  }
};

/// Whether triangles have used their margins up: the list of couples is no longer valid.
struct UsedMargin {
  View<const Index> place;  ///< of each triangle in the other two; -1: a ghost, or it cannot touch
  View<const Corners> reference;
  View<const double> margin;
  PlaneDrift drift;
  Vec2 drifted;  ///< since the search  [m]

  /// @param time  of the positions  [s]
  BR_HD void set_time(double time) { drifted = drift.way(time); }
  BR_HD bool beyond(const TriangleNodes& now, const Corners& from, double allowed) const {
    bool inside = dot(drifted, drifted) <= drift.farthest * drift.farthest;
    for (int k = 0; k < 3; ++k) {
      const Vec2 moved = (now.at[k].position - from.at[k]) - drifted;
      inside = inside && dot(moved, moved) <= allowed * allowed;
    }
    return !inside;  // NaN counts as beyond
  }
};

/// How a move has ended.
enum class Moved : std::uint8_t {
  within,  ///< all are within their margins
  beyond,  ///< one has used its margin up
  left     ///< a pack in which one is held, loaded or damped: nothing is written
};

/// Moves the corners and books the work of loads, supports and local damping; and the question
/// whether margins still hold.
struct MoveTriangles {
  static constexpr const char* name = "fdem.move";
  Kick kick;
  View<const Corners> external;
  View<TriangleNodes> nodes;
  View<double> damping_work, load_work;
  UsedMargin used;

  template <class R>
  struct Loaded {
    Columns<R, TriangleNodes> nodes;
    Columns<R, Corners> force;
    R mass;
    Index hold;  ///< of a pack: below zero if no triangle is held
    Index place[width_of<R>];
    Corners from;   ///< of one triangle; packs rarely need it
    double margin;  ///< likewise
  };
  BR_HD void set(const StepTime& now) {
    kick.set(now);
    used.set_time(now.time + now.next_dt);
  }
  /// All but the sums of forces.
  template <class R>
  BR_HD void load_early(Index t, Loaded<R>& loaded) const {
    for (Index k = 0; k < width_of<R>; ++k) loaded.place[k] = read_now(&used.place[t + k]);
    loaded.hold = read_now(&kick.hold[t]);
    for (Index k = 1; k < width_of<R>; ++k)
      if (kick.hold[t + k] >= 0) loaded.hold = kick.hold[t + k];
    if (is_left(loaded)) return;
    loaded.mass = load_now<R>(kick.mass, t);
    loaded.nodes.read(kick.nodes, t);
    loaded.margin = 0.0;
    if (width_of<R> == 1 && loaded.place[0] >= 0) {
      loaded.from = read_record_now(&used.reference[loaded.place[0]]);
      loaded.margin = read_now(&used.margin[loaded.place[0]]);
    }
    loaded.nodes.wait();
  }
  template <class R>
  BR_HD void load_late(Index t, Loaded<R>& loaded) const {
    if (!is_left(loaded)) loaded.force.read(kick.force, t);
  }
  template <class R>
  BR_HD Moved update(Index t, Loaded<R>& loaded) const {
    if (is_left(loaded)) return Moved::left;
    loaded.force.wait();
    if constexpr (width_of<R> == 1) {
      if (is_driven(loaded))
        move_driven(t, loaded);
      else
        move_free(loaded.nodes.numbers, loaded.force.numbers, loaded.mass);
    } else {
      move_free(loaded.nodes.numbers, loaded.force.numbers, loaded.mass);
    }
    Columns<R, TriangleNodes>::write(nodes, t, loaded.nodes.numbers);
    return is_beyond(t, loaded) ? Moved::beyond : Moved::within;
  }
  /// @returns whether the triangle has used its margin up
  BR_HD bool operator()(Index t) const { return run_at<double>(*this, t) == Moved::beyond; }

  /// Force that holds a corner to its prescribed motion; zero in free directions.  [N/m]
  BR_HD Vec2 reaction(const Kick::Given& of, int k, const Kick::Result& r) const {
    const double span = kick.span();
    if (!(span > 0.0)) return {};
    const int bits = kick.holds[of.hold].fixed >> (2 * k);
    const Vec2 gained = (of.mass / span) * (r.velocity[k] - of.nodes.at[k].velocity);
    const Vec2 given = of.force.at[k] + of.mass * kick.gravity - r.damped[k];
    const Vec2 held = gained - given;
    return {(bits & 1) != 0 ? held.x : 0.0, (bits & 2) != 0 ? held.y : 0.0};
  }

 private:
  template <class R>
  BR_HD bool is_driven(const Loaded<R>& loaded) const {
    return kick.damping > 0.0 || external.size > 0 || loaded.hold >= 0;
  }
  /// Whether a pack is not to be taken as one.
  template <class R>
  BR_HD bool is_left(const Loaded<R>& loaded) const {
    return width_of<R> != 1 && is_driven(loaded);
  }
  template <class R>
  BR_HD bool is_beyond(Index t, const Loaded<R>& loaded) const {
    if constexpr (width_of<R> == 1) {
      TriangleNodes now;
      __builtin_memcpy(&now, loaded.nodes.numbers, sizeof now);
      return loaded.place[0] >= 0 && used.beyond(now, loaded.from, loaded.margin);
    } else {
      bool beyond = false;
      for (Index k = 0; k < width_of<R>; ++k) {
        const Index place = loaded.place[k];
        if (place >= 0 && used.beyond(nodes[t + k], used.reference[place], used.margin[place]))
          beyond = true;
      }
      return beyond;
    }
  }
  /// Moves corners c that forces f alone act on.
  template <class R>
  BR_HD void move_free(R (&c)[12], const R (&f)[6], const R& m) const {
    const R scale = kick.span() / m;
    const R next = constant<R>(kick.next_dt);
    const R gravity[2] = {kick.gravity.x * m, kick.gravity.y * m};
    for (int k = 0; k < 3; ++k)
      for (int axis = 0; axis < 2; ++axis) {
        R& velocity = c[4 * k + 2 + axis];
        velocity = velocity + scale * (f[2 * k + axis] + gravity[axis]);
        c[4 * k + axis] = c[4 * k + axis] + next * velocity;
      }
  }

  /// Moves a triangle that is held, loaded or damped; books the work.
  BR_HD void move_driven(Index t, Loaded<double>& loaded) const {
    Kick::Given of{{}, {}, loaded.mass, loaded.hold};
    __builtin_memcpy(&of.nodes, loaded.nodes.numbers, sizeof of.nodes);
    __builtin_memcpy(&of.force, loaded.force.numbers, sizeof of.force);
    const Kick::Result r = kick(of);
    TriangleNodes moved = of.nodes;
    const bool held = of.hold >= 0;
    double damped = 0.0, booked = 0.0;
    for (int k = 0; k < 3; ++k) {
      NodeState& n = moved.at[k];
      const Vec2 after = kick.next_dt * r.velocity[k];
      const Vec2 both = kick.last_dt * n.velocity + after;
      if (kick.damping > 0.0) damped += 0.5 * dot(r.damped[k], both);
      if (external.size > 0) booked += 0.5 * dot(external[t].at[k], both);
      if (held) booked += 0.5 * dot(reaction(of, k, r), both);
      n.velocity = r.velocity[k];
      n.position += after;
    }
    if (kick.damping > 0.0) damping_work[t] += damped;
    if (held || external.size > 0) load_work[t] += booked;
    __builtin_memcpy(loaded.nodes.numbers, &moved, sizeof moved);
  }
};

}  // namespace breccia::fdem
