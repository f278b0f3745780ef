#pragma once
// The text of a case file before it is parsed, and what no case file may be.

#include <string>
#include <string_view>

namespace breccia {

/// Refuses text that no case needs and that the parser would choke on: more than 16 MiB, a line of
/// more than 1 MiB, a dotted key of more than 16 parts (the parser follows nested tables by
/// recursion).
/// @param origin  where the text is from, for the message
/// @throws InputError naming the line
void check_case_source(std::string_view text, const std::string& origin);

/// The whole case file.
/// @throws InputError if it is not there, is no file or is too large; IoError if it cannot be read
std::string read_case_source(const std::string& path);

/// The file of a case: of a folder its case.toml.
std::string case_file_of(const std::string& path);

}  // namespace breccia
