#pragma once
// The known word nearest to a misspelt one.

#include <set>
#include <string>

namespace breccia {

/// "; did you mean density?", or the allowed words if none is near and they are few, or nothing.
std::string suggestion(const std::string& word, const std::set<std::string>& known);

}  // namespace breccia
