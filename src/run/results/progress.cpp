#include "run/results/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "io/fold.hpp"
#include "io/round_numbers.hpp"

namespace breccia {

std::string duration_text(double seconds) {
  if (seconds < 1.0) return fmt::format("{:.0f} ms", 1e3 * seconds);
  if (seconds < 60.0) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<std::int64_t>(std::min(seconds, 1e12));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::optional<double> wall_time(const std::string& text) {
  const char* at = text.data();
  const char* const end = at + text.size();
  double seconds = 0.0;
  bool clock = false, any = false;
  while (at != end) {
    double number = 0.0;
    const auto [stop, error] = std::from_chars(at, end, number);
    if (error != std::errc{} || !(number >= 0.0) || !std::isfinite(number)) return std::nullopt;
    at = stop;
    any = true;
    if (at == end) {  // seconds, also of a clock
      seconds = clock ? 60.0 * seconds + number : seconds + number;
      break;
    }
    const char unit = *at++;
    if (unit == ':') {
      seconds = 60.0 * seconds + number;
      clock = true;
      if (at == end) return std::nullopt;
      continue;
    }
    if (clock) return std::nullopt;
    switch (unit) {
      case 'd':
        seconds += 86400.0 * number;
        break;
      case 'h':
        seconds += 3600.0 * number;
        break;
      case 'm':
        seconds += 60.0 * number;
        break;
      case 's':
        seconds += number;
        break;
      default:
        return std::nullopt;
    }
  }
  if (!any || !(seconds > 0.0)) return std::nullopt;
  return seconds;
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

std::string progress_line(double share, const std::vector<std::string>& pieces, std::size_t width) {
  constexpr std::size_t widest = 24, narrowest = 6, frame = 2;
  std::string text;
  for (const std::string& piece : pieces)
    if (text.size() + 2 + piece.size() <= width) text += (text.empty() ? "" : "  ") + piece;
  if (text.size() + 1 + frame + narrowest > width) return text;
  const std::size_t cells = std::min(widest, width - text.size() - 1 - frame);
  const auto filled =
      std::min(cells, static_cast<std::size_t>(std::floor(static_cast<double>(cells) * share)));
  return "[" + std::string(filled, '#') + std::string(cells - filled, '.') + "] " + text;
}

std::string Progress::text(const Standing& standing, Clock::time_point now,
                           std::size_t width) const {
  const double wall = std::chrono::duration<double>(now - start_).count();
  const double rate = wall > 0.0 ? static_cast<double>(standing.step - first_.step) / wall : 0.0;
  const double gained = standing.share - first_.share;
  std::vector<std::string> pieces{fmt::format("{:3.0f} %", 100.0 * standing.share)};
  if (gained > 0.0 && standing.share < 1.0)
    pieces.push_back("left " + duration_text(wall * (1.0 - standing.share) / gained));
  pieces.push_back(time_text(standing.time));
  if (!standing.broken.empty()) pieces.push_back(standing.broken);
  if (standing.missing)
    pieces.push_back(fmt::format("energy error {:.2g} %", 100.0 * *standing.missing));
  pieces.push_back(rate < 100.0 ? fmt::format("{:.1f} steps/s", rate)
                                : count_text(rate) + " steps/s");
  if (form_ == Form::bar) return progress_line(standing.share, pieces, width);
  std::string line;
  for (const std::string& piece : pieces) line += "  " + piece;
  return line;
}

void Progress::show(const Standing& standing, Clock::time_point now) {
  last_ = now;
  if (form_ == Form::lines) {
    next_share_ = 0.1 * (std::floor(10.0 * standing.share) + 1.0);
    std::fputs((text(standing, now, 0) + "\n").c_str(), stream_);
  } else if (form_ == Form::bar) {
    // \x1b[K clears what a longer line before left behind.
    std::fputs(("\r" + text(standing, now, columns_of(stream_)) + "\x1b[K").c_str(), stream_);
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
