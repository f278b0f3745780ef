#pragma once
// Colours in a terminal.

#include <cstdio>
#include <string>

namespace breccia {

enum class Emphasis { error, warning, good };

/// The words in their colour where the stream is a terminal that shows colours, else as they are.
/// NO_COLOR in the environment, not empty, switches colours off (no-color.org).
std::string emphasized(Emphasis emphasis, const std::string& words, std::FILE* stream);

}  // namespace breccia
