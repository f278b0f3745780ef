#include "domain/halo.hpp"

namespace breccia {

void Halo::build(Communicator& ranks, const Buffer<GlobalId>& ids, const std::vector<int>& owner) {
  const auto count = static_cast<std::size_t>(ranks.size());
  const int self = ranks.rank();
  std::vector<std::vector<Index>> receive(count);
  std::vector<Message> wanted(count);
  copies_ = 0;
  for (Index e = 0; e < ids.size(); ++e) {
    const int of = owner[static_cast<std::size_t>(e)];
    if (of == self) continue;
    receive[static_cast<std::size_t>(of)].push_back(e);
    ++copies_;
  }
  for (std::size_t r = 0; r < count; ++r) deal_detail::put(wanted[r], ids, receive[r]);
  const std::vector<Message> asked = ranks.exchange(std::move(wanted));

  peers_.clear();
  for (std::size_t r = 0; r < count; ++r) {
    Peer peer{static_cast<int>(r), {}, std::move(receive[r]), {}, {}};
    for (std::size_t at = 0; at < asked[r].size(); at += sizeof(GlobalId)) {
      GlobalId id = 0;
      std::memcpy(&id, asked[r].data() + at, sizeof id);
      peer.send.push_back(place_of(ids, id));
    }
    if (!peer.send.empty() || !peer.receive.empty()) peers_.push_back(std::move(peer));
  }
}

void Halo::post(Communicator& ranks) {
  to_.clear();
  from_.clear();
  for (Peer& peer : peers_) {
    if (!peer.sent.empty()) to_.push_back({peer.rank, peer.sent.data(), peer.sent.size()});
    if (!peer.came.empty()) from_.push_back({peer.rank, peer.came.data(), peer.came.size()});
  }
  ranks.start(to_, from_);
}

}  // namespace breccia
