#pragma once
// Small files that are read and replaced as a whole.

#include <string>
#include <string_view>

namespace breccia {

/// Writes a file under a temporary name in the same folder, then renames it: under its name stands
/// either the old file or the new one. @throws IoError with path and reason
void replace_file(const std::string& path, std::string_view content);

/// @throws IoError with path and reason
std::string read_whole_file(const std::string& path);

}  // namespace breccia
