#pragma once
// Progress of a run for a person: a bar on a terminal, plain lines elsewhere.

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace breccia {

/// How much is said.
enum class Speech { quiet, normal, verbose };

/// Where the run stands.
struct Standing {
  std::int64_t step = 0;
  double time = 0.0;   ///<  [s]
  double share = 0.0;  ///< of the whole run  [0, 1]
  std::string broken;  ///< how many links or joints are, in words; empty: there are none to break
  std::optional<double> missing{};  ///< relative error of the ledger in its last row; none yet  [-]
};

/// On a terminal: one line, never wider than it, that is redrawn up to five times a second.
/// Elsewhere: a line each tenth of the run, at most one a second.
class Progress {
 public:
  using Clock = std::chrono::steady_clock;
  enum class Form { none, lines, bar };

  /// The form for a stream: a bar if it is a terminal.
  static Form form_for(std::FILE* stream);

  Progress(std::FILE* stream, Form form);

  /// Whether show() would write something now. Cheap: asked once a step.
  bool due(double share, Clock::time_point now) const;
  void show(const Standing& standing, Clock::time_point now);
  /// The rate and the time left count from here.
  void start(const Standing& standing);
  /// Ends the line of a bar, so that other text can follow.
  void end_line();

 private:
  std::string text(const Standing& standing, Clock::time_point now, std::size_t width) const;

  std::FILE* stream_;
  Form form_;
  Standing first_;
  Clock::time_point start_ = Clock::now(), last_ = start_;
  double next_share_ = 0.1;
  bool line_open_ = false;
};

/// A bar and pieces of text, the most important first, in at most `width` columns: pieces that have
/// no room are left out, and the bar takes what is left, up to 24 columns.
std::string progress_line(double share, const std::vector<std::string>& pieces, std::size_t width);

/// A duration for people: "1.3 s", "4 min 05 s", "2 h 10 min".
std::string duration_text(double seconds);
/// A span of wall-clock time as people write it: 3h50m, 90m, 1.5h, 45, 00:45:00; nothing for what
/// is none.  [s]
std::optional<double> wall_time(const std::string& text);

}  // namespace breccia
