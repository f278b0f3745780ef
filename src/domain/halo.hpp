#pragma once
// Copies of other ranks' elements, and keeping them up to date.

#include <vector>

#include "domain/peer_link.hpp"
#include "domain/redistribute.hpp"
#include "exec/for_each.hpp"
#include "exec/staging.hpp"

namespace breccia {

template <class T>
struct PackItems {
  static constexpr const char* name = "domain.pack_items";
  View<const Index> which;
  View<const T> items;
  View<T> packed;
  BR_HD void operator()(Index i) const { packed[i] = items[which[i]]; }
};
template <class T>
struct UnpackItems {
  static constexpr const char* name = "domain.unpack_items";
  View<const Index> which;
  View<const T> packed;
  View<T> items;
  BR_HD void operator()(Index i) const { items[which[i]] = packed[i]; }
};

/// Unpacks items from another rank's memory: neighbouring threads read neighbouring numbers.
template <class T>
struct PullItems {
  static constexpr const char* name = "domain.pull_items";
  using Part = std::conditional_t<sizeof(T) % sizeof(double) == 0, double, std::byte>;
  static constexpr Index parts = sizeof(T) / sizeof(Part);
  View<const Index> which;
  Index first;  ///< of `which`
  View<const T> packed;
  View<T> items;
  BR_HD void operator()(Index i) const {
    const Index item = i / parts, part = i % parts;
    const auto* const from = reinterpret_cast<const Part*>(&packed[item]);
    reinterpret_cast<Part*>(&items[which[first + item]])[part] = from[part];
  }
};

/// A local element that another rank owns.
struct Ghost {
  Index element;
  int owner;
};

/// Exchange of a rank with each of its neighbours: items that it owns and they hold as ghosts, and
/// the other way round.
class Halo {
 public:
  /// @param ids     of the local elements, ascending, on the host
  /// @param ghosts  that will follow their owners, ascending
  /// @param space   where the items lie that will be exchanged
  void build(Communicator& ranks, const Buffer<GlobalId>& ids, const std::vector<Ghost>& ghosts,
             Space space = Space::host);

  /// Sends the items of owned elements to the ranks that hold ghosts of them. finish() then writes
  /// those that came. Every rank calls both.
  template <class T>
  void start(const Exec& exec, Communicator& ranks, Buffer<T>& items) {
    if (link(ranks, items.space(), sizeof(T))) return read_directly(exec, items);
    make_room(items.space(), sizeof(T));
    pack(exec, items, as_items<T>(out_));
    post(ranks, sizeof(T));
  }
  template <class T>
  void finish(const Exec& exec, Buffer<T>& items) {
    if (link_ != nullptr) return;  // it is done
    messages_->finish();
    take_in(sizeof(T));
    for_each(exec, receive_.size(),
             UnpackItems<T>{std::as_const(receive_).view(), as_items<T>(in_), items.view()});
  }
  template <class T>
  void refresh(const Exec& exec, Communicator& ranks, Buffer<T>& items) {
    start(exec, ranks, items);
    finish(exec, items);
  }

  Index ghosts() const { return receive_.size(); }  ///< of other ranks' elements held here
  /// Own elements that other ranks hold ghosts of, once for each.
  const Buffer<Index>& sent() const { return send_; }

 private:
  /// A neighbour and how many items go to it and come from it.
  struct Peer {
    int rank;
    std::size_t send, receive;
    Index begin = 0;  ///< of what comes among all that it packs; only where it is read from there
  };
  template <class T>
  static View<T> as_items(std::byte* bytes, Index count, Space space) {
    View<T> view;
    view.data = reinterpret_cast<T*>(bytes);
    view.size = count;
    view.space = space;
    return view;
  }
  template <class T>
  static View<T> as_items(Buffer<std::byte>& bytes) {
    return as_items<T>(bytes.data(),
                       static_cast<Index>(static_cast<std::size_t>(bytes.size()) / sizeof(T)),
                       bytes.space());
  }
  template <class T>
  void pack(const Exec& exec, const Buffer<T>& items, const View<T>& packed) const {
    for_each(exec, send_.size(), PackItems<T>{send_.view(), items.view(), packed});
  }
  /// A whole exchange: GPUs wait for each other by themselves, so nothing is put off.
  template <class T>
  void read_directly(const Exec& exec, Buffer<T>& items) {
    pack(exec, items, as_items<T>(link_->begin(readers_), send_.size(), items.space()));
    link_->packed();
    link_->await(owners_);
    Index first = 0;
    for (const Peer& peer : peers_) {
      const auto count = static_cast<Index>(peer.receive);
      const auto* const theirs = reinterpret_cast<const T*>(link_->half_of(peer.rank));
      View<const T> packed;
      packed.data = theirs + peer.begin;
      packed.size = count;
      for_each(exec, count * PullItems<T>::parts,
               PullItems<T>{std::as_const(receive_).view(), first, packed, items.view()});
      first += count;
    }
    link_->taken();
  }
  void find_sections(Communicator& ranks);
  bool link(Communicator& ranks, Space space, std::size_t item_bytes);
  void make_room(Space space, std::size_t item_bytes);
  void post(Communicator& ranks, std::size_t item_bytes);
  void prepare(Communicator& ranks, std::size_t item_bytes, std::byte* from, std::byte* to);
  void take_in(std::size_t item_bytes);

  std::vector<Peer> peers_;
  std::vector<int> readers_, owners_;  ///< those that get something, and that something comes from
  Index most_sent_ = 0;                ///< items of one rank
  Buffer<Index> send_, receive_;       ///< local elements of each peer, ascending by global id
  Buffer<std::byte> out_, in_;         ///< their items, packed peer by peer, where the elements lie
  Staging sent_, came_;                ///< out_ and in_ on the host, if messages need that
  bool staged_ = false;
  /// Kept from one exchange to the next, as long as items are as large and lie there.
  std::shared_ptr<RepeatedMessages> messages_;
  std::size_t item_bytes_ = 0;
  std::byte *from_ = nullptr, *to_ = nullptr;
  PeerLink* link_ = nullptr;  ///< of the exchange that was started last, if it takes this way
};

}  // namespace breccia
