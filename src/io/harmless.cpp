#include "io/harmless.hpp"

#include <fmt/format.h>

#include <cstdint>

namespace breccia {
namespace {

/// A character of Unicode and how many bytes it takes.
struct Character {
  std::uint32_t code;
  std::size_t bytes;  ///< 0: the text begins with no UTF-8
};

Character first_character(std::string_view text) {
  const auto byte = [&](std::size_t k) {
    return k < text.size() ? static_cast<unsigned char>(text[k]) : 0U;
  };
  const std::uint32_t lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4) return {lead, 0};
  std::uint32_t code = lead & (0xffU >> (bytes + 1));
  for (std::size_t k = 1; k < bytes; ++k) {
    if ((byte(k) & 0xc0) != 0x80) return {lead, 0};
    code = code << 6 | (byte(k) & 0x3f);
  }
  return {code, bytes};
}

bool steers(std::uint32_t code) {
  const bool control = code < 0x20 || (code >= 0x7f && code < 0xa0);
  const bool direction = code == 0x61c || code == 0x200e || code == 0x200f ||
                         (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  return control || direction;
}

}  // namespace

std::string harmless(std::string_view text, std::string_view kept) {
  std::string shown;
  while (!text.empty()) {
    const auto [code, bytes] = first_character(text);
    if (bytes == 0)
      shown += fmt::format("\\x{:02x}", code);
    else if (!steers(code) || (bytes == 1 && kept.find(text.front()) != std::string_view::npos))
      shown += text.substr(0, bytes);
    else
      shown += code < 0x80 ? fmt::format("\\x{:02x}", code) : fmt::format("\\u{:04x}", code);
    text.remove_prefix(bytes == 0 ? 1 : bytes);
  }
  return shown;
}

}  // namespace breccia
