#pragma once
// What a discrete element carries.

#include "exec/buffer.hpp"
#include "math/vec.hpp"

/// A kernel compiled as one function: as functions of their own the parts of a law would hand their
/// vectors over through memory.
#if defined(__CUDACC__)
#define BR_WHOLE
#else
#define BR_WHOLE [[gnu::flatten]]
#endif

namespace breccia::dem {

/// Degrees of freedom that a support prescribes: bits of Elements::fixed.
enum Fixed : std::uint8_t {
  fixed_none = 0,
  fixed_x = 1,
  fixed_y = 2,
  fixed_z = 4,
  fixed_spin_x = 8,
  fixed_spin_y = 16,
  fixed_spin_z = 32,
};

/// What pairs read of an element, side by side in memory: they meet elements at random. The
/// position is at the time of the step, velocity and spin are half a step earlier (leapfrog).
template <class R>
struct ElementStateOf {
  Vec3Of<R> position;  ///< centre, world frame  [m]
  Vec3Of<R> velocity;  ///< of the centre  [m/s]
  Vec3Of<R> spin;      ///< angular velocity  [rad/s]
  R radius;            ///<  [m]
};
using ElementState = ElementStateOf<double>;

/// Rigid spheres with six degrees of freedom. Bars are spheres too, with the mass of their piece of
/// bar.
struct Elements {
  Buffer<GlobalId> id;             ///< number of the element, kept for ever  [-]
  Buffer<std::int16_t> group;      ///< body it belongs to, index into Model::groups  [-]
  Buffer<std::int16_t> material;   ///< index into the case's materials  [-]
  Buffer<double> mass;             ///<  [kg]
  Buffer<double> inertia;          ///< the same about every axis  [kg m2]
  Buffer<ElementState> state;      ///< position, velocity, spin, radius
  Buffer<Quaternion> orientation;  ///< since the start  [-]
  Buffer<Vec3> force;              ///< sum of all interactions at this time  [N]
  Buffer<Vec3> torque;             ///< about the centre  [N m]
  Buffer<std::uint8_t> fixed;      ///< prescribed degrees of freedom, bits of Fixed  [-]
  Buffer<std::int16_t> motion;     ///< index of the prescribed motion, -1: stands still  [-]
  Buffer<double> damping_work;     ///< taken out by local damping so far  [J]
  Buffer<double> load_work;        ///< put in by prescribed motion so far  [J]

  template <class Visit>
  void each_field(Visit&& field) {
    field("id", "-", id);
    field("group", "-", group);
    field("material", "-", material);
    field("mass", "kg", mass);
    field("inertia", "kg m2", inertia);
    field("state", "SI", state);
    field("orientation", "-", orientation);
    field("force", "N", force);
    field("torque", "N m", torque);
    field("fixed", "-", fixed);
    field("motion", "-", motion);
    field("damping_work", "J", damping_work);
    field("load_work", "J", load_work);
  }

  Index size() const { return id.size(); }
};

}  // namespace breccia::dem
