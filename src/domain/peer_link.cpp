#include "domain/peer_link.hpp"

#include <cstdlib>

#include "domain/together.hpp"
#include "exec/device.hpp"

namespace breccia {

bool PeerLink::make_room(std::size_t bytes) {
  if (refused_) return false;
  if (own_ && bytes <= room_) return true;
  if (space_ == Space::cuda) wait_for_device();  // nothing is read or packed here from now on,
  close();
  ranks_.least(0.0);  // nor anywhere
  own_.reset();
  constexpr std::size_t line = 256;
  room_ = (bytes + bytes / 2) / line * line + line;
  // For comparisons: copies go by way of the host.
  if (std::getenv("BRECCIA_STAGED_COPIES") == nullptr) own_ = PeerMemory::make(space_, 2 * room_);

  const PeerPass pass = own_ ? own_->pass() : PeerPass{};
  const std::vector<PeerPass> passes = from_each(ranks_, pass);
  bool all = own_ != nullptr;
  peers_.resize(passes.size());
  for (std::size_t r = 0; r < passes.size() && all; ++r) {
    if (static_cast<int>(r) == ranks_.rank()) continue;
    peers_[r] = PeerMemory::open(space_, passes[r]);
    all = peers_[r] != nullptr;
  }
  if (ranks_.least(all ? 1.0 : 0.0) < 1.0) {
    refused_ = true;
    close();
    ranks_.least(0.0);
    own_.reset();
    return false;
  }
  for (auto& readers : readers_) readers.clear();  // they have taken all
  prepare_tokens();
  return true;
}

void PeerLink::prepare_tokens() {
  came_.resize(peers_.size());
  std::vector<Post> to, from;
  for (int r = 0; r < ranks_.size(); ++r) {
    if (r == ranks_.rank()) continue;
    to.push_back({r, &token_, 1});
    from.push_back({r, &came_[static_cast<std::size_t>(r)], 1});
  }
  tokens_ = ranks_.prepare(to, from);
}

std::byte* PeerLink::begin(const std::vector<int>& readers) {
  side_ = 1 - side_;
  for (const int rank : readers_[side_])
    peers_[static_cast<std::size_t>(rank)]->follow(taken_ + side_);
  readers_[side_] = readers;
  return half(*own_);
}

void PeerLink::packed() {
  own_->mark(packed_ + side_);
  tokens_->start();
}

void PeerLink::await(const std::vector<int>& owners) {
  tokens_->finish();
  for (const int rank : owners) peers_[static_cast<std::size_t>(rank)]->follow(packed_ + side_);
}

void PeerLink::close() {
  tokens_.reset();
  peers_.clear();
}

}  // namespace breccia
