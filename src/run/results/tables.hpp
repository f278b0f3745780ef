#pragma once

#include <string>

#include "run/method/method.hpp"

namespace breccia {

/// A table as CSV: names in the first line, units in the second, numbers that read back to the same
/// bits.
std::string to_csv(const Table& table);

}  // namespace breccia
