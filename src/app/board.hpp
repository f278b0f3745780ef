#pragma once
// A run in 80 columns of text: where it stands, and its curves as rows of small bars.

#include <optional>
#include <string>
#include <vector>

#include "report/table.hpp"

namespace breccia::app {

/// State of a run while it goes on, as its files tell.
struct Watched {
  std::string folder, case_name, method;
  std::string status;              ///< as in summary.json, or "lost": nobody runs in its folder
  double end_time = 0.0;           ///< of its case; 0: not known  [s]
  report::NumberTable history;     ///< so far
  std::optional<double> broken{};  ///< links or joints, at the last checkpoint
};

/// Values as bars of eight heights between their smallest and largest, `width` of them, each the
/// mean of its share; bars of equal values are low ones. No number leaves a gap.
/// @param plain  with letters of ASCII alone
std::string sparkline(const std::vector<double>& values, std::size_t width, bool plain);

/// At most 80 columns wide; a line for each probe.
std::string board(const Watched& run, bool plain);

}  // namespace breccia::app
