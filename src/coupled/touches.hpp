#pragma once
// Spheres that press on faces of bodies of tetrahedra (docs/theory-coupled.md, 1 and 2).
//
// A touch is a sphere with a body: it has one spring of friction, whatever faces it meets.

#include "core/pair_list.hpp"
#include "coupled/laws/ball_flux.hpp"
#include "dem/elements.hpp"
#include "fdem/contact/couples.hpp"
#include "fdem3/elements/tetrahedra.hpp"

namespace breccia::coupled {

/// Contact of a material of spheres with one of tetrahedra.
struct PressLaw {
  double modulus;     ///< p_s R  [Pa]
  double tangential;  ///< stiffness across over that along the normal  [-]
  double friction;    ///< mu  [-]
};

/// Action on a sphere, and how stiff it is.
struct SphereForce {
  Vec3 force, torque;        ///< [N], [N m]
  double straight, turning;  ///< bounds of its stiffnesses  [N/m], [N m]
};
/// On the corners of a face, in its order.  [N]
struct FaceForce {
  Vec3 at[3];
};

/// State of a touch from step to step.
struct TouchState {
  Vec3 drag;             ///< tangential force on the sphere  [N]
  double spring;         ///< stiffness of its spring; 0: it has none  [N/m]
  double work;           ///< taken up since it began, friction included  [J]
  double slid;           ///< the part of it that friction has spent  [J]
  double sprung;         ///< the part of it that the spring of friction holds  [J]
  double lost;           ///< what was left of both when it ended: errors of integration  [J]
  double rubbed;         ///< what friction spent in touches that have ended  [J]
  std::int64_t touches;  ///< 1: they did in the last step
};

struct TouchHistory {
  Buffer<TouchState> state;
  Buffer<SphereForce> force;

  explicit TouchHistory(Space space = Space::host) : state(space), force(space) {}
  template <class Visit>
  void each_field(Visit&& field) {
    field("state", "-", state);
    field("force", "N", force);
  }
};
struct FaceHistory {
  Buffer<FaceForce> force;  ///< as the corners felt it last

  explicit FaceHistory(Space space = Space::host) : force(space) {}
  template <class Visit>
  void each_field(Visit&& field) {
    field("force", "N", force);
  }
};
using Touches = PairList<TouchHistory>;   ///< a: sphere, b: body
using NearFaces = PairList<FaceHistory>;  ///< a: sphere, b: face 4 t + k

/// A face within a sphere, in this step.
struct Pressed {
  Vec3 normal;       ///< out of the body  [-]
  double share[3];   ///< of its push on each corner  [N]
  double push;       ///< their sum  [N]
  double stiffness;  ///< bound  [N/m]
  BR_HD bool touches() const { return push > 0.0; }
  /// Share of corner k in what acts on the face.  [-]
  BR_HD double part(int k) const { return share[k] / push; }
};

/// Spheres that are near a face or bonded to one: where their touches, faces and bonds are listed.
struct SphereRow {
  Index sphere;  ///< place in the arrays of a Meeting
  Index here;    ///< place in this rank's world, -1: another rank owns it
  Index touch, touch_end, face, face_end, bond, bond_end;
};

/// Sums over the faces of a touch: all push, but those of live joints do not rub.
struct PressSum {
  Vec3 force{};             ///< N on the sphere  [N]
  Vec3 torque{};            ///< about its centre  [N m]
  double push = 0.0;        ///< of all  [N]
  double normal = 0.0;      ///< stiffness of all  [N/m]
  Vec3 centre{};            ///< of pressure of those that rub, weighed  [N m]
  Vec3 velocity{};          ///< of those there, weighed  [N m/s]
  double weight = 0.0;      ///< [N]
  double tangential = 0.0;  ///< stiffness  [N/m]
  double friction = 0.0;    ///< weighed  [N]

  BR_HD bool touches() const { return push > 0.0; }
  BR_HD bool rubs() const { return weight > 0.0; }
};

/// Pushes by flux, and Coulomb friction with one spring a touch, at the centre of pressure.
struct PressFaces {
  static constexpr const char* name = "coupled.press";
  double dt;  ///< the step that led here  [s]
  View<const dem::ElementState> spheres;
  View<const std::int16_t> sphere_material;
  View<const fdem3::TetrahedronNodes> nodes;
  View<const Index> material;
  View<const std::int16_t> body;
  View<const std::uint8_t> exposed;
  View<const PressLaw> laws;  ///< of materials p, q at p materials + q
  Index materials;            ///< of tetrahedra
  View<const SphereRow> rows;
  View<const Index> row_of;         ///< of each touch
  View<const std::int16_t> bonded;  ///< of each row: body that the sphere is bonded to, -1: none
  View<const Index> touched_body, face;
  View<TouchState> state;
  View<SphereForce> on_sphere;
  View<FaceForce> on_face;
  View<Pressed> pressed;

  BR_HD void operator()(Index i) const {
    const SphereRow& row = rows[row_of[i]];
    const dem::ElementState& s = spheres[row.sphere];
    PressSum sum;
    const bool apart = bonded[row_of[i]] == touched_body[i];
    for (Index j = row.face; j < row.face_end; ++j) {
      if (body[face[j] / 4] != touched_body[i]) continue;
      pressed[j] = {};
      if (!apart) press(row.sphere, s, j, sum);
    }
    TouchState& kept = state[i];
    if (!sum.touches() && kept.touches == 0) return;  // forces are zero already
    SphereForce now{sum.force, sum.torque, 0.0, 0.0};
    Vec3 pull{};
    if (sum.rubs()) {
      const Vec3 centre = (1.0 / sum.weight) * sum.centre;
      pull = rub(s, centre, kept, sum);
      now.force += pull;
      now.torque += cross(centre - s.position, pull);
    }
    if (sum.touches()) {
      now.straight = sum.normal + sum.tangential;
      now.turning = 1.5 * sum.tangential * s.radius * s.radius;  // rows of three
    }
    const SphereForce last = on_sphere[i];
    on_sphere[i] = now;
    double taken = dot(last.force + now.force, s.velocity) + dot(last.torque + now.torque, s.spin);
    for (Index j = row.face; j < row.face_end; ++j)
      if (body[face[j] / 4] == touched_body[i]) taken += hand_over(j, sum, pull);
    kept.work -= 0.5 * dt * taken;
    kept.touches = sum.touches() ? 1 : 0;
    if (!sum.touches()) end(kept);
  }

 private:
  /// Faces of live joints do not.
  BR_HD bool rubs(Index j) const { return (exposed[face[j] / 4] >> (face[j] % 4) & 1) != 0; }
  BR_HD void corners(Index j, Vec3 (&x)[3], Vec3 (&v)[3]) const {
    const fdem3::TetrahedronNodes& n = nodes[face[j] / 4];
    for (int k = 0; k < 3; ++k) {
      const fdem3::NodeState& at = n.at[fdem3::corner_of_face(face[j] % 4, k)];
      x[k] = at.position;
      v[k] = at.velocity;
    }
  }
  BR_HD void press(Index sphere, const dem::ElementState& s, Index j, PressSum& sum) const {
    Vec3 x[3], v[3];
    corners(j, x, v);
    BallFlux flux;
    if (!flux_of_face(s.position, s.radius, x, flux)) return;
    const PressLaw& law = laws[sphere_material[sphere] * materials + material[face[j] / 4]];
    const double penalty = law.modulus / s.radius;
    Pressed& p = pressed[j];
    p.normal = flux.normal;
    for (int k = 0; k < 3; ++k) p.share[k] = penalty * flux.share[k];
    p.push = penalty * flux.push;
    p.stiffness = penalty * flux.area * (1.0 + law.tangential);
    sum.force += p.push * p.normal;
    sum.torque += penalty * cross(flux.lever, flux.normal);
    sum.push += p.push;
    sum.normal += penalty * flux.area;
    if (!rubs(j)) return;
    sum.centre += p.push * s.position + penalty * flux.lever;
    // The lever leads along the face from the foot of the centre.
    sum.centre -= (p.push * dot(s.position - x[0], p.normal)) * p.normal;
    for (int k = 0; k < 3; ++k) sum.velocity += p.share[k] * v[k];
    sum.weight += p.push;
    sum.tangential += law.tangential * penalty * flux.area;
    sum.friction += law.friction * p.push;
  }
  /// The pull of friction on the sphere.  [N]
  BR_HD Vec3 rub(const dem::ElementState& s, const Vec3& centre, TouchState& kept,
                 const PressSum& sum) const {
    const double size = norm(sum.force), stiffness = sum.tangential;
    if (!(sum.friction > 0.0) || !(size > 0.0) || !(stiffness > 0.0)) return {};
    const Vec3 n = (1.0 / size) * sum.force;
    Vec3 rate = s.velocity + cross(s.spin, centre - s.position) - (1.0 / sum.weight) * sum.velocity;
    rate -= dot(rate, n) * n;
    // Turned with the plane of contact, its length kept.
    Vec3 before = kept.drag - dot(kept.drag, n) * n;
    const double left = norm(before), had = norm(kept.drag);
    // The spring keeps, as the area changes, its energy T^2/(2 k).
    const double stiffer = kept.spring > 0.0 ? sqrt(stiffness / kept.spring) : 1.0;
    if (left > 0.0) before = (stiffer * had / left) * before;
    kept.spring = stiffness;
    Vec3 pull = before - (stiffness * dt) * rate;
    const double tried = norm(pull), most = sum.friction / sum.weight * size;
    if (tried > most) pull = (most / tried) * pull;
    fdem::FrictionWork friction_work;
    friction_work.add(-0.5 * dt * dot(before + pull, rate), 0.5 * dot(pull, pull) / stiffness);
    friction_work.book(kept.slid, kept.sprung);
    kept.drag = pull;
    return pull;
  }
  /// Gives a face its forces. @returns the power of the last and the present ones, together  [W]
  BR_HD double hand_over(Index j, const PressSum& sum, const Vec3& pull) const {
    Vec3 x[3], v[3];
    corners(j, x, v);
    const Pressed& p = pressed[j];
    const FaceForce last = on_face[j];
    FaceForce now{};
    if (p.touches()) {
      for (int k = 0; k < 3; ++k) now.at[k] = -(p.share[k] * p.normal);
      if (rubs(j))
        for (int k = 0; k < 3; ++k) now.at[k] -= (p.share[k] / sum.weight) * pull;
    }
    on_face[j] = now;
    double power = 0.0;
    for (int k = 0; k < 3; ++k) power += dot(last.at[k] + now.at[k], v[k]);
    return power;
  }
  BR_HD static void end(TouchState& kept) {
    kept.slid += kept.sprung;  // what the spring held is spent
    kept.lost += kept.work - kept.slid;
    kept.rubbed += kept.slid;
    kept.work = kept.slid = kept.sprung = kept.spring = 0.0;
    kept.drag = {};
  }
};

}  // namespace breccia::coupled
