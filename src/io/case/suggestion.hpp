#pragma once
// The known word nearest to a misspelt one.

#include <set>
#include <string>

namespace breccia {

/// The known word that few slips of the pen make of `word`; empty if none is near.
std::string nearest(const std::string& word, const std::set<std::string>& known);

/// "; did you mean density?", or the allowed words if none is near and they are few, or nothing.
std::string suggestion(const std::string& word, const std::set<std::string>& known);

}  // namespace breccia
