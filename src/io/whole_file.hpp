#pragma once
// Small files that are read and replaced as a whole.

#include <cstdint>
#include <string>
#include <string_view>

namespace breccia {

/// As replace_file of io/file.hpp. @throws IoError with path and reason
void replace_file(const std::string& path, std::string_view content);
/// As replace_durably of io/file.hpp. @throws IoError with path and reason
void replace_durably(const std::string& path, std::string_view content);

/// @param limit  a longer file is refused  [bytes]
/// @throws IoError with path and reason
std::string read_whole_file(const std::string& path, std::uint64_t limit = std::uint64_t{1} << 32);

}  // namespace breccia
