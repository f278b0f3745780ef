#include "domain/communicator.hpp"

#include <algorithm>

namespace breccia {
namespace {

void send_once(Communicator& ranks, const std::vector<Post>& to, const std::vector<Post>& from) {
  const std::unique_ptr<RepeatedMessages> messages = ranks.prepare(to, from);
  messages->start();
  messages->finish();
}

/// Rank 0 combines the numbers of all ranks in the order of the ranks, and tells.
template <class T, class Combine>
void combine_all(Communicator& ranks, std::span<T> numbers, const Combine& combine) {
  if (ranks.rank() != 0) {
    const std::vector<Post> first{{0, numbers.data(), numbers.size_bytes()}};
    send_once(ranks, first, {});
    send_once(ranks, {}, first);
    return;
  }
  std::vector<Post> others;
  const auto count = static_cast<std::size_t>(ranks.size()) - 1;
  std::vector<T> came(count * numbers.size());
  for (std::size_t r = 0; r < count; ++r)
    others.push_back(
        {static_cast<int>(r) + 1, came.data() + r * numbers.size(), numbers.size_bytes()});
  send_once(ranks, {}, others);
  for (std::size_t i = 0; i < came.size(); ++i) {
    T& number = numbers[i % numbers.size()];
    number = combine(number, came[i]);
  }
  for (Post& post : others) post.data = numbers.data();
  send_once(ranks, others, {});
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
  combine_all(*this, numbers, [](std::int64_t a, std::int64_t b) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
  });
}

Message Communicator::from_first(Message message) {
  if (rank() != 0) message.clear();
  return from_all(message)[0];
}

}  // namespace breccia
