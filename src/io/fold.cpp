#include "io/fold.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>

namespace breccia {
namespace {

/// Columns of UTF-8: bytes that continue a character take none.
std::size_t columns(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

std::string folded_line(std::string line, std::size_t width, std::size_t indent) {
  std::string text;
  while (columns(line) > width) {
    const std::size_t first = line.find_first_not_of(' ');
    std::size_t cut = line.rfind(' ', width);
    if (cut == std::string::npos || cut <= std::max(first, text.empty() ? 0 : indent))
      cut = line.find(' ', std::max(width, first));
    if (cut == std::string::npos) break;
    const std::size_t next = line.find_first_not_of(' ', cut);
    if (next == std::string::npos) break;
    text += line.substr(0, line.find_last_not_of(' ', cut) + 1) + '\n';
    line = std::string(indent, ' ') + line.substr(next);
  }
  return text + line;
}

}  // namespace

std::string folded(const std::string& text, std::size_t width, std::size_t indent) {
  std::string all;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    all += folded_line(text.substr(at, end - at), width, indent);
    if (end < text.size()) all += '\n';
    at = end + 1;
  }
  return all;
}

std::size_t columns_of(std::FILE* stream) {
  winsize size{};
  if (::ioctl(::fileno(stream), TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 200;
  return size.ws_col - 1U;  // the last column makes some terminals go to the next line
}

std::string fitting(const std::string& text, std::size_t indent, std::FILE* stream) {
  return ::isatty(::fileno(stream)) == 1 ? folded(text, columns_of(stream), indent) : text;
}

}  // namespace breccia
