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

/// The most that the frames of a page take together.  [bytes]
inline constexpr std::size_t page_bytes = 14'000'000;

/// Writes the report. The same input gives the same bytes.
/// @param limit  of the frames of all runs together: beyond it they are thinned  [bytes]
/// @throws IoError or InputError if a frame cannot be read
Page page_of(const std::vector<Record>& runs, const std::optional<Measured>& measured,
             std::size_t limit = page_bytes);

/// The page of a run that may still go on, for a server: it asks `/state` how far the run is and
/// loads again where that says more than `state` does.
/// @param state  JSON with `status` and the number of `frames`
Page live_page_of(const Record& run, const std::string& state);

/// Text for HTML: what would be markup is spelled out.
std::string escaped_html(const std::string& text);

}  // namespace breccia::report
