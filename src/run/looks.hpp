#pragma once
// What is seen of a world by its parts: each rank says what it finds in its own, and rank 0 puts
// that together. Nothing else travels.

#include <utility>

#include "run/shared_world.hpp"

namespace breccia {

/// What rank 0 may ask of a part; the first byte of its question.
enum class Look : std::uint8_t { energy };

inline Message question(Look look) {
  return {static_cast<std::byte>(look)};
}
inline Look look_of(const Message& question) {
  return static_cast<Look>(question.at(0));
}

/// A value as a message.
template <class T>
Message as_message(const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  Message message(sizeof value);
  std::memcpy(message.data(), &value, sizeof value);
  return message;
}
template <class T>
T value_in(const Message& message) {
  static_assert(std::is_trivially_copyable_v<T>);
  T value;
  BR_ASSERT(message.size() == sizeof value);
  std::memcpy(&value, message.data(), sizeof value);
  return value;
}

/// What a part holds, and what it has booked since it told last: rank 0 keeps that.
template <class Held, class Ledger>
struct EnergiesOfPart {
  Held held;
  Ledger booked;
};

/// Of a rank's part; it forgets what it has booked.
template <class World>
auto energies_of_part(World& part) {
  return EnergiesOfPart{held(part), std::exchange(part.ledger, {})};
}
/// Of all parts together; what they have booked goes to the ledger of the whole.
template <class World>
auto held_by_all(SharedWorld<World>& world, const typename SharedWorld<World>::Answer& answer) {
  using OfPart = decltype(energies_of_part(std::declval<World&>()));
  decltype(OfPart::held) all{};
  for (const Message& message : world.ask(question(Look::energy), answer)) {
    const auto part = value_in<OfPart>(message);
    all = all + part.held;
    add(world.ledger(), part.booked);
  }
  return all;
}

}  // namespace breccia
