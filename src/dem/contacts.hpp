#pragma once
// Pairs that touch without a link: between elements, and between elements and walls.

#include "core/pair_list.hpp"
#include "dem/laws/contact.hpp"
#include "dem/links/link_set.hpp"
#include "dem/wall_mesh.hpp"

namespace breccia::dem {

/// History of the contact of a pair of elements, kept between searches. One item a pair, written by
/// the forces of contacts (pairs) and carried over by the search; of walls: by theirs (walls).
struct ContactHistory {
  Buffer<ContactState> state;  ///< shear, rolling moment and overlap when last seen  [N, N m, m]
  Buffer<double> slid;         ///< energy spent on sliding and rolling so far  [J]
  Buffer<double> damped;       ///< energy taken by the dashpot so far  [J]

  template <class Visit>
  void each_field(Visit&& field) {
    field("state", "-", state);
    field("slid", "J", slid);
    field("damped", "J", damped);
  }
  View<const double> work_of_walls() const { return {}; }
};
/// History of the contact of an element and a wall, kept between searches.
struct WallHistory : ContactHistory {
  Buffer<double> driven;  ///< energy that a moving wall put in so far  [J]
  Buffer<Vec3> on_wall;   ///< force on the wall at the time of the positions  [N]
  Buffer<Vec3> place;     ///< of a mesh: where it is touched, in its frame  [m]

  template <class Visit>
  void each_field(Visit&& field) {
    ContactHistory::each_field(field);
    field("driven", "J", driven);
    field("on_wall", "N", on_wall);
    field("place", "m", place);
  }
  View<const double> work_of_walls() const { return driven.view(); }
};

/// Pairs that may touch until the next search.
using Contacts = PairList<ContactHistory>;
/// Elements and walls that may touch: b is the wall, and the key is of wall, element and slot. With
/// a mesh an element has mesh_slots contacts, side by side; with any other wall one.
using WallContacts = PairList<WallHistory>;

/// Contacts between elements.
/// @tparam Actions  where actions go
template <class Actions>
struct ContactForcesTo {
  static constexpr const char* name = "dem.contacts";
  ContactLaw law;
  double dt;
  ElementsView elements;
  View<const std::int16_t> material;
  View<const ContactPair> pairs;  ///< of materials p, q at p * materials + q
  Index materials;
  View<const Index> a, b;
  View<ContactState> state;
  View<double> slid, damped;
  Actions actions;  ///< zero for pairs that were apart when last seen

  BR_HD void set(const StepTime& now) { dt = now.last_dt; }
  BR_HD void operator()(Index i) const { of_pair(i, a[i], b[i]); }
  /// Whether two elements do not touch.
  BR_HD bool apart(Index ia, Index ib) const {
    const double sum = elements.radius(ia) + elements.radius(ib);
    const Vec3 d = elements.state[ib].position - elements.state[ia].position;
    return dot(d, d) >= sum * sum;
  }
  /// Contact i, between the elements at two places.
  BR_HD void of_pair(Index i, Index ia, Index ib) const {
    const PairEnd<double> end_a = elements.end(ia), end_b = elements.end(ib);
    const double radius_a = elements.radius(ia), radius_b = elements.radius(ib);
    const double sum = radius_a + radius_b;
    const Vec3 d = end_b.position - end_a.position;
    const bool apart = dot(d, d) >= sum * sum;
    if (apart && state[i].overlap <= 0.0) return;  // was apart, too: its action is zero already
    const PairMotion<double> motion = pair_motion<double>(end_a, end_b, radius_a - radius_b, dt);
    const double mass_a = elements.mass[ia], mass_b = elements.mass[ib];
    const ContactLaw::Pair pair{radius_a * radius_b / sum, min(radius_a, radius_b), sum,
                                mass_a * mass_b / (mass_a + mass_b), 0.5 * sum};
    const double approach = -dot(end_b.velocity - end_a.velocity, motion.normal);
    const double overlap = apart ? 0.0 : sum - motion.distance;
    ContactState kept = state[i];
    const ContactResponse r = law.response(pairs[material[ia] * materials + material[ib]], pair,
                                           overlap, approach, motion, kept);
    state[i] = kept;
    slid[i] += r.slid;
    damped[i] += r.damped;
    write_pair_force(actions, i, motion, r.shear + r.pressure * motion.normal, r.moment,
                     r.normal_stiffness, r.shear_stiffness, r.rolling_stiffness,
                     r.rolling_stiffness);
  }
};
using ContactForces = ContactForcesTo<View<PairForce>>;

/// Contacts of elements with walls, one wall at a time: adds to force and torque of its own
/// element.
struct WallForces {
  static constexpr const char* name = "dem.walls";
  ContactLaw law;
  double dt;
  View<const Wall> walls;
  Index number;  ///< of the wall
  ElementsView elements;
  View<const std::int16_t> material;
  View<const ContactPair> pairs;  ///< of a material with a rigid wall
  View<const Index> a;
  Index first;       ///< contact 0 of this wall
  double wall_mass;  ///< infinite: it moves as it is told  [kg]
  View<ContactState> state;
  View<double> slid, damped, driven;
  View<Vec3> wall_force;
  View<Vec3> force, torque;
  View<double> critical;

  BR_HD void set(const StepTime& now) { dt = now.last_dt; }
  BR_HD void operator()(Index k) const {
    const Index i = first + k;
    act(i, touch(walls[number], elements.end(a[i]).position));
  }
  /// Contact i, where its element is nearest to the wall.
  BR_HD void act(Index i, const WallTouch& at) const {
    const Wall& wall = walls[number];
    const Index e = a[i];
    const PairEnd<double> end = elements.end(e);
    const double radius = elements.radius(e), mass = elements.mass[e];
    const auto [out, height] = at;
    ContactState kept = state[i];
    const double overlap = radius - height;
    if (kept.overlap <= 0.0 && overlap <= 0.0) return;

    PairMotion<double> motion{};
    motion.normal = -out;
    motion.distance = motion.arm_a = height;
    const Vec3 surface = wall.velocity_at(end.position - height * out);
    const Vec3 dv = surface - end.velocity;
    motion.extension = dt * dot(dv, motion.normal);
    motion.slip = dt * motion.tangential(dv - cross(height * end.spin, motion.normal));
    motion.turn = dt * (wall.spin - end.spin);
    motion.half_turn = (0.25 * dt * dot(motion.normal, end.spin + wall.spin)) * motion.normal;
    motion.turn_scale = turn_scale(motion.half_turn);

    const bool free = wall_mass < no_limit;
    const double both = free ? mass * wall_mass / (mass + wall_mass) : mass;
    const ContactLaw::Pair pair{wall.curved(radius), radius, 2.0 * radius, both, radius};
    ContactPair constants = pairs[material[e]];
    if (!law.hertz) constants.normal *= wall.stiffness;
    const ContactResponse r =
        law.response(constants, pair, overlap, -dot(dv, motion.normal), motion, kept);
    state[i] = kept;
    slid[i] += r.slid;
    damped[i] += r.damped;

    const Vec3 on_wall = r.shear + r.pressure * motion.normal;
    wall_force[i] = on_wall;
    force[e] -= on_wall;
    torque[e] += -(height * cross(motion.normal, on_wall)) - r.moment;
    // A wall with mass loses the energy that it gives: no work comes from outside.
    if (!free) driven[i] -= dt * dot(on_wall, surface);
    if (wall.turns()) driven[i] -= dt * dot(r.moment, wall.spin);
    // Stiffnesses add, so their critical times squared add like resistances in parallel; the wall's
    // largest stiffness stands for all its directions.
    const double stiffest = max(r.normal_stiffness, r.shear_stiffness);
    if (stiffest > 0.0) {
      const double rolling = r.shear_stiffness * height * height + r.rolling_stiffness;
      const double own = mass / stiffest;
      const double turning = rolling > 0.0 ? elements.inertia[e] / rolling : own;
      const double least = min(own, turning);
      critical[e] = critical[e] * least / (critical[e] + least);
    }
  }
};

/// Contacts of elements with a wall of triangles, one element at a time. A contact keeps its
/// history while its place moves from triangle to triangle.
struct MeshForces {
  static constexpr const char* name = "dem.mesh_walls";
  WallForces forces;
  WallMesh mesh;
  View<Vec3> place;

  BR_HD void set(const StepTime& now) { forces.set(now); }
  BR_HD void operator()(Index k) const {
    const Index first = forces.first + mesh_slots * k;
    const Wall& wall = forces.walls[forces.number];
    const Vec3 centre = forces.elements.end(forces.a[first]).position;
    const double radius = forces.elements.radius(forces.a[first]);
    const MeshTouches touches(mesh, into_mesh(wall, centre - wall.point), radius);
    int touch_of[mesh_slots];
    assign(touches, first, 0.1 * radius, touch_of);
    for (int slot = 0; slot < mesh_slots; ++slot) {
      const Index i = first + slot;
      if (touch_of[slot] >= 0) {
        const MeshTouch& at = touches.item[touch_of[slot]];
        place[i] = at.place;
        forces.act(i, {out_of_mesh(wall, at.normal), at.height});
      } else if (forces.state[i].overlap > 0.0) {  // it has come off
        const Vec3 away = centre - (wall.point + out_of_mesh(wall, place[i]));
        const double way = norm(away);
        forces.act(i, {way > 0.0 ? (1.0 / way) * away : wall.normal, radius});
      }
    }
  }

 private:
  /// Gives each touch the contact that was nearest to it a step ago, or a new one; -1: a contact
  /// without a touch.
  BR_HD void assign(const MeshTouches& touches, Index first, double near,
                    int (&touch_of)[mesh_slots]) const {
    for (int& touch : touch_of) touch = -1;
    bool placed[mesh_slots] = {};
    for (int c = 0; c < touches.count; ++c) {
      int best = -1;
      double least = near * near;
      for (int slot = 0; slot < mesh_slots; ++slot) {
        if (touch_of[slot] >= 0 || !(forces.state[first + slot].overlap > 0.0)) continue;
        const Vec3 way = place[first + slot] - touches.item[c].place;
        if (dot(way, way) > least) continue;
        least = dot(way, way);
        best = slot;
      }
      if (best < 0) continue;
      touch_of[best] = c;
      placed[c] = true;
    }
    int slot = 0;
    for (int c = 0; c < touches.count; ++c) {
      if (placed[c]) continue;
      while (slot < mesh_slots && (touch_of[slot] >= 0 || forces.state[first + slot].overlap > 0.0))
        ++slot;
      if (slot < mesh_slots) touch_of[slot] = c;
    }
  }
};

}  // namespace breccia::dem
