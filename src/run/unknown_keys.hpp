#pragma once
// Hints for keys that the method of a case does not have.

#include <string>

#include "io/case/problems.hpp"

namespace breccia {

/// Of an unknown key that other methods have: which, and what this one has in its place; of a word
/// without its table: the tables that have it. Other problems stay as they are.
Problem told_of_unknown(Problem problem, const std::string& method);

}  // namespace breccia
