#pragma once
// Rows of numbers in the files of public preprocessors of LDPM.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace breccia::prepare {

inline constexpr double millimetre = 1e-3;  ///< unit of length in these files  [m]

/// Hands the finite numbers of each line to `take`, none if the line holds anything else, with the
/// line's number. Empty lines and lines that begin with // or # are passed over.
/// @param take    says whether they are what is wanted
/// @param wanted  in words
/// @throws IoError    if the file cannot be read
/// @throws InputError names file and line that `take` refuses
void read_rows(const std::string& path, const std::string& wanted,
               const std::function<bool(const std::vector<double>&, std::size_t line)>& take);

}  // namespace breccia::prepare
