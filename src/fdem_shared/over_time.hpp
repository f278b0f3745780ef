#pragma once
// Motions of supports and sizes of loads, which follow tables over time.

#include "core/table_over_time.hpp"
#include "math/vec.hpp"
#include "math/vec2.hpp"

namespace breccia::fdem_shared {

/// A vector over time: its parts, each by its own table; of a pressure x alone.
template <class Vector>
struct AmplitudeOf;
template <>
struct AmplitudeOf<Vec2> {
  Amplitude x, y;

  Vec2 at(double time) const { return {x.at(time), y.at(time)}; }
};
template <>
struct AmplitudeOf<Vec3> {
  Amplitude x, y, z;

  Vec3 at(double time) const { return {x.at(time), y.at(time), z.at(time)}; }
};

inline Vec2 by_parts(const Vec2& a, const Vec2& b) {
  return {a.x * b.x, a.y * b.y};
}
inline Vec3 by_parts(const Vec3& a, const Vec3& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// A support's velocity over time; the host puts its value of each step into World::motions.
template <class Vector>
struct PrescribedMotionOf {
  Vector velocity{};  ///<  [m/s]
  AmplitudeOf<Vector> over;

  Vector at(double time) const { return by_parts(over.at(time), velocity); }
};

/// Load on a side. Pressure and traction act per present length or area; a force is dead: it stays
/// as given however its sides deform. A fluid is a pressure that spreads into cracks. Each side
/// that a bolt pulls at has a force of its own.
enum class LoadKind : std::uint8_t { pressure, traction, force, absorbing, fluid, bolt };

inline LoadKind load_kind(const std::string& word) {
  if (word == "pressure") return LoadKind::pressure;
  if (word == "traction") return LoadKind::traction;
  if (word == "fluid") return LoadKind::fluid;
  return word == "force" ? LoadKind::force : LoadKind::absorbing;
}

/// A load with its value at this moment.
template <class Vector>
struct LoadLawOf {
  LoadKind kind;
  Vector factor;    ///< of the amplitude, now; of what has no direction all are alike  [-]
  double pressure;  ///<  [Pa]
  Vector traction;  ///<  [Pa]
  Vector force;     ///<  [N; in 2D N/m]
};

}  // namespace breccia::fdem_shared
