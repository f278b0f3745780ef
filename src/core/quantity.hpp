#pragma once
// The quantities of items that probes read: the one list of their words.

#include <cstdint>
#include <string>

#include "core/keys.hpp"
#include "exec/error.hpp"

namespace breccia {

/// A quantity as kernels read it.
struct Quantity {
  enum class Kind : std::uint8_t { position, velocity, force, momentum, speed, kinetic, damage };
  Kind kind;
  int axis = -1;  ///< 0, 1, 2: x, y, z; -1: it has no direction
};

/// A quantity by its word in a case.
struct NamedQuantity {
  const char* word;
  const char* unit;  ///< of the numbers in history.csv
  Quantity quantity;
};
inline constexpr NamedQuantity quantities[] = {
    {"position_x", "m", {Quantity::Kind::position, 0}},
    {"position_y", "m", {Quantity::Kind::position, 1}},
    {"position_z", "m", {Quantity::Kind::position, 2}},
    {"velocity_x", "m/s", {Quantity::Kind::velocity, 0}},
    {"velocity_y", "m/s", {Quantity::Kind::velocity, 1}},
    {"velocity_z", "m/s", {Quantity::Kind::velocity, 2}},
    {"force_x", "N", {Quantity::Kind::force, 0}},
    {"force_y", "N", {Quantity::Kind::force, 1}},
    {"force_z", "N", {Quantity::Kind::force, 2}},
    {"momentum_x", "kg m/s", {Quantity::Kind::momentum, 0}},
    {"momentum_y", "kg m/s", {Quantity::Kind::momentum, 1}},
    {"momentum_z", "kg m/s", {Quantity::Kind::momentum, 2}},
    {"speed", "m/s", {Quantity::Kind::speed}},
    {"kinetic", "J", {Quantity::Kind::kinetic}},
    {"damage", "-", {Quantity::Kind::damage}},
};

/// @throws InputError if it is none
inline const NamedQuantity& quantity_named(const std::string& word) {
  for (const NamedQuantity& named : quantities)
    if (word == named.word) return named;
  throw InputError(word + " is no quantity that a probe reads");
}

/// The words of the quantities in space, or in the plane.
inline OneOf quantity_words(int axes) {
  OneOf words{};
  for (const NamedQuantity& named : quantities)
    if (named.quantity.axis < axes) words.words.emplace_back(named.word);
  return words;
}

}  // namespace breccia
