#pragma once
// Sharing elements out among ranks, whatever they are: who owns what, when that changes, and what
// all ranks must know alike (docs/theory-domain.md).

#include <algorithm>
#include <array>

#include "domain/domain.hpp"

namespace breccia {

/// The elements of a method as a re-partition sees them: those that a rank holds, own and ghosts.
class Shareable {
 public:
  virtual ~Shareable() = default;

  virtual const Buffer<GlobalId>& ids() const = 0;  ///< ascending
  /// Brings where elements are to the host, for centre() and radius().
  virtual void look() = 0;
  virtual Vec3 centre(Index element) const = 0;    ///< where it counts as being  [m]
  virtual double radius(Index element) const = 0;  ///< how far it reaches from there  [m]
  /// Where kernels see the elements.
  virtual Space space() const = 0;
  /// Brings them to the host, where all but look(), margin() and has_left() need them; settle_in()
  /// takes them back.
  virtual void come_to_host() = 0;
  /// The points whose travel the buffer bounds, one after the other; as many for each element.  [m]
  virtual std::vector<Vec3> points() const = 0;
  /// The cost of each element: its own, and that of each end of a bond or contact.
  virtual std::vector<std::int64_t> weights() const = 0;
  /// The largest margin that a search now would give an element of its own.  [m]
  virtual double margin() const = 0;
  /// Whether a point of an own element has left the buffer; nowhere (NaN) counts as left.
  virtual bool has_left() const = 0;
  virtual double largest_margin() const = 0;  ///< that any search gives  [m]
  /// Sends elements with all they own to their new owners; besides these, ranks whose rectangle is
  /// near enough get a copy.
  /// @param around  each element, where it counts as being
  virtual void send(const std::vector<int>& owner, const std::vector<Sphere>& around) = 0;
  /// Fills what follows from the elements that are here now, and from whose they are; not what a
  /// search fills.
  virtual void settle_in() = 0;
};

/// Makes all elements those of rank 0 and gives the domain its rectangles, not yet cut.
/// @param mean_size  of an element  [m]
/// @param depth      dimensions of the model
void begin_sharing(Domain& domain, Communicator& ranks, const DomainConfig& config,
                   const Shareable& elements, double mean_size, int depth);

/// Shares elements out anew: first moves borders where loads have become uneven, or for the first
/// time. Every rank calls it.
void share_anew(Domain& domain, Shareable& elements, bool first);

/// Does so if on some rank an element has left its buffer or become too fast.
void share_if_needed(Domain& domain, Shareable& elements);

/// Whether ranks have waited for the slowest one for longer than it takes to share elements out
/// anew. Every rank calls it.
bool is_uneven(const Domain& domain);

/// Items that tie elements together: each is held by every rank that owns one of its elements, and
/// so are all its elements.
class SharedItems {
 public:
  /// @param owner     rank that each local element will belong to
  /// @param elements  gets the elements that ranks need for their ties
  SharedItems(const Domain& domain, const std::vector<int>& owner, SendLists& elements)
      : domain_(domain), owner_(owner), elements_(elements) {}

  /// The members of an item go wherever one of them is owned.
  template <class Members>
  void keep_together(const Members& members) {
    const auto goes_along = [&, this](Index e) { return owner_of(e) == owner_of(members[0]); };
    if (std::all_of(std::begin(members), std::end(members), goes_along)) return;
    for (const Index e : members) {
      if (!domain_.owns(e)) continue;
      for (const Index other : members)
        if (owner_of(other) != owner_of(e)) elements_.add(owner_of(other), e);
    }
  }
  /// So does the item itself, from the owner of the first one.
  template <class Members>
  void keep_together(const Members& members, Index item, SendLists& items) {
    keep_together(members);
    if (!domain_.owns(members[0])) return;
    for (const Index e : members) items.add(owner_of(e), item);
  }
  /// `count` items, each with one member in every array.
  void keep_all_together(const std::vector<const Index*>& arrays, Index count, SendLists& items) {
    std::vector<Index> members(arrays.size());
    for (Index i = 0; i < count; ++i) {
      for (std::size_t k = 0; k < members.size(); ++k) members[k] = arrays[k][i];
      keep_together(members, i, items);
    }
  }
  int owner_of(Index e) const { return owner_[static_cast<std::size_t>(e)]; }

 private:
  const Domain& domain_;
  const std::vector<int>& owner_;
  SendLists& elements_;
};

/// Where a world is in time: equal on all ranks. Worlds name it alike.
template <class World>
void copy_time(const World& from, World& to) {
  to.time = from.time;
  to.last_dt = from.last_dt;
  to.next_dt = from.next_dt;
  to.step = from.step;
  to.searches = from.searches;
  to.stage = from.stage;
}
template <class World>
void take_time_from_first(Communicator& ranks, World& w) {
  for (double* time : {&w.time, &w.last_dt, &w.next_dt}) take_from_first(ranks, *time);
  take_from_first(ranks, w.step);
  take_from_first(ranks, w.searches);
  take_from_first(ranks, w.stage);
}

}  // namespace breccia
