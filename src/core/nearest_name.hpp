#pragma once
// The name that a slip of the pen may have meant.

#include <cstddef>
#include <string>
#include <vector>

namespace breccia {

/// Letters to add, drop, change or swap with the next to make one word of the other.
std::size_t slips_between(const std::string& a, const std::string& b);

/// "; did you mean floor?" of a name that few slips make of `word`, one for each three of its
/// letters; empty: there is none.
std::string meant_name(const std::string& word, const std::vector<std::string>& names);

}  // namespace breccia
