#pragma once
// All that is wrong with a case, in one message.

#include <cstdint>
#include <string>
#include <vector>

namespace breccia {

struct Problem {
  std::uint32_t line = 0;  ///< of the case file; 0: of no line
  std::string text;
};

/// "3 problems in <where>; nothing was run." and the problems, one a line, by their lines. A slip
/// in each of a hundred thousand items is told twenty times, and how many more there are.
std::string problems_text(std::vector<Problem> problems, const std::string& where);

}  // namespace breccia
