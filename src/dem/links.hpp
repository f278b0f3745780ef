#pragma once
// What joins elements from the start: the arrays of each kind of link, and what interactions do to
// their ends.

#include "core/fields.hpp"
#include "dem/laws/concrete_link.hpp"
#include "dem/laws/interface_link.hpp"
#include "dem/laws/steel_link.hpp"

namespace breccia::dem {

/// Cohesive links. Never removed: a broken one answers as the contact that is left of it.
struct ConcreteLinks {
  Buffer<Index> a, b;        ///< the ends, a's global id below b's
  Buffer<double> length;     ///< D_eq  [m]
  Buffer<double> stiffness;  ///< K_n  [N/m]
  Buffer<double> opening;    ///< largest so far, or link_broken, link_released  [m]
  Vec3Planes shear;          ///< F_s on b  [N]
  Vec3Planes moment;         ///< M on b  [N m]
  Buffer<double> slid;       ///< energy spent on sliding so far  [J]
  Buffer<double> yielded;    ///< energy spent on plastic moments so far  [J]
  Buffer<double> broke;      ///< energy that its rupture spent  [J]

  template <class Visit>
  void each_field(Visit&& field) {
    field("a", "-", a);
    field("b", "-", b);
    field("length", "m", length);
    field("stiffness", "N/m", stiffness);
    field("opening", "m", opening);
    field("shear", "N", shear);
    field("moment", "N m", moment);
    field("slid", "J", slid);
    field("yielded", "J", yielded);
    field("broke", "J", broke);
  }
  Index size() const { return a.size(); }
};

/// Pieces of bar.
struct SteelLinks {
  Buffer<Index> a, b;
  Buffer<double> length;  ///< L_s  [m]
  Buffer<SteelState> state;
  Buffer<double> yielded;  ///< energy spent on yielding so far  [J]
  Buffer<double> broke;    ///< energy that its rupture spent  [J]

  template <class Visit>
  void each_field(Visit&& field) {
    field("a", "-", a);
    field("b", "-", b);
    field("length", "m", length);
    field("state", "-", state);
    field("yielded", "J", yielded);
    field("broke", "J", broke);
  }
  Index size() const { return a.size(); }
};

/// Bonds between bars and concrete: a is the bar's element, b the concrete's.
struct InterfaceLinks {
  Buffer<Index> a, b;
  Buffer<Index> before,
      after;  ///< neighbours of a along its bar (a itself at an end): they give the axis
  Buffer<double> stiffness;  ///< K_tr  [N/m]
  Buffer<double> area;       ///< S, share of the bar's surface  [m2]
  Buffer<double> rest;       ///< radial distance at the start  [m]
  Buffer<InterfaceState> state;
  Buffer<double> slid;   ///< energy spent on bond slip and friction so far  [J]
  Buffer<double> broke;  ///< energy that its rupture spent  [J]

  template <class Visit>
  void each_field(Visit&& field) {
    field("a", "-", a);
    field("b", "-", b);
    field("before", "-", before);
    field("after", "-", after);
    field("stiffness", "N/m", stiffness);
    field("area", "m2", area);
    field("rest", "m", rest);
    field("state", "-", state);
    field("slid", "J", slid);
    field("broke", "J", broke);
  }
  Index size() const { return a.size(); }
};

/// What each interaction does to its two ends in this step, and how stiff it is; written once by
/// the laws, gathered by the elements.
struct Actions {
  Vec3Planes force;     ///< on b; a gets the opposite  [N]
  Vec3Planes torque_a;  ///< about the centre of a  [N m]
  Vec3Planes torque_b;  ///< about the centre of b  [N m]
  Buffer<float>
      stiffness;  ///< nine planes: K_xx K_yy K_zz, then K^theta of a, then of b  [N/m], [N m]

  void resize(Index count) {
    force.resize(count);
    torque_a.resize(count);
    torque_b.resize(count);
    stiffness.resize(9 * count);
  }
  Index size() const { return force.size(); }
};

/// A kernel's view of Actions, from a first interaction on.
struct ActionsView {
  PlanesView<double> force, torque_a, torque_b;
  View<float> stiffness;
  Index stride = 0;
  Index first = 0;  ///< interaction 0 of the kernel is this one

  /// Books force f and moment M on b of interaction i at arms along n, with tangent stiffnesses
  /// (Durand 2012, 4.4; docs/theory.md, time step).
  template <class R>
  BR_HD void book(Index i, const PairMotion<R>& motion, const Vec3Of<R>& f, const Vec3Of<R>& moment,
                  const R& normal, const R& shear, const R& bending, const R& twist) const {
    const Index at = first + i;
    const Vec3Of<R> lever = cross(motion.normal, f);
    store(force, at, f);
    store(torque_a, at, -(motion.arm_a * lever) - moment);
    store(torque_b, at, moment - motion.arm_b * lever);

    const Vec3Of<R> q{motion.normal.x * motion.normal.x, motion.normal.y * motion.normal.y,
                      motion.normal.z * motion.normal.z};
    const R stretch = normal - shear, screw = twist - bending;
    store_rounded(stiffness, at, shear + stretch * q.x);
    store_rounded(stiffness, stride + at, shear + stretch * q.y);
    store_rounded(stiffness, 2 * stride + at, shear + stretch * q.z);
    const R a = shear * motion.arm_a * motion.arm_a, b = shear * motion.arm_b * motion.arm_b;
    store_rounded(stiffness, 3 * stride + at, a + bending + (screw - a) * q.x);
    store_rounded(stiffness, 4 * stride + at, a + bending + (screw - a) * q.y);
    store_rounded(stiffness, 5 * stride + at, a + bending + (screw - a) * q.z);
    store_rounded(stiffness, 6 * stride + at, b + bending + (screw - b) * q.x);
    store_rounded(stiffness, 7 * stride + at, b + bending + (screw - b) * q.y);
    store_rounded(stiffness, 8 * stride + at, b + bending + (screw - b) * q.z);
  }
};

inline ActionsView view(Actions& actions, Index first) {
  return {actions.force.view(),     actions.torque_a.view(), actions.torque_b.view(),
          actions.stiffness.view(), actions.size(),          first};
}

}  // namespace breccia::dem
