#pragma once
// log.jsonl: what happened, one JSON object a line.

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "run/results/text_file.hpp"

namespace breccia {

enum class Level { info, warning, error };

/// The log of a run.
class Log {
 public:
  /// Adds to what is there.
  /// @param echo  where messages are repeated for people; may be null
  explicit Log(const std::string& path, std::FILE* echo = nullptr);

  /// Lines of later steps than `step` go: a run that goes on from there writes them anew.
  static void cut_to(const std::string& path, std::int64_t step);

  /// @param stage  "setup", "step", "frame", "checkpoint", "end"
  /// @param frame  number of the frame that the line is about, and its simulated time; may be left
  ///               out
  void write(Level level, const std::string& stage, std::int64_t step, const std::string& message,
             const std::optional<std::pair<std::int64_t, double>>& frame = {});
  /// And tells people of it, whether messages are repeated for them or not.
  void warn(const std::string& stage, std::int64_t step, const std::string& message);
  /// Unless it warned of the same before the run that it goes on with.
  void warn_once(const std::string& stage, std::int64_t step, const std::string& message);
  void sync() { file_.sync(); }

 private:
  std::vector<std::string> told_;  ///< warnings that were there
  LineFile file_;
  std::FILE* echo_;
};

}  // namespace breccia
