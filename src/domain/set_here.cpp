#include "domain/set_here.hpp"

#include <algorithm>
#include <vector>

namespace breccia {

void keep_here(SetHere& here, const Domain& domain, const Buffer<GlobalId>& ids,
               std::span<const Index> items, Index per_element, Space space) {
  if (here.sharing == domain.counts.migrations) return;
  std::vector<GlobalId> id;
  copy_to(id, ids);
  std::vector<Index> places;
  auto next = items.begin();
  for (Index e = 0; e < ids.size(); ++e) {
    const Index first = per_element * id[static_cast<std::size_t>(e)];
    next = std::lower_bound(next, items.end(), first);
    for (; next != items.end() && *next < first + per_element; ++next)
      places.push_back(per_element * e + (*next - first));
  }
  here.places = Buffer<Index>(space);
  copy_to(here.places, places);
  here.sharing = domain.counts.migrations;
}

}  // namespace breccia
