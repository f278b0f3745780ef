#pragma once
// Tables in CSV files: what a run leaves, and what a laboratory measured.

#include <string>
#include <vector>

namespace breccia::report {

struct Column {
  std::string name, unit;  ///< unit: as the file tells it; of measured ones in SI
  std::vector<double> values;
};

struct NumberTable {
  std::vector<Column> columns;  ///< all of one length

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
  /// Null if there is none of this name.
  const Column* column(const std::string& name) const;
};

/// A table that a run left: names, units, numbers. A last line that a running program has only
/// begun is passed over.
/// @throws IoError if it cannot be read, InputError naming the line of what is no number
NumberTable read_table(const std::string& path);

/// A table of measurements, the first column being x: a line of names, perhaps one of units, then
/// numbers. Commas, semicolons or tabulators stand between them; next to semicolons and tabulators
/// a number may have a decimal comma. A unit may also stand behind a name, as in "force [kN]" or
/// "force (kN)"; its numbers become SI. Empty lines and lines that start with # are
/// passed over, empty fields are gaps (no number).
/// @throws IoError if it cannot be read, InputError naming the line or the unit that is wrong
NumberTable read_measured(const std::string& path);

}  // namespace breccia::report
