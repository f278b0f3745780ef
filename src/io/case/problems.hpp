#pragma once
// All that is wrong with a case, in one message.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "exec/error.hpp"

namespace breccia {

/// A slip of the pen and what was meant, in the text of a case.
struct Correction {
  std::uint32_t line = 0;    ///< of the file, from 1
  std::uint32_t column = 0;  ///< at or behind which `old` stands, from 1
  std::string old, now;      ///< as they stand in the file, texts in double quotes
};

struct Problem {
  std::uint32_t line = 0;  ///< of the case file; 0: of no line
  std::string text;
  std::optional<Correction> correction{};  ///< if only one thing can have been meant
};

/// The problems of a case file, for whom can mend them.
struct CaseError : InputError {
  /// @param text  of the file, for excerpts; empty: none
  CaseError(std::vector<Problem> all, const std::string& where, const std::string& text);
  std::vector<Problem> problems;
};

/// "3 problems in <where>; nothing was run." and the problems, one a line, by their lines; of few
/// with those lines of the text. A slip in each of a hundred thousand items is told twenty times,
/// and how many more there are.
std::string problems_text(std::vector<Problem> problems, const std::string& where,
                          const std::string& text);

/// A line of a text, to stand below a message, with a mark below its column; line 0: empty.
std::string excerpt(const std::string& text, std::uint32_t line, std::uint32_t column = 0);

/// The line of a case file that a sentence is about, by the key that it begins with; 0: none.
std::uint32_t line_of_sentence(const std::string& sentence, const std::string& path);

/// A text with the corrections applied, the last one first, so that columns stay true.
std::string corrected(const std::string& text, const std::vector<Problem>& problems);

}  // namespace breccia
