#pragma once
// The report of one run or two: one HTML file that needs nothing else and asks nobody for anything.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "report/record.hpp"

namespace breccia::report {

/// A laboratory's measurements beside the runs.
struct Measured {
  std::string name;
  NumberTable table;
};

struct Page {
  std::string html;
  std::vector<std::string> notes;  ///< what was left out, a sentence each
};

/// Writes the report. The same input gives the same bytes.
/// @param limit  of the frames of all runs together: beyond it they are thinned  [bytes]
/// @throws IoError or InputError if a frame cannot be read
Page page_of(const std::vector<Record>& runs, const std::optional<Measured>& measured,
             std::size_t limit = 14'000'000);

/// Text for HTML: what would be markup is spelled out.
std::string escaped_html(const std::string& text);

}  // namespace breccia::report
