#pragma once
// Lines that fit a terminal.

#include <cstddef>
#include <cstdio>
#include <string>

namespace breccia {

/// The text with each line longer than `width` broken at a blank, and what goes to the next line
/// indented. A word longer than that stays whole.
/// @param indent  columns before what was broken off
std::string folded(const std::string& text, std::size_t width, std::size_t indent);

/// Columns of the terminal behind a stream; many where that is not known.
std::size_t columns_of(std::FILE* stream);

/// As folded() where the stream is a terminal, else the text as it is: programs read lines.
std::string fitting(const std::string& text, std::size_t indent, std::FILE* stream);

}  // namespace breccia
