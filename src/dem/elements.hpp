#pragma once
// Arrays of discrete elements.

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
  fixed_gone = 64,     ///< the element has been taken out of the model; bits before are set, too
  fixed_driven = 128,  ///< free, but for dashpots or a load: `motion` gives them, not a velocity;
                       ///< with one of x, y, z: a platen that rubs holds it
};

/// Whether a platen with friction holds an element.
BR_HD constexpr bool is_rubbed(int fixed) {
  return (fixed & fixed_driven) != 0 && (fixed & (fixed_x | fixed_y | fixed_z)) != 0;
}

BR_HD constexpr bool is_gone(std::uint8_t fixed) {
  return (fixed & fixed_gone) != 0;
}

/// Numbers that pairs read of an element, side by side in memory: they meet elements at random. The
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
/// bar. One item for each element, its ghosts included; who writes it, in brackets, in the words of
/// World. Constant: written by set-up; all of it moves with its element between ranks.
struct Elements {
  Buffer<GlobalId> id;             ///< number of the element, kept for ever  [-]  (constant)
  Buffer<std::int16_t> group;      ///< body, index into Model::groups  [-]  (constant)
  Buffer<std::int16_t> material;   ///< index into the case's materials  [-]  (constant)
  Buffer<double> mass;             ///<  [kg]  (constant)
  Buffer<double> inertia;          ///< the same about every axis  [kg m2]  (constant)
  Buffer<ElementState> state;      ///< position, velocity, spin (move); radius (constant)
  Buffer<Quaternion> orientation;  ///< since the start  [-]  (move)
  Buffer<Vec3> force;              ///< sum of all interactions at this time  [N]  (sums, walls)
  Buffer<Vec3> torque;             ///< about the centre  [N m]  (sums, walls)
  Buffer<std::uint8_t> fixed;      ///< prescribed degrees of freedom, bits of Fixed  [-]  (stage)
  Buffer<std::int16_t> motion;     ///< index into GivenMotions, -1: stands still  [-]  (stage)
  Buffer<double> damping_work;     ///< taken out by local damping so far  [J]  (move)
  Buffer<double> load_work;        ///< put in by prescribed motion so far  [J]  (move)

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
