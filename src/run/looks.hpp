#pragma once
// What is seen of a world by its parts: each rank says what it finds in its own, and rank 0 puts
// that together. Nothing else travels.

#include <utility>
#include <vector>

#include "core/probe.hpp"
#include "core/unsound.hpp"
#include "exec/error.hpp"
#include "run/frame_parts.hpp"
#include "run/shared_world.hpp"

namespace breccia {

/// What rank 0 may ask of a part; the first byte of its question.
enum class Look : std::uint8_t { energy, frame, probes, soundness };

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

/// What all probes read of a rank's part.
template <class World>
Message readings_of_part(World& part, const std::vector<ProbeConfig>& probes) {
  Message message;
  for (const ProbeConfig& probe : probes) {
    const Message read = as_message(read_own(part, probe));
    message.insert(message.end(), read.begin(), read.end());
  }
  return message;
}
/// And of all parts together: the values of the probes.
template <class World>
std::vector<double> read_by_all(SharedWorld<World>& world, const std::vector<ProbeConfig>& probes,
                                const typename SharedWorld<World>::Answer& answer) {
  std::vector<Readings> all(probes.size());
  for (const Message& message : world.ask(question(Look::probes), answer))
    for (std::size_t i = 0; i < all.size(); ++i) {
      Readings read;
      std::memcpy(&read, message.data() + i * sizeof read, sizeof read);
      all[i] = all[i] + read;
    }
  std::vector<double> values;
  for (std::size_t i = 0; i < all.size(); ++i) values.push_back(all[i].reduced(probes[i].reduce));
  return values;
}

/// The first unsound element of a rank's part, or nothing.
template <class World>
Message soundness_of_part(const World& part) {
  const Unsound bad = find_unsound(part);
  Message message;
  if (bad.id == Unsound::none) return message;
  message = as_message(bad.id);
  const auto* const text = reinterpret_cast<const std::byte*>(bad.text.data());
  message.insert(message.end(), text, text + bad.text.size());
  return message;
}
/// @throws NumericsError naming the first of the whole
template <class World>
void verify_all(SharedWorld<World>& world, const typename SharedWorld<World>::Answer& answer) {
  Unsound first;
  for (const Message& message : world.ask(question(Look::soundness), answer)) {
    if (message.empty()) continue;
    GlobalId id = Unsound::none;
    std::memcpy(&id, message.data(), sizeof id);
    if (id >= first.id) continue;
    first.id = id;
    first.text.assign(reinterpret_cast<const char*>(message.data()) + sizeof id,
                      message.size() - sizeof id);
  }
  if (first.id != Unsound::none) throw NumericsError(first.text);
}

/// This rank's share of a frame that all make.
template <class World>
Message share_of_frame(FramePart part, const World& world, const Message& question) {
  const FrameWish wish = wish_in(std::span(question).subspan(1));
  return FrameOfParts(std::move(part), wish, *world.domain.ranks, world.exec.threads).share();
}
/// The frame of all parts together. Rank 0 only.
/// @param make  a part's part of it
template <class World, class Make>
FrameOutput seen_by_all(SharedWorld<World>& world, const FrameWish& wish, const Make& make) {
  const int threads = world.part().exec.threads;
  if (world.part().domain.alone()) return frame_output(make(world.part()).frame, wish, threads);
  Message frame = question(Look::frame);
  put_wish(frame, wish);
  std::optional<FrameOfParts> made;
  const std::vector<Message> shares = world.ask(frame, [&](World& part, const Message&) {
    made.emplace(make(part), wish, *part.domain.ranks, threads);
    return made->share();
  });
  return made->output(shares);
}

/// Answers of a rank's part to all of these.
/// @param make  the part's part of a frame
template <class World, class Make>
typename SharedWorld<World>::Answer answers(const std::vector<ProbeConfig>& probes,
                                            const Make& make) {
  return [&probes, make](World& part, const Message& question) -> Message {
    switch (look_of(question)) {
      case Look::frame:
        return share_of_frame(make(part), part, question);
      case Look::energy:
        return as_message(energies_of_part(part));
      case Look::probes:
        return readings_of_part(part, probes);
      case Look::soundness:
        return soundness_of_part(part);
    }
    return {};
  };
}

}  // namespace breccia
