#pragma once
// Tells why a text is no TOML, in the words of somebody who writes cases.

#include <string>
#include <string_view>

namespace breccia {

/// @param description  of the parser, as in "Error while parsing array: expected ..., saw '\n'"
std::string plain_toml_error(std::string_view description);

}  // namespace breccia
