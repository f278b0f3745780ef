// All links by their ends, as a search leaves them out.

#include <algorithm>
#include <list>

#include "core/on_host.hpp"
#include "core/rows.hpp"
#include "dem/world.hpp"
#include "exec/filling.hpp"
#include "exec/sort_scan.hpp"

namespace breccia::dem {
namespace {

/// The ends of the links of one kind.
struct Ends {
  OnHost<Buffer<Index>> a, b;
  Index first;  ///< of them among links of all kinds

  Ends(const LinkEnds& set, Space space, Index before)
      : a(set.a, space), b(set.b, space), first(before) {}
};

/// Calls visit(lower end, higher end, link) for all links, by threads.
template <class Visit>
void each_link(int threads, const std::list<Ends>& sets, const Visit& visit) {
  for (const Ends& set : sets) {
    const Index* const a = set.a->data();
    const Index* const b = set.b->data();
    each_portion(threads, set.a->size(), [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i)
        visit(std::min(a[i], b[i]), std::max(a[i], b[i]), set.first + i);
    });
  }
}

struct Linked {
  Index partner, link;
  bool operator<(const Linked& other) const {
    return partner != other.partner ? partner < other.partner : link < other.link;
  }
};

}  // namespace

void set_linked_pairs(World& w) {
  const Exec host{.threads = w.exec.threads};
  const FillingThreads filling(host.threads);
  std::list<Ends> sets;
  Index count = 0;
  w.each_set([&](const auto& set) {
    sets.emplace_back(set, w.exec.space, count);
    count += set.size();
  });
  // Count, scan, fill by places: the order by ids.
  const Index elements = w.elements.size();
  Buffer<Index> starts(Space::host, elements + 1);
  each_link(host.threads, sets, [&](Index low, Index, Index) { count_up(starts.data()[low]); });
  exclusive_scan(host, starts);
  Buffer<Index> next(starts);
  Buffer<Linked> rows = unfilled<Linked>(Space::host, count);
  each_link(host.threads, sets, [&](Index low, Index high, Index link) {
    rows.data()[count_up(next.data()[low])] = {high, link};
  });
  each_portion(host.threads, elements, [&](Index begin, Index end) {
    for (Index e = begin; e < end; ++e) {
      const Index first = starts.data()[e], links = starts.data()[e + 1] - first;
      sort_row(rows.data() + first, links, [](const Linked& p, const Linked& q) { return p < q; });
    }
  });
  copy_to(w.linked_starts, starts);
  fill_items(w.linked_partners, count, host.threads,
             [&](Index i) { return rows.data()[i].partner; });
  fill_items(w.linked_links, count, host.threads, [&](Index i) { return rows.data()[i].link; });
}

}  // namespace breccia::dem
