#pragma once
// The motion of elements: what acts on their corners, and how far they may go. One text for
// triangles and tetrahedra, over an element `Of` that names its types (fdem/triangles/motion.hpp,
// fdem3/elements/motion.hpp): Vector, Nodes, Corners, Hold, Motion; and `word`, `move`.

#include <type_traits>

#include "core/drift.hpp"
#include "core/kernel.hpp"
#include "fdem_shared/columns.hpp"
#include "fdem_shared/prescribed.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// Against the velocity, as large as the force.
template <class R>
BR_HD R opposed(const R& force, const R& velocity) {
  const R size = abs(force);
  return select(velocity > 0.0, size, select(velocity < 0.0, -size, constant<R>(0.0)));
}
BR_HD inline Vec2 opposed(const Vec2& f, const Vec2& v) {
  return {opposed(f.x, v.x), opposed(f.y, v.y)};
}
BR_HD inline Vec3 opposed(const Vec3& f, const Vec3& v) {
  return {opposed(f.x, v.x), opposed(f.y, v.y), opposed(f.z, v.z)};
}

/// Newton's second law for every corner, by leapfrog with a variable step (Munjiza 2004, 5.12).
template <class Of>
struct KickOf {
  using Vector = typename Of::Vector;
  using Nodes = typename Of::Nodes;
  using Corners = typename Of::Corners;
  using Hold = typename Of::Hold;
  static constexpr int corners = static_cast<int>(std::extent_v<decltype(Of::Corners::at)>);
  static constexpr int dimension = corners - 1;

  double last_dt, next_dt;  ///< steps before and after the forces  [s]
  Vector gravity;           ///<  [m/s2]
  double damping;           ///< of Cundall's local damping  [-]
  View<const Hold> holds;
  View<const typename Of::Motion> motions;
  View<const double> mass;
  View<const typename Of::Nodes> nodes;
  View<const typename Of::Corners> force;
  View<const Index> hold;

  struct Result {
    Vector velocity[corners];  ///< half a step later
    Vector damped[corners];    ///< force that damping took off
  };
  /// An element, and what acts on it.
  struct Given {
    typename Of::Nodes nodes;
    typename Of::Corners force;
    double mass;
    Index hold;
  };

  BR_HD void set(const StepTime& now) {
    last_dt = now.last_dt;
    next_dt = now.next_dt;
  }
  BR_HD double span() const { return 0.5 * (last_dt + next_dt); }
  /// A velocity at the time of the forces, from those half a step before and after.
  BR_HD Vector between(const Vector& before, const Vector& after) const {
    return span() > 0.0 ? before + (0.5 * last_dt / span()) * (after - before) : before;
  }
  BR_HD Given given(Index t) const { return {nodes[t], force[t], mass[t], hold[t]}; }
  /// Whether an element has been taken out of the model.
  BR_HD bool is_gone(Index t) const { return hold[t] >= 0 && holds[hold[t]].gone != 0; }

  BR_HD Result operator()(Index t) const { return (*this)(given(t)); }
  BR_HD Result operator()(const Given& of) const {
    Result r{};
    const double m = of.mass, scale = span() / m;
    for (int k = 0; k < corners; ++k) {
      const Vector before = of.nodes.at[k].velocity;
      Vector f = of.force.at[k] + m * gravity;
      if (damping > 0.0) {
        r.damped[k] = damping * opposed(f, before + (0.5 * scale) * f);
        f -= r.damped[k];
      }
      r.velocity[k] = before + scale * f;
    }
    if (of.hold < 0) return r;
    const Hold& h = holds[of.hold];
    for (int k = 0; k < corners; ++k) {
      const int bits = h.fixed_at(k);
      if (bits == 0) continue;
      const Vector given =
          h.motion[k] >= 0 ? motions[h.motion[k]].at(of.nodes.at[k].position, next_dt) : Vector{};
      r.velocity[k] = held_parts(bits, given, r.velocity[k]);
      r.damped[k] = held_parts(bits, Vector{}, r.damped[k]);  // what is held is not damped
    }
    return r;
  }
  /// A component of Result, of a free corner of each element in a pack.
  template <class R>
  struct FreePart {
    R velocity, damped;
  };
  /// @param acts  the force on it, gravity aside  @param m  its mass
  template <class R>
  FreePart<R> free_part(int axis, const R& before, const R& acts, const R& m) const {
    const R scale = span() / m;
    R f = acts + m * part_of(gravity, axis), damped = constant<R>(0.0);
    if (damping > 0.0) {
      damped = damping * opposed<R>(f, before + (0.5 * scale) * f);
      f = f - damped;
    }
    return {before + scale * f, damped};
  }
  /// Force that holds a corner to its prescribed motion; zero in free directions.
  /// [N; in 2D N/m]
  BR_HD Vector reaction(const Given& of, int k, const Result& r) const {
    if (of.hold < 0 || !(span() > 0.0)) return {};
    const Vector gained = (of.mass / span()) * (r.velocity[k] - of.nodes.at[k].velocity);
    const Vector given = of.force.at[k] + of.mass * gravity - r.damped[k];
    return held_parts(holds[of.hold].fixed_at(k), gained - given, Vector{});
  }
  /// Of the first half step, from the velocity at the start: what is held gains
  /// m (v_+^2 - v_0^2) / 2 there, and reaction() times the way of a half step is
  /// m (v_+ - v_0)^2 / 2 more.  [J; in 2D J/m]
  BR_HD double of_start(const Given& of, int k, const Result& r) const {
    const Vector gained =
        held_parts(holds[of.hold].fixed_at(k), r.velocity[k] - of.nodes.at[k].velocity, Vector{});
    return 0.5 * of.mass * dot(gained, gained);
  }
};

/// Where the elements that can touch stood at the last search, and how far each may go from there,
/// the drift taken off.
template <class Of>
struct TravelOf {
  Buffer<Index> element;  ///< those that can touch, ascending by global id  [-]  (search)
  Buffer<typename Of::Corners> reference;  ///< their corners at the search  [m]  (search)
  Buffer<double> margin;                   ///< how far each may go from there  [m]  (search)
  DriftOf<typename Of::Vector> drift;

  template <class Visit>
  void each_field(Visit&& field) {
    field(Of::word, "-", element);
    field("reference", "m", reference);
    field("margin", "m", margin);
  }
};

/// Whether elements have used their margins up: the list of couples is no longer valid.
template <class Of>
struct UsedMargin {
  using Vector = typename Of::Vector;
  View<const Index> place;  ///< of each element in the other two; -1: a ghost, or it cannot touch
  View<const typename Of::Corners> reference;
  View<const double> margin;
  DriftOf<Vector> drift;
  Vector drifted;  ///< since the search  [m]

  /// @param time  of the positions  [s]
  BR_HD void set_time(double time) { drifted = drift.way(time); }
  BR_HD bool beyond(const typename Of::Nodes& now, const typename Of::Corners& from,
                    double allowed) const {
    bool inside = dot(drifted, drifted) <= drift.farthest * drift.farthest;
    for (int k = 0; k < KickOf<Of>::corners; ++k) {
      const Vector moved = (now.at[k].position - from.at[k]) - drifted;
      inside = inside && dot(moved, moved) <= allowed * allowed;
    }
    return !inside;  // NaN counts as beyond
  }
};

/// How a move has ended.
enum class Moved : std::uint8_t {
  within,  ///< all are within their margins
  beyond   ///< one has used its margin up
};

/// Moves the corners and books the work of loads, supports and local damping; and the question
/// whether margins still hold.
template <class Of>
struct MoveOf {
  static constexpr const char* name = Of::move;
  using Vector = typename Of::Vector;
  using Nodes = typename Of::Nodes;
  using Corners = typename Of::Corners;
  using Kick = KickOf<Of>;
  static constexpr int corners = Kick::corners, dimension = Kick::dimension;
  Kick kick;
  View<const Corners> external;
  View<Nodes> nodes;
  View<double> damping_work, load_work;
  UsedMargin<Of> used;

  template <class R>
  struct Loaded {
    Columns<R, Nodes> nodes;
    Columns<R, Corners> force;
    R mass;
    Index hold[width_of<R>], place[width_of<R>];
    Corners from;   ///< of one element; packs rarely need it
    double margin;  ///< likewise
  };
  BR_HD void set(const StepTime& now) {
    kick.set(now);
    used.set_time(now.time + now.next_dt);
  }
  /// All but the sums of forces.
  template <class R>
  BR_HD void load_early(Index t, Loaded<R>& loaded) const {
    begin_loading(t, loaded);
    loaded.nodes.wait();
  }
  /// As that, while the corners are still on their way.
  template <class R>
  BR_HD void begin_loading(Index t, Loaded<R>& loaded) const {
    for (Index k = 0; k < width_of<R>; ++k) {
      loaded.place[k] = read_now(&used.place[t + k]);
      loaded.hold[k] = read_now(&kick.hold[t + k]);
    }
    loaded.mass = load_now<R>(kick.mass, t);
    loaded.nodes.read(kick.nodes, t);
    loaded.margin = 0.0;
    if (width_of<R> == 1 && loaded.place[0] >= 0) {
      loaded.from = read_record_now(&used.reference[loaded.place[0]]);
      loaded.margin = read_now(&used.margin[loaded.place[0]]);
    }
  }
  template <class R>
  BR_HD void load_late(Index t, Loaded<R>& loaded) const {
    loaded.force.read(kick.force, t);
  }
  template <class R>
  BR_HD Moved update(Index t, Loaded<R>& loaded) const {
    loaded.force.wait();
    return go(t, loaded);
  }
  /// The move, when all is there.
  template <class R>
  BR_HD Moved go(Index t, Loaded<R>& loaded) const {
    if constexpr (width_of<R> == 1) {
      if (kick.damping > 0.0 || external.size > 0 || loaded.hold[0] >= 0)
        move_driven(t, loaded);
      else
        move_free(loaded.nodes.numbers, loaded.force.numbers, loaded.mass);
      Columns<R, Nodes>::write(nodes, t, loaded.nodes.numbers);
      return is_beyond(t, loaded) ? Moved::beyond : Moved::within;
    } else {
      return move_pack(t, loaded);
    }
  }
  /// @returns whether the element has used its margin up
  BR_HD bool operator()(Index t) const { return run_at<double>(*this, t) == Moved::beyond; }

 private:
  BR_HD bool is_beyond(Index, const Loaded<double>& loaded) const {
    Nodes now;
    __builtin_memcpy(&now, loaded.nodes.numbers, sizeof now);
    return loaded.place[0] >= 0 && used.beyond(now, loaded.from, loaded.margin);
  }
  /// Moves corners c that forces f alone act on.
  template <class R>
  BR_HD void move_free(R (&c)[2 * dimension * corners], const R (&f)[dimension * corners],
                       const R& m) const {
    const R scale = kick.span() / m;
    const R next = constant<R>(kick.next_dt);
    R gravity[dimension];
    for (int axis = 0; axis < dimension; ++axis) gravity[axis] = part_of(kick.gravity, axis) * m;
    for (int k = 0; k < corners; ++k)
      for (int axis = 0; axis < dimension; ++axis) {
        R& velocity = c[2 * dimension * k + dimension + axis];
        velocity = velocity + scale * (f[dimension * k + axis] + gravity[axis]);
        c[2 * dimension * k + axis] = c[2 * dimension * k + axis] + next * velocity;
      }
  }

  /// A pack, on the host. Elements that are held are taken one by one.
  template <class R>
  Moved move_pack(Index t, Loaded<R>& loaded) const {
    constexpr Index width = width_of<R>;
    Nodes held[width];
    Index free = width;
    for (Index k = 0; k < width; ++k)
      if (loaded.hold[k] >= 0) {
        held[k] = nodes[t + k];
        --free;
      }
    Booked<R> booked{};
    if (free > 0) {
      if (kick.damping > 0.0 || external.size > 0)
        booked = move_loaded(t, loaded);
      else
        move_free(loaded.nodes.numbers, loaded.force.numbers, loaded.mass);
      Columns<R, Nodes>::write(nodes, t, loaded.nodes.numbers);
    }
    Moved moved = Moved::within;
    for (Index k = 0; k < width; ++k) {
      const Index place = loaded.place[k];
      if (loaded.hold[k] >= 0) {
        nodes[t + k] = held[k];
        if ((*this)(t + k)) moved = Moved::beyond;
        continue;
      }
      if (place >= 0 && used.beyond(nodes[t + k], used.reference[place], used.margin[place]))
        moved = Moved::beyond;
      if (kick.damping > 0.0) damping_work[t + k] += booked.damped[k];
      if (external.size > 0) load_work[t + k] += booked.loads[k];
    }
    return moved;
  }
  template <class R>
  struct Booked {
    R damped, loads;  ///< taken off, and put in  [J; in 2D J/m]
  };
  /// Moves elements that are damped or loaded, but not held.
  template <class R>
  Booked<R> move_loaded(Index t, Loaded<R>& loaded) const {
    const R scale = kick.span() / loaded.mass, half = 0.5 * scale, none = constant<R>(0.0);
    Columns<R, Corners> external_force;
    if (external.size > 0) external_force.read(external, t);
    Booked<R> booked{none, none};
    for (int k = 0; k < corners; ++k) {
      R damped = none, loads = none;
      for (int axis = 0; axis < dimension; ++axis) {
        R& position = loaded.nodes.numbers[2 * dimension * k + axis];
        R& velocity = loaded.nodes.numbers[2 * dimension * k + dimension + axis];
        R force =
            loaded.force.numbers[dimension * k + axis] + loaded.mass * part_of(kick.gravity, axis);
        const R before = velocity;
        R off = none;
        if (kick.damping > 0.0) {
          off = kick.damping * opposed<R>(force, before + half * force);
          force = force - off;
        }
        velocity = before + scale * force;
        const R after = kick.next_dt * velocity, both = kick.last_dt * before + after;
        damped = axis == 0 ? off * both : damped + off * both;
        if (external.size > 0) {
          const R by_loads = external_force.numbers[dimension * k + axis] * both;
          loads = axis == 0 ? by_loads : loads + by_loads;
        }
        position = position + after;
      }
      booked.damped = booked.damped + 0.5 * damped;
      booked.loads = booked.loads + 0.5 * loads;
    }
    return booked;
  }

  /// Moves an element that is held, loaded or damped; books the work.
  BR_HD void move_driven(Index t, Loaded<double>& loaded) const {
    typename Kick::Given of{{}, {}, loaded.mass, loaded.hold[0]};
    __builtin_memcpy(&of.nodes, loaded.nodes.numbers, sizeof of.nodes);
    __builtin_memcpy(&of.force, loaded.force.numbers, sizeof of.force);
    const typename Kick::Result r = kick(of);
    Nodes moved = of.nodes;
    const bool held = of.hold >= 0;
    double damped = 0.0, booked = 0.0;
    for (int k = 0; k < corners; ++k) {
      auto& n = moved.at[k];
      const Vector after = kick.next_dt * r.velocity[k];
      const Vector both = kick.last_dt * n.velocity + after;
      if (kick.damping > 0.0) damped += 0.5 * dot(r.damped[k], both);
      if (external.size > 0) booked += 0.5 * dot(external[t].at[k], both);
      if (held) booked += 0.5 * dot(kick.reaction(of, k, r), both);
      if (held && !(kick.last_dt > 0.0)) booked -= kick.of_start(of, k, r);
      n.velocity = r.velocity[k];
      n.position += after;
    }
    if (kick.damping > 0.0) damping_work[t] += damped;
    if (held || external.size > 0) load_work[t] += booked;
    __builtin_memcpy(loaded.nodes.numbers, &moved, sizeof moved);
  }
};

}  // namespace breccia::fdem_shared
