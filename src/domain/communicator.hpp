#pragma once
// Messages between ranks: the one interface that all of them pass through.
//
// Every rank calls the same operations in the same order. Results are listed by rank and combined
// in that order, or by operations whose order cannot matter, so that no result depends on when a
// message arrives.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "exec/space.hpp"

namespace breccia {

class PeerLink;

/// The bytes that one rank sends to another.
using Message = std::vector<std::byte>;

/// Memory of a rank and the other rank that it goes to, or comes from.
struct Post {
  int rank;
  void* data;
  std::size_t bytes;
};

/// Messages of known size that go again and again from and to the same places in memory.
class RepeatedMessages {
 public:
  RepeatedMessages() = default;
  RepeatedMessages(const RepeatedMessages&) = delete;
  RepeatedMessages& operator=(const RepeatedMessages&) = delete;
  virtual ~RepeatedMessages() = default;

  /// Sends what lies there now; the memory stays untouched until finish(). Every rank calls both,
  /// if it has only empty lists. Meanwhile numbers may be combined (least, any_of, add_up), nothing
  /// else be exchanged.
  virtual void start() = 0;
  virtual void finish() = 0;
};

class Communicator {
 public:
  Communicator() = default;
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;
  virtual ~Communicator() = default;

  virtual int rank() const = 0;
  virtual int size() const = 0;

  /// Whether messages that are started may lie in that space.
  virtual bool reaches(Space space) const { return space == Space::host; }

  /// How ranks read each other's memory; null where they cannot.
  virtual PeerLink* link() { return nullptr; }

  /// Messages to and from other ranks, to be started as often as is wished. They are given up
  /// before their memory and before this object.
  virtual std::unique_ptr<RepeatedMessages> prepare(const std::vector<Post>& to,
                                                    const std::vector<Post>& from) = 0;

  /// Message r goes to rank r, the one for this rank itself included; returns what came, by rank.
  virtual std::vector<Message> exchange(std::vector<Message> messages) = 0;

  /// The least of all ranks' values.
  virtual double least(double value);
  /// The bits that are set on some rank.
  virtual std::uint64_t any_of(std::uint64_t bits);
  /// any_of in two parts: messages may be started and finished between them, no other reduction.
  /// A rank that has asked may do other work until the other ranks have asked.
  virtual void start_any_of(std::uint64_t bits) { asked_ = bits; }
  virtual std::uint64_t finish_any_of() { return any_of(asked_); }
  /// Each number becomes the sum of all ranks' numbers, modulo 2^64.
  virtual void add_up(std::span<std::int64_t> numbers);
  /// Every rank gets the message of rank 0.
  virtual Message from_first(Message message);

  /// Every rank gets every rank's message, by rank.
  virtual std::vector<Message> from_all(const Message& message);

  /// Whether all ranks are at the same point of the program: what happens on one happens on all.
  /// Not so while a rank does something that only it may fail at.
  bool in_step() const { return in_step_; }
  void set_in_step(bool in_step) { in_step_ = in_step; }

  /// How long this rank has waited for others so far, where that is measured.  [s]
  virtual double waited() const { return 0.0; }

  /// How long it has worked so far without waiting for others, where that is measured.  [s]
  virtual double worked() const { return 0.0; }

  /// How long a rank may be silent before all end with exit code 8; 0: for ever.  [s]
  virtual void set_patience(double /*seconds*/) {}

  /// Ends all ranks with this exit code, at once: when some of them can no longer be reached
  /// otherwise. Does not return where ranks are processes.
  virtual void abort(int exit_code) = 0;

 private:
  bool in_step_ = true;
  std::uint64_t asked_ = 0;
};

}  // namespace breccia
