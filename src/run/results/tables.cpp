#include "run/results/tables.hpp"

#include <fmt/format.h>

namespace breccia {

std::string to_csv(const Table& table) {
  std::string text =
      fmt::format("{}\n{}\n", fmt::join(table.columns, ","), fmt::join(table.units, ","));
  for (const std::vector<double>& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i)
      text += fmt::format("{}{:.17g}", i == 0 ? "" : ",", row[i]);
    text += '\n';
  }
  return text;
}

}  // namespace breccia
