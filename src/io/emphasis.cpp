#include "io/emphasis.hpp"

#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace breccia {
namespace {

bool shows_colors(std::FILE* stream) {
  const char* const refused = std::getenv("NO_COLOR");
  if (refused != nullptr && *refused != '\0') return false;
  const char* const terminal = std::getenv("TERM");
  if (terminal == nullptr || std::string_view(terminal) == "dumb") return false;
  return ::isatty(::fileno(stream)) == 1;
}

const char* code(Emphasis emphasis) {
  switch (emphasis) {
    case Emphasis::error:
      return "\033[1;31m";
    case Emphasis::warning:
      return "\033[33m";
    case Emphasis::good:
      return "\033[32m";
  }
  return "";
}

}  // namespace

std::string emphasized(Emphasis emphasis, const std::string& words, std::FILE* stream) {
  return shows_colors(stream) ? code(emphasis) + words + "\033[0m" : words;
}

}  // namespace breccia
