#include "run/results/log.hpp"

#include <fmt/chrono.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <sstream>

#include "exec/no_memory.hpp"
#include "io/emphasis.hpp"
#include "io/fold.hpp"
#include "io/json.hpp"
#include "io/whole_file.hpp"

namespace breccia {
namespace {

const char* word(Level level) {
  switch (level) {
    case Level::info:
      return "info";
    case Level::warning:
      return "warning";
    case Level::error:
      return "error";
  }
  return "info";
}

std::string time_stamp() {
  const auto now = std::chrono::system_clock::now();
  const auto seconds = std::chrono::floor<std::chrono::seconds>(now);
  const auto milliseconds =
      std::chrono::duration_cast<std::chrono::milliseconds>(now - seconds).count();
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03d}Z",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(seconds)), milliseconds);
}

std::vector<std::string> warnings_in(const std::string& path) {
  std::vector<std::string> found;
  if (!std::filesystem::exists(path)) return found;
  const NeedsMemory scope;
  std::istringstream lines(read_whole_file(path));
  for (std::string line; std::getline(lines, line);) {
    const Json parsed = read_json(line);
    if (parsed.is_object() && parsed.value("level", "") == word(Level::warning))
      found.push_back(parsed.value("message", ""));
  }
  return found;
}

}  // namespace

Log::Log(const std::string& path, std::FILE* echo)
    : told_(warnings_in(path)), file_(path), echo_(echo) {}

void Log::write(Level level, const std::string& stage, std::int64_t step,
                const std::string& message,
                const std::optional<std::pair<std::int64_t, double>>& frame) {
  const NeedsMemory scope;
  Json line{{"time", time_stamp()},
            {"level", word(level)},
            {"stage", stage},
            {"step", step},
            {"message", message}};
  if (frame) {
    line["frame"] = frame->first;
    line["time_s"] = frame->second;
  }
  file_.append(json_text(line));
  if (echo_ != nullptr) std::fputs(fmt::format("  {}: {}\n", stage, message).c_str(), echo_);
}

void Log::warn(const std::string& stage, std::int64_t step, const std::string& message) {
  write(Level::warning, stage, step, message);
  const std::string text = fmt::format(
      "{} step {}: {}\n", emphasized(Emphasis::warning, "warning:", stderr), step, message);
  std::fputs(fitting(text, 2, stderr).c_str(), stderr);
}

void Log::warn_once(const std::string& stage, std::int64_t step, const std::string& message) {
  if (std::find(told_.begin(), told_.end(), message) == told_.end()) warn(stage, step, message);
}

void Log::cut_to(const std::string& path, std::int64_t step) {
  keep_lines(path, [step](std::string_view line) {
    const NeedsMemory scope;
    const auto parsed = read_json(line);
    return parsed.is_object() && parsed.value("step", std::int64_t{0}) <= step;
  });
}

}  // namespace breccia
