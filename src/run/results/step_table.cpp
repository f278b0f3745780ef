#include "run/results/step_table.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace breccia {

StepTable::StepTable(const std::string& path) : file_(path) {
  std::error_code error;
  if (std::filesystem::file_size(path, error) > 0) return;
  file_.append("step,time,wall,searches");
  file_.append("-,s,s,-");
}

void StepTable::write(const StepRow& row) {
  file_.append(fmt::format("{},{:.17g},{:.9g},{}", row.step, row.time, row.wall, row.searches));
}

}  // namespace breccia
