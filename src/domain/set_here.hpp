#pragma once
// Where the items of a named set of the whole model lie on a rank.

#include <span>

#include "domain/domain.hpp"

namespace breccia {

/// Places of those items of a set that a rank holds, of ghosts too, ascending; as long as elements
/// are not shared out anew.
struct SetHere {
  Buffer<Index> places{};
  std::int64_t sharing = -1;  ///< how often elements had been shared out when it was made
};

/// Makes the list anew if elements have been shared out since.
/// @param ids    of the rank's elements, ascending
/// @param items  of the whole model, ascending: item i belongs to the element i / per_element
/// @param space  of the places
void keep_here(SetHere& here, const Domain& domain, const Buffer<GlobalId>& ids,
               std::span<const Index> items, Index per_element, Space space);

}  // namespace breccia
