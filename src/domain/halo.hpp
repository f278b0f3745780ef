#pragma once
// Copies of other ranks' elements, and keeping them up to date.

#include <vector>

#include "domain/deal.hpp"

namespace breccia {

/// What a rank exchanges with each of its neighbours: items that it owns and they hold copies of,
/// and the other way round.
class Halo {
 public:
  /// @param ids    of the local elements, ascending
  /// @param owner  rank that owns each
  void build(Communicator& ranks, const Buffer<GlobalId>& ids, const std::vector<int>& owner);

  /// Sends the items of owned elements to the ranks that hold copies of them; returns at once.
  /// finish() then writes those that came. Every rank calls both.
  template <class T>
  void start(Communicator& ranks, const Buffer<T>& items) {
    for (Peer& peer : peers_) {
      peer.sent.clear();
      deal_detail::put(peer.sent, items, peer.send);
      peer.came.resize(peer.receive.size() * sizeof(T));
    }
    post(ranks);
  }
  template <class T>
  void finish(Communicator& ranks, Buffer<T>& items) {
    ranks.finish();
    for (const Peer& peer : peers_) {
      const std::byte* from = peer.came.data();
      for (const Index i : peer.receive) {
        std::memcpy(items.data() + i, from, sizeof(T));
        from += sizeof(T);
      }
    }
  }
  template <class T>
  void refresh(Communicator& ranks, Buffer<T>& items) {
    start(ranks, items);
    finish(ranks, items);
  }

  Index copies() const { return copies_; }  ///< elements of other ranks that this one holds

 private:
  struct Peer {
    int rank;
    std::vector<Index> send, receive;  ///< local elements, ascending by global id
    Message sent, came;
  };
  void post(Communicator& ranks);

  std::vector<Peer> peers_;
  std::vector<Post> to_, from_;
  Index copies_ = 0;
};

}  // namespace breccia
