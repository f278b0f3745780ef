#pragma once
// How many bodies, supports or loads a model can number.

#include <cstddef>
#include <string>
#include <vector>

namespace breccia {

/// Models number bodies, materials, supports, walls and loads in 16 bits.
inline constexpr std::size_t most_names = 32767;

/// Adds a sentence if there are more items than a model can number.
inline void add_too_many(std::size_t count, const char* items, std::vector<std::string>& problems,
                         std::size_t most = most_names) {
  if (count > most)
    problems.push_back("the case has " + std::to_string(count) + " " + items + "; at most " +
                       std::to_string(most) + " are allowed");
}

}  // namespace breccia
