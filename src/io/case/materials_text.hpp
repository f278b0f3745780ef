#pragma once
// The file materials.toml, as the program holds it.

#include <string_view>

namespace breccia {

std::string_view materials_text();

}  // namespace breccia
