#include "run/method/doubts.hpp"

#include <fmt/format.h>

#include <utility>

#include "io/round_numbers.hpp"

namespace breccia {

std::string long_step_text(double step, double end) {
  if (!(step > 0.02 * end)) return "";
  return fmt::format(
      "time.end: a step of {} is {:.2g} % of {}, and the last one may pass the end by as much; "
      "time.max_step = \"{}\" makes a hundred of the run",
      time_text(step), 100.0 * step / end, time_text(end), time_text(0.01 * end));
}

std::vector<std::string> doubts_of(Method& method, double end) {
  std::vector<std::string> doubts = method.warnings();
  if (method.steps() != 0) return doubts;
  if (std::string text = long_step_text(method.time_step(), end); !text.empty())
    doubts.push_back(std::move(text));
  return doubts;
}

}  // namespace breccia
