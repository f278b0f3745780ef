#include "run/results/checkpoints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <limits>

#include "exec/error.hpp"
#include "run/results/result_folder.hpp"

namespace breccia {

namespace fs = std::filesystem;

void Checkpoints::open(const std::string& folder) {
  folder_ = folder;
  make_folder(folder_);
}

bool Checkpoints::due(std::int64_t step, Clock::time_point now) const {
  if (!wanted()) return false;
  if (config_.steps > 0 && step % config_.steps == 0) return true;
  return now - last_time_ >= std::chrono::duration<double>(config_.wall);
}

std::int64_t Checkpoints::next_step(std::int64_t step) const {
  if (config_.steps <= 0 || !wanted()) return std::numeric_limits<std::int64_t>::max();
  return (step / config_.steps + 1) * config_.steps;
}

std::string Checkpoints::path(std::int64_t step) const {
  return fmt::format("{}/step_{:012}.br", folder_, step);
}

std::string Checkpoints::begin(std::int64_t step) {
  last_step_ = step;
  last_time_ = Clock::now();
  return path(step);
}

void Checkpoints::write(std::int64_t step, const CheckpointWriter& state) const {
  state.write(path(step));
  int kept = 0;
  for (const CheckpointFile& file : list_checkpoints(folder_)) {
    // Later ones are of a run that went back to an older state because they were damaged.
    if (file.step <= step && ++kept <= config_.keep) continue;
    std::error_code ignored;  // an old checkpoint that stays does no harm
    fs::remove(file.path, ignored);
  }
}

std::string Checkpoints::way_on(const std::string& folder) const {
  return wanted() ? fmt::format("  go on with: breccia resume {}\n", folder) : "";
}

std::vector<CheckpointFile> list_checkpoints(const std::string& folder) {
  std::vector<CheckpointFile> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("step_") || !name.ends_with(".br")) continue;
    std::int64_t step = 0;
    const char* const end = name.data() + name.size() - 3;
    const auto [stop, problem] = std::from_chars(name.data() + 5, end, step);
    if (problem == std::errc{} && stop == end) files.push_back({entry.path().string(), step});
  }
  std::sort(files.begin(), files.end(), [](const CheckpointFile& a, const CheckpointFile& b) {
    return a.step != b.step ? a.step > b.step : a.path < b.path;
  });
  return files;
}

CheckpointReader newest_good_checkpoint(const std::string& folder,
                                        const std::function<void(const std::string&)>& warn) {
  std::string reasons;
  for (const CheckpointFile& file : list_checkpoints(folder)) {
    try {
      return CheckpointReader(file.path);
    } catch (const Error& error) {
      warn(fmt::format("{}; going back to an older checkpoint", error.what()));
      reasons += fmt::format("\n  {}", error.what());
    }
  }
  if (reasons.empty()) reasons = " (there is none)";
  if (reasons.empty())
    reasons = "; none is there: the run kept none (checkpoint.keep = 0) or ended before its first";
  throw CheckpointError(fmt::format("{}: no checkpoint can be read{}", folder, reasons));
}

}  // namespace breccia
