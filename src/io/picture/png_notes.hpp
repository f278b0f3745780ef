#pragma once
// Texts inside a PNG file: compressed iTXt chunks, which any viewer passes over.

#include <string>
#include <vector>

namespace breccia {

struct PngNote {
  std::string keyword;  ///< 1 to 79 letters, digits and spaces
  std::string text;     ///< UTF-8
};

/// The PNG with these texts behind its header; an empty content stays empty.
std::string with_notes(const std::string& png, const std::vector<PngNote>& notes);

/// The iTXt texts of a PNG file's content, at most 16 MiB in all.
/// @throws InputError naming `path` if it is no PNG, is cut, or a text of it is damaged or too long
std::vector<PngNote> notes_of(const std::string& png, const std::string& path);

/// The text under a keyword; empty if there is none.
std::string note(const std::vector<PngNote>& notes, const std::string& keyword);

}  // namespace breccia
