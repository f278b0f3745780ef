#pragma once
// steps.csv: how long each step of a run took.

#include <cstdint>
#include <string>

#include "run/results/text_file.hpp"

namespace breccia {

/// One row of the table: the steps since the row before, which is one step.
struct StepRow {
  std::int64_t step = 0;
  double time = 0.0;          ///< simulated, at its end  [s]
  double wall = 0.0;          ///< wall time that it took  [s]
  std::int64_t searches = 0;  ///< for contacts in it  [-]
};

/// A CSV file: names in the first line, units in the second, then a row a step.
class StepTable {
 public:
  /// Opens the file to append; a new one gets its two head lines.
  explicit StepTable(const std::string& path);

  void write(const StepRow& row);
  void sync() { file_.sync(); }

 private:
  LineFile file_;
};

}  // namespace breccia
