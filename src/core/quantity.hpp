#pragma once
// The quantities of items that probes read and frames show: the one list of their words.

#include <cstdint>
#include <string>
#include <string_view>

#include "core/keys.hpp"
#include "exec/error.hpp"

namespace breccia {

/// A quantity as kernels read it.
struct Quantity {
  enum class Kind : std::uint8_t {
    position,
    displacement,
    velocity,
    force,
    torque,
    momentum,
    angular_momentum,
    speed,
    kinetic,
    stress,
    strain,
    damage,
    broken,
    opening,
    slip,
    axial_force,
    shear_force,
    spin,
    pressure,
    held,
    id,
    mode,
    time,
    group,
    material,
    fragment,
    rank,
    bar,
    exposed,
    link,
    state
  };
  Kind kind;
  int axis = -1;   ///< 0, 1, 2: x, y, z; -1: it has no direction
  int other = -1;  ///< second axis of a tensor's component
};

/// Bearers of a quantity: flags.
enum Bearer : unsigned {
  in_space = 1,    ///< elements of the DEM
  in_plane = 2,    ///< corners, triangles and joints of the FDEM
  of_wall = 4,     ///< a wall of the DEM
  in_solid = 8,    ///< corners, tetrahedra and joints of the FDEM in three dimensions
  of_bolt = 16,    ///< a bolt of the FDEM
  in_frames = 32,  ///< frames show it
  is_name = 64,    ///< likewise; its values are numbers of things, not sizes
  in_3d = in_space | in_solid,
  in_mesh = in_plane | in_solid
};

/// A quantity by its word.
struct NamedQuantity {
  const char* word;
  const char* unit;  ///< of the numbers in history.csv
  Quantity quantity;
  unsigned of;  ///< flags of Bearer
};
inline constexpr NamedQuantity quantities[] = {
    {"position_x", "m", {Quantity::Kind::position, 0}, in_3d | in_plane | of_wall},
    {"position_y", "m", {Quantity::Kind::position, 1}, in_3d | in_plane | of_wall},
    {"position_z", "m", {Quantity::Kind::position, 2}, in_3d | of_wall},
    {"displacement_x",
     "m",
     {Quantity::Kind::displacement, 0},
     in_3d | in_plane | of_wall | in_frames},
    {"displacement_y",
     "m",
     {Quantity::Kind::displacement, 1},
     in_3d | in_plane | of_wall | in_frames},
    {"displacement_z", "m", {Quantity::Kind::displacement, 2}, in_3d | of_wall | in_frames},
    {"velocity_x", "m/s", {Quantity::Kind::velocity, 0}, in_3d | in_plane | of_wall | in_frames},
    {"velocity_y", "m/s", {Quantity::Kind::velocity, 1}, in_3d | in_plane | of_wall | in_frames},
    {"velocity_z", "m/s", {Quantity::Kind::velocity, 2}, in_3d | of_wall | in_frames},
    {"force_x", "N", {Quantity::Kind::force, 0}, in_3d | in_plane | of_wall | in_frames},
    {"force_y", "N", {Quantity::Kind::force, 1}, in_3d | in_plane | of_wall | in_frames},
    {"force_z", "N", {Quantity::Kind::force, 2}, in_3d | of_wall | in_frames},
    {"torque_x", "N m", {Quantity::Kind::torque, 0}, in_3d | of_wall},
    {"torque_y", "N m", {Quantity::Kind::torque, 1}, in_3d | of_wall},
    {"torque_z", "N m", {Quantity::Kind::torque, 2}, in_3d | in_plane | of_wall},
    {"momentum_x", "kg m/s", {Quantity::Kind::momentum, 0}, in_3d | in_plane | of_wall},
    {"momentum_y", "kg m/s", {Quantity::Kind::momentum, 1}, in_3d | in_plane | of_wall},
    {"momentum_z", "kg m/s", {Quantity::Kind::momentum, 2}, in_3d | of_wall},
    {"angular_momentum_x", "kg m2/s", {Quantity::Kind::angular_momentum, 0}, in_3d | of_wall},
    {"angular_momentum_y", "kg m2/s", {Quantity::Kind::angular_momentum, 1}, in_3d | of_wall},
    {"angular_momentum_z",
     "kg m2/s",
     {Quantity::Kind::angular_momentum, 2},
     in_3d | in_plane | of_wall},
    {"speed", "m/s", {Quantity::Kind::speed}, in_3d | in_plane | of_wall},
    {"kinetic", "J", {Quantity::Kind::kinetic}, in_3d | in_plane | of_wall},
    {"stress_xx", "Pa", {Quantity::Kind::stress, 0, 0}, in_3d | in_plane | in_frames},
    {"stress_yy", "Pa", {Quantity::Kind::stress, 1, 1}, in_3d | in_plane | in_frames},
    {"stress_zz", "Pa", {Quantity::Kind::stress, 2, 2}, in_3d | in_frames},
    {"stress_xy", "Pa", {Quantity::Kind::stress, 0, 1}, in_3d | in_plane | in_frames},
    {"stress_yz", "Pa", {Quantity::Kind::stress, 1, 2}, in_3d | in_frames},
    {"stress_xz", "Pa", {Quantity::Kind::stress, 0, 2}, in_3d | in_frames},
    {"strain_xx", "-", {Quantity::Kind::strain, 0, 0}, in_3d | in_plane},
    {"strain_yy", "-", {Quantity::Kind::strain, 1, 1}, in_3d | in_plane},
    {"strain_zz", "-", {Quantity::Kind::strain, 2, 2}, in_3d},
    {"strain_xy", "-", {Quantity::Kind::strain, 0, 1}, in_3d | in_plane},
    {"strain_yz", "-", {Quantity::Kind::strain, 1, 2}, in_3d},
    {"strain_xz", "-", {Quantity::Kind::strain, 0, 2}, in_3d},
    {"damage", "-", {Quantity::Kind::damage}, in_3d | in_plane | in_frames},
    {"broken", "-", {Quantity::Kind::broken}, in_3d | in_plane},
    {"opening", "m", {Quantity::Kind::opening}, in_3d | in_plane | in_frames},
    {"slip", "m", {Quantity::Kind::slip}, in_mesh | in_frames},
    {"axial_force", "N", {Quantity::Kind::axial_force}, of_bolt | in_space},
    {"shear_force", "N", {Quantity::Kind::shear_force}, of_bolt},
    {"spin_x", "rad/s", {Quantity::Kind::spin, 0}, in_frames},
    {"spin_y", "rad/s", {Quantity::Kind::spin, 1}, in_frames},
    {"spin_z", "rad/s", {Quantity::Kind::spin, 2}, in_frames},
    {"pressure", "Pa", {Quantity::Kind::pressure}, in_frames},
    {"held", "-", {Quantity::Kind::held}, in_frames},
    {"id", "-", {Quantity::Kind::id}, in_frames},
    {"mode", "-", {Quantity::Kind::mode}, in_frames},
    {"time", "s", {Quantity::Kind::time}, in_frames},
    {"bar", "-", {Quantity::Kind::bar}, in_frames},
    {"group", "-", {Quantity::Kind::group}, in_frames | is_name},
    {"material", "-", {Quantity::Kind::material}, in_frames | is_name},
    {"fragment", "-", {Quantity::Kind::fragment}, in_frames | is_name},
    {"rank", "-", {Quantity::Kind::rank}, in_frames | is_name},
    {"exposed", "-", {Quantity::Kind::exposed}, in_frames | is_name},
    {"kind", "-", {Quantity::Kind::link}, in_frames | is_name},
    {"state", "-", {Quantity::Kind::state}, in_frames | is_name},
};

/// @throws InputError if it is none
inline const NamedQuantity& quantity_named(const std::string& word) {
  for (const NamedQuantity& named : quantities)
    if (word == named.word) return named;
  throw InputError(word + " is no quantity that a probe reads");
}

/// A unit for each metre of thickness, where thickness counts.
inline std::string per_metre(const std::string& unit) {
  if (unit == "N" || unit == "J") return unit + "/m";
  if (unit == "N m") return "N";
  if (unit == "kg m2/s") return "kg m/s";
  return unit == "kg m/s" ? "kg/s" : unit;
}

/// Name of a field of a frame: a vector or a tensor as a whole by its word without axes.
struct FieldWord {
  std::string name;
  std::string unit;
  int components;  ///< 1, 3, or 6: xx, yy, zz, xy, yz, xz
};
inline FieldWord field_word(const Quantity& of, bool per_thickness = false) {
  for (const NamedQuantity& named : quantities) {
    const Quantity& q = named.quantity;
    if ((named.of & in_frames) == 0 || q.kind != of.kind) continue;
    if (of.axis >= 0 && (q.axis != of.axis || q.other != of.other)) continue;
    const std::string_view word = named.word;
    const bool whole = of.axis < 0 && q.axis >= 0, tensor = q.other >= 0;
    return {std::string(whole ? word.substr(0, word.rfind('_')) : word),
            per_thickness ? per_metre(named.unit) : named.unit,
            !whole   ? 1
            : tensor ? 6
                     : 3};
  }
  throw InputError("frames do not show this quantity");
}

/// Whether the values of a field of this word are numbers of things, not sizes.
inline bool is_name_of_things(std::string_view word) {
  for (const NamedQuantity& named : quantities)
    if (word == named.word) return (named.of & is_name) != 0;
  return false;
}

/// The words of what one of these bearers has.
inline OneOf quantity_words(unsigned of) {
  OneOf words{};
  for (const NamedQuantity& named : quantities)
    if ((named.of & of) != 0) words.words.emplace_back(named.word);
  return words;
}

}  // namespace breccia
