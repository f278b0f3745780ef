#include "core/pair_list.hpp"

#include "core/rows.hpp"
#include "core/select.hpp"

namespace breccia {
namespace {

/// The place of each key of one sorted list in another, or -1.
struct FindKey {
  static constexpr const char* name = "core.find_key";
  View<const PairKey> sought;
  View<const PairKey> among;
  View<Index> place;

  BR_HD void operator()(Index i) const {
    const PairKey key = sought[i];
    const Index at = lower_bound(among.data, 0, among.size, key);
    place[i] = at < among.size && among[at] == key ? at : -1;
  }
};

struct HasNoPlace {
  View<const Index> place;
  BR_HD bool operator()(Index i) const { return place[i] < 0; }
};

/// The places of the keys of `sought` that are not in `among`, ascending.
Buffer<Index> missing_from(const Exec& exec, const Buffer<PairKey>& sought,
                           const Buffer<PairKey>& among) {
  Buffer<Index> place(sought.space());
  match_keys(exec, among, sought, place);
  return items_where(exec, sought.size(), HasNoPlace{std::as_const(place).view()});
}

}  // namespace

void match_keys(const Exec& exec, const Buffer<PairKey>& old_keys, const Buffer<PairKey>& new_keys,
                Buffer<Index>& source) {
  source.resize_unfilled(new_keys.size());
  for_each(exec, new_keys.size(), FindKey{new_keys.view(), old_keys.view(), source.view()});
}

void find_dropped(const Exec& exec, const Buffer<PairKey>& old_keys,
                  const Buffer<PairKey>& new_keys, Buffer<Index>& dropped) {
  dropped = missing_from(exec, old_keys, new_keys);
}

}  // namespace breccia
