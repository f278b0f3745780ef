#pragma once
// Numbers in the lines of a CSV file.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace breccia::prepare {

/// Hands the numbers of each line to `take`, which says whether they are what is wanted. Empty
/// lines, lines that start with # and a first line of names are passed over; in a line of names
/// each field begins with a letter.
/// @param wanted  what a line must be, for messages, as in "x,y in metres"
/// @throws IoError    if the file cannot be read
/// @throws InputError names file and line of what is not `count` finite numbers, or not taken
void read_csv(const std::string& path, std::size_t count, const std::string& wanted,
              const std::function<bool(const std::vector<double>&)>& take);

}  // namespace breccia::prepare
