#pragma once
// Texts from files, for a terminal.

#include <string>
#include <string_view>

namespace breccia {

/// The text with all spelled out that would steer a terminal or turn the order of what is read:
/// control characters of ASCII and Unicode, marks of writing direction, bytes that are no UTF-8.
/// @param kept  control characters that stay
std::string harmless(std::string_view text, std::string_view kept = "\n\t");

}  // namespace breccia
