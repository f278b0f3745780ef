#include "domain/communicator.hpp"

#include <algorithm>
#include <cstring>

namespace breccia {
namespace {

template <class T>
Message message_of(std::span<const T> items) {
  Message message(items.size_bytes());
  if (!items.empty()) std::memcpy(message.data(), items.data(), items.size_bytes());
  return message;
}

/// Combines the numbers of all ranks in the order of the ranks.
template <class T, class Combine>
void combine_all(Communicator& ranks, std::span<T> numbers, const Combine& combine) {
  const std::vector<Message> all = ranks.from_all(message_of(std::span<const T>(numbers)));
  for (std::size_t r = 0; r < all.size(); ++r)
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      T number;
      std::memcpy(&number, all[r].data() + i * sizeof(T), sizeof(T));
      numbers[i] = r == 0 ? number : combine(numbers[i], number);
    }
}

}  // namespace

std::vector<Message> Communicator::from_all(const Message& message) {
  return exchange(std::vector<Message>(static_cast<std::size_t>(size()), message));
}

double Communicator::least(double value) {
  combine_all(*this, std::span<double>(&value, 1),
              [](double a, double b) { return b < a ? b : a; });
  return value;
}

std::uint64_t Communicator::any_of(std::uint64_t bits) {
  combine_all(*this, std::span<std::uint64_t>(&bits, 1),
              [](std::uint64_t a, std::uint64_t b) { return a | b; });
  return bits;
}

void Communicator::add_up(std::span<std::int64_t> numbers) {
  combine_all(*this, numbers, [](std::int64_t a, std::int64_t b) { return a + b; });
}

Message Communicator::from_first(Message message) {
  if (rank() != 0) message.clear();
  return from_all(message)[0];
}

}  // namespace breccia
