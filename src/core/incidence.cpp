#include "core/incidence.hpp"

#include <limits>

#include "core/rows.hpp"
#include "exec/error.hpp"
#include "exec/for_each.hpp"
#include "exec/sort_scan.hpp"

namespace breccia {
namespace {

struct CountEnds {
  static constexpr const char* name = "core.count_ends";
  View<const Index> a, b;
  View<Index> counts;

  BR_HD void operator()(Index pair) const {
    count_up(counts[a[pair]]);
    count_up(counts[b[pair]]);
  }
};

struct PlaceEnds {
  static constexpr const char* name = "core.place_ends";
  View<const Index> a, b;
  View<Index> next;
  View<Entry> entries;

  BR_HD void operator()(Index pair) const {
    entries[count_up(next[a[pair]])] = 2 * pair;
    entries[count_up(next[b[pair]])] = 2 * pair + 1;
  }
};

/// By global id of the other end, then by pair.
struct PartnerBefore {
  View<const Index> a, b;
  View<const GlobalId> ids;

  BR_HD GlobalId partner(Entry entry) const {
    return ids[side_of(entry) == 0 ? b[pair_of(entry)] : a[pair_of(entry)]];
  }
  BR_HD bool operator()(Entry one, Entry other) const {
    const GlobalId id = partner(one), other_id = partner(other);
    return id != other_id ? id < other_id : one < other;
  }
};

struct SortRow {
  static constexpr const char* name = "core.sort_row";
  View<const Index> starts;
  View<Entry> entries;
  PartnerBefore before;

  BR_HD void operator()(Index element) const {
    const Index first = starts[element], count = starts[element + 1] - first;
    if (count > 1) sort_row(&entries[first], count, before);
  }
};

}  // namespace

void build_incidence(const Exec& exec, const Buffer<Index>& a, const Buffer<Index>& b,
                     const Buffer<GlobalId>& ids, Incidence& incidence) {
  BR_ASSERT(a.size() == b.size());
  const Index elements = ids.size(), pairs = a.size();
  if (pairs > std::numeric_limits<Index>::max() / 2)
    throw DeviceError(
        "the model needs more than the 1,073,741,823 pairs of elements whose ends fit a 32-bit "
        "index; use fewer elements, or a smaller search.margin or links.range");
  Buffer<Index>& starts = incidence.starts;
  starts.resize_unfilled(elements + 1);
  clear_bytes(starts.data(), starts.space(),
              static_cast<std::size_t>(starts.size()) * sizeof(Index));
  for_each(exec, pairs, CountEnds{a.view(), b.view(), starts.view()});
  exclusive_scan(exec, starts, 2 * pairs);
  incidence.entries.resize_unfilled(2 * pairs);
  Buffer<Index> next(starts);
  for_each(exec, pairs, PlaceEnds{a.view(), b.view(), next.view(), incidence.entries.view()});
  for_each(exec, elements,
           SortRow{starts.view(), incidence.entries.view(), {a.view(), b.view(), ids.view()}});
}

}  // namespace breccia
