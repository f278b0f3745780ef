#include "domain/halo.hpp"

#include "domain/parcel.hpp"
#include "exec/device.hpp"

namespace breccia {

void Halo::build(Communicator& ranks, const Buffer<GlobalId>& ids, const std::vector<Ghost>& ghosts,
                 Space space) {
  const auto count = static_cast<std::size_t>(ranks.size());
  std::vector<std::vector<Index>> receive(count);
  std::vector<Message> wanted(count);
  for (const Ghost& ghost : ghosts)
    receive[static_cast<std::size_t>(ghost.owner)].push_back(ghost.element);
  for (std::size_t r = 0; r < count; ++r) redistribute_detail::put(wanted[r], ids, receive[r]);
  const std::vector<Message> asked = ranks.exchange(std::move(wanted));

  messages_.reset();
  peers_.clear();
  std::vector<Index> all_sent, all_received;
  Places places(ids);
  for (std::size_t r = 0; r < count; ++r) {
    const Peer peer{static_cast<int>(r), asked[r].size() / sizeof(GlobalId), receive[r].size()};
    Unpacking from(asked[r]);
    for (std::size_t k = 0; k < peer.send; ++k)
      all_sent.push_back(places.of(from.value<GlobalId>()));
    all_received.insert(all_received.end(), receive[r].begin(), receive[r].end());
    if (peer.send + peer.receive > 0) peers_.push_back(peer);
  }
  send_ = receive_ = Buffer<Index>(space);
  copy_to(send_, all_sent);
  copy_to(receive_, all_received);
  if (ranks.link() != nullptr && ranks.link()->space() == space) find_sections(ranks);
}

/// Where others find theirs among what a rank packs for all.
void Halo::find_sections(Communicator& ranks) {
  readers_.clear();
  owners_.clear();
  std::vector<Message> begins(static_cast<std::size_t>(ranks.size()));
  Index begin = 0;
  for (const Peer& peer : peers_) {
    put_value(begins[static_cast<std::size_t>(peer.rank)], begin);
    begin += static_cast<Index>(peer.send);
    if (peer.send > 0) readers_.push_back(peer.rank);
    if (peer.receive > 0) owners_.push_back(peer.rank);
  }
  begins = ranks.exchange(std::move(begins));
  for (Peer& peer : peers_)
    peer.begin = Unpacking(begins[static_cast<std::size_t>(peer.rank)]).value<Index>();
  most_sent_ = static_cast<Index>(-ranks.least(-static_cast<double>(begin)));
}

/// Whether what is exchanged now is read from the owners' memory: so on all ranks, or on none.
bool Halo::link(Communicator& ranks, Space space, std::size_t item_bytes) {
  PeerLink* const link = ranks.link();
  const bool linked = link != nullptr && link->space() == space &&
                      link->make_room(static_cast<std::size_t>(most_sent_) * item_bytes);
  link_ = linked ? link : nullptr;
  return linked;
}

void Halo::make_room(Space space, std::size_t item_bytes) {
  const auto grow = [&](Buffer<std::byte>& bytes, Index items) {
    const auto need = static_cast<Index>(static_cast<std::size_t>(items) * item_bytes);
    if (bytes.space() == space && bytes.size() >= need) return;
    messages_.reset();
    if (bytes.space() != space) bytes = Buffer<std::byte>(space);
    bytes.resize(need);
  };
  grow(out_, send_.size());
  grow(in_, receive_.size());
}

void Halo::post(Communicator& ranks, std::size_t item_bytes) {
  std::byte *from = out_.data(), *to = in_.data();
  const Space space = out_.space();
  staged_ = !ranks.reaches(space);
  if (staged_) {
    const std::size_t bytes = static_cast<std::size_t>(send_.size()) * item_bytes;
    sent_.make_room(space, bytes);
    came_.make_room(space, static_cast<std::size_t>(receive_.size()) * item_bytes);
    copy_bytes(sent_.data(), Space::host, out_.data(), space, bytes);
    from = sent_.data();
    to = came_.data();
  } else if (space == Space::cuda) {
    wait_for_device();  // until items are packed, and those that came last are unpacked
  }
  // A copy of this halo has buffers elsewhere, and so messages of its own.
  if (!messages_ || item_bytes != item_bytes_ || from != from_ || to != to_)
    prepare(ranks, item_bytes, from, to);
  messages_->start();
}

void Halo::prepare(Communicator& ranks, std::size_t item_bytes, std::byte* from, std::byte* to) {
  messages_.reset();
  item_bytes_ = item_bytes;
  from_ = from;
  to_ = to;
  std::vector<Post> sends, receives;
  for (const Peer& peer : peers_) {
    const std::size_t sent = peer.send * item_bytes, came = peer.receive * item_bytes;
    if (sent > 0) sends.push_back({peer.rank, from, sent});
    if (came > 0) receives.push_back({peer.rank, to, came});
    from += sent;
    to += came;
  }
  messages_ = ranks.prepare(sends, receives);
}

void Halo::take_in(std::size_t item_bytes) {
  if (staged_)
    copy_bytes(in_.data(), in_.space(), came_.data(), Space::host,
               static_cast<std::size_t>(receive_.size()) * item_bytes);
}

}  // namespace breccia
