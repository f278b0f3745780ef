#pragma once
// Ranks that go through the program together: each calls these at the same points.
//
// A null pointer in place of the ranks is a process alone, which does everything itself.

#include <functional>
#include <utility>

#include "domain/parcel.hpp"

namespace breccia {

/// Rank 0 writes files and speaks; a process alone does, too.
inline bool leads(const Communicator* ranks) {
  return ranks == nullptr || ranks->rank() == 0;
}

/// Does something on every rank that may fail on some. If it does, all ranks throw the error of the
/// lowest one that failed, so that none waits for another for ever.
void collective_try(Communicator* ranks, const std::function<void()>& work);

/// Does something on rank 0 alone; what it throws, all ranks throw.
template <class Work>
void on_first(Communicator* ranks, const Work& work) {
  collective_try(ranks, [&] {
    if (leads(ranks)) work();
  });
}

/// Does something that all ranks do at once: one that fails alone leaves the others waiting.
template <class Work>
void at_once(Communicator* ranks, const Work& work) {
  if (ranks == nullptr) return work();
  const bool before = ranks->in_step();
  ranks->set_in_step(false);
  work();
  ranks->set_in_step(before);
}

/// Whether an error that this rank has caught was thrown by all.
inline bool thrown_by_all(const Communicator* ranks) {
  return ranks == nullptr || ranks->in_step();
}

/// Every rank gets the value that rank 0 has.
template <class T>
void take_from_first(Communicator& ranks, T& value) {
  Message message;
  put_value(message, value);
  message = ranks.from_first(std::move(message));
  value = Unpacking(message).value<T>();
}

/// A value of each rank, by rank.
template <class T>
std::vector<T> from_each(Communicator& ranks, const T& value) {
  Message message;
  put_value(message, value);
  std::vector<T> values;
  for (const Message& came : ranks.from_all(message)) values.push_back(Unpacking(came).value<T>());
  return values;
}

/// The arrays of all ranks, one behind the other, by rank.
template <class T>
std::vector<T> joined(Communicator& ranks, const std::vector<T>& own) {
  Message message;
  put_array(message, own);
  std::vector<T> all;
  for (const Message& came : ranks.from_all(message)) {
    const std::vector<T> of_rank = Unpacking(came).array<T>();
    all.insert(all.end(), of_rank.begin(), of_rank.end());
  }
  return all;
}

/// The messages of all ranks, by rank; on others than rank 0 none.
inline std::vector<Message> told_to_first(Communicator& ranks, Message message) {
  std::vector<Message> messages(static_cast<std::size_t>(ranks.size()));
  messages[0] = std::move(message);
  messages = ranks.exchange(std::move(messages));
  if (ranks.rank() != 0) messages.clear();
  return messages;
}

}  // namespace breccia
