#include "run/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "io/round_numbers.hpp"

namespace breccia {

std::string duration_text(double seconds) {
  if (seconds < 1.0) return fmt::format("{:.0f} ms", 1e3 * seconds);
  if (seconds < 60.0) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<std::int64_t>(std::min(seconds, 1e12));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string count_text(double count) {
  std::string digits = fmt::format("{:.0f}", count);
  const std::size_t first = digits.starts_with('-') ? 1 : 0;
  for (std::size_t i = digits.size(); i > first + 3;) {
    i -= 3;
    digits.insert(i, 1, ',');
  }
  return digits;
}

Progress::Form Progress::form_for(std::FILE* stream) {
  return ::isatty(::fileno(stream)) == 1 ? Form::bar : Form::lines;
}

Progress::Progress(std::FILE* stream, Form form) : stream_(stream), form_(form) {}

void Progress::start(const Standing& standing) {
  first_ = standing;
  start_ = last_ = Clock::now();
  next_share_ = 0.1 * (std::floor(10.0 * standing.share) + 1.0);
}

bool Progress::due(double share, Clock::time_point now) const {
  if (form_ == Form::none) return false;
  if (form_ == Form::bar) return now - last_ >= std::chrono::milliseconds(200);
  return share >= next_share_ && now - last_ >= std::chrono::seconds(1);
}

std::string Progress::text(const Standing& standing, Clock::time_point now) const {
  const double wall = std::chrono::duration<double>(now - start_).count();
  const double rate = wall > 0.0 ? static_cast<double>(standing.step - first_.step) / wall : 0.0;
  std::string line =
      fmt::format(" {:>8}  {:3.0f} %", time_text(standing.time), 100.0 * standing.share);
  line += rate < 100.0 ? fmt::format("  {:.1f} steps/s", rate)
                       : fmt::format("  {} steps/s", count_text(rate));
  if (!standing.broken.empty()) line += "  " + standing.broken;
  const double gained = standing.share - first_.share;
  if (gained > 0.0 && standing.share < 1.0)
    line += fmt::format("  left {}", duration_text(wall * (1.0 - standing.share) / gained));
  return line;
}

void Progress::show(const Standing& standing, Clock::time_point now) {
  last_ = now;
  const std::string line = text(standing, now);
  if (form_ == Form::lines) {
    next_share_ = 0.1 * (std::floor(10.0 * standing.share) + 1.0);
    std::fputs((line + "\n").c_str(), stream_);
  } else if (form_ == Form::bar) {
    constexpr int width = 24;
    const int filled = std::clamp(static_cast<int>(std::floor(width * standing.share)), 0, width);
    // \x1b[K clears what a longer line before left behind.
    const std::string bar =
        fmt::format("\r[{}{}]{}\x1b[K", std::string(static_cast<std::size_t>(filled), '#'),
                    std::string(static_cast<std::size_t>(width - filled), '.'), line);
    std::fputs(bar.c_str(), stream_);
    line_open_ = true;
  }
  std::fflush(stream_);
}

void Progress::end_line() {
  if (!line_open_) return;
  std::fputs("\n", stream_);
  std::fflush(stream_);
  line_open_ = false;
}

}  // namespace breccia
