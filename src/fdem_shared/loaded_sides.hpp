#pragma once
// Sides of a rank's elements that loads act on.

#include <algorithm>
#include <vector>

#include "core/fields.hpp"

namespace breccia::fdem_shared {

/// The loaded sides of a rank's elements, and the first of each loaded element, and the end.
template <class Side>
struct LoadedSides {
  std::vector<Side> sides;
  std::vector<Index> starts;
};
/// @param all         of the whole mesh, by global id, ascending
/// @param element_of  element_of(side): the global id of its element, to become its place here
template <class Side, class Element>
LoadedSides<Side> loaded_here(const std::vector<Side>& all, const Buffer<GlobalId>& ids_of,
                              const Element& element_of) {
  LoadedSides<Side> here;
  std::vector<GlobalId> ids;
  copy_to(ids, ids_of);
  auto place = ids.begin();
  for (Side side : all) {
    Index& element = element_of(side);
    place = std::lower_bound(place, ids.end(), element);
    if (place == ids.end()) break;
    if (*place != element) continue;
    element = static_cast<Index>(place - ids.begin());
    if (here.sides.empty() || element_of(here.sides.back()) != element)
      here.starts.push_back(static_cast<Index>(here.sides.size()));
    here.sides.push_back(side);
  }
  here.starts.push_back(static_cast<Index>(here.sides.size()));
  return here;
}

}  // namespace breccia::fdem_shared
