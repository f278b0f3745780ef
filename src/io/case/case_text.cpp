// How values, ranges and lists of keys are written, and the digest of a case.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "io/case/case_file.hpp"

namespace breccia {

std::string number_text(double value) {
  if (std::isinf(value)) return value < 0.0 ? "-inf" : "inf";
  return fmt::format("{}", value);  // the shortest text that reads back to the same bits
}

std::string value_text(double value) {
  const std::string text = number_text(value);
  return text.find_first_of(".einf") == std::string::npos ? text + ".0" : text;
}
std::string value_text(int value) {
  return std::to_string(value);
}
std::string value_text(std::int64_t value) {
  return std::to_string(value);
}
std::string value_text(const Vec3& v) {
  return "[" + value_text(v.x) + ", " + value_text(v.y) + ", " + value_text(v.z) + "]";
}
std::string value_text(const Vec2& v) {
  return "[" + value_text(v.x) + ", " + value_text(v.y) + "]";
}
std::string value_text(bool value) {
  return value ? "true" : "false";
}
std::string value_text(const std::string& value) {
  std::string text = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\')
      text += std::string("\\") + c;
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      text += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      text += c;
  }
  return text + "\"";
}

namespace {
template <class Item>
std::string list_text(const std::vector<Item>& items) {
  std::string text = "[";
  for (const Item& item : items) text += (text.size() > 1 ? ", " : "") + value_text(item);
  return text + "]";
}
}  // namespace

std::string value_text(const std::vector<std::string>& value) {
  return list_text(value);
}
std::string value_text(const std::vector<Vec2>& value) {
  return list_text(value);
}
std::string value_text(const std::vector<Vec3>& value) {
  return list_text(value);
}
std::string value_text(const std::vector<double>& value) {
  return list_text(value);
}

namespace {
/// A value, or the rows [t, v, ...] of its table.
template <int parts, class Value>
std::string over_time_text(const OverTime<Value>& quantity) {
  if (!quantity.is_table()) return value_text(quantity.value);
  std::string text;
  for (std::size_t i = 0; i < quantity.times.size(); ++i) {
    text += (text.empty() ? "[[" : ", [") + value_text(quantity.times[i]);
    for (int k = 0; k < parts; ++k) text += ", " + value_text(component(quantity.values[i], k));
    text += "]";
  }
  return text + "]";
}
}  // namespace

std::string value_text(const OverTime<double>& value) {
  return over_time_text<1>(value);
}
std::string value_text(const OverTime<Vec2>& value) {
  return over_time_text<2>(value);
}
std::string value_text(const OverTime<Vec3>& value) {
  return over_time_text<3>(value);
}

std::string key_text(const std::string& name) {
  const bool bare = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
  return bare ? name : value_text(name);
}

std::string range_text(const Range& range) {
  const bool low = std::isinf(range.low), high = std::isinf(range.high);
  const bool open_low = range.open == Open::low || range.open == Open::both;
  const bool open_high = range.open == Open::high || range.open == Open::both;
  if (low && high) return "";
  const auto bound = [](double x) {  // many zeros are hard to count
    return std::abs(x) >= 1e7 && !std::isinf(x) ? fmt::format("{:g}", x) : number_text(x);
  };
  if (high) return (open_low ? "> " : ">= ") + bound(range.low);
  return (open_low || low ? "(" : "[") + bound(range.low) + ", " + bound(range.high) +
         (open_high ? ")" : "]");
}

std::string words_text(const OneOf& words) {
  std::string text;
  for (const std::string& word : words.words) text += (text.empty() ? "" : " | ") + word;
  return text;
}

namespace {

/// One block of SHA-256 (FIPS 180-4, 6.2.2).
void digest_block(std::array<std::uint32_t, 8>& hash, const unsigned char* block) {
  static const std::array<std::uint32_t, 64> constants = [] {
    // First 32 bits of the fractional parts of the cube roots of the first 64 primes.
    std::array<std::uint32_t, 64> k{};
    std::size_t found = 0;
    for (int n = 2; found < 64; ++n) {
      bool prime = true;
      for (int d = 2; d * d <= n; ++d) prime = prime && n % d != 0;
      if (!prime) continue;
      const long double root = std::cbrt(static_cast<long double>(n));
      k[found++] = static_cast<std::uint32_t>((root - std::floor(root)) * 4294967296.0L);
    }
    return k;
  }();
  std::array<std::uint32_t, 64> w{};
  for (std::size_t t = 0; t < 16; ++t)
    for (std::size_t k = 0; k < 4; ++k) w[t] = (w[t] << 8) | block[4 * t + k];
  for (std::size_t t = 16; t < 64; ++t) {
    const std::uint32_t s0 = std::rotr(w[t - 15], 7) ^ std::rotr(w[t - 15], 18) ^ (w[t - 15] >> 3);
    const std::uint32_t s1 = std::rotr(w[t - 2], 17) ^ std::rotr(w[t - 2], 19) ^ (w[t - 2] >> 10);
    w[t] = w[t - 16] + s0 + w[t - 7] + s1;
  }
  auto [a, b, c, d, e, f, g, h] = hash;
  for (std::size_t t = 0; t < 64; ++t) {
    const std::uint32_t s1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
    const std::uint32_t t1 = h + s1 + ((e & f) ^ (~e & g)) + constants[t] + w[t];
    const std::uint32_t s0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
    const std::uint32_t t2 = s0 + ((a & b) ^ (a & c) ^ (b & c));
    h = g;
    g = f;
    f = e;
    e = d + t1;
    d = c;
    c = b;
    b = a;
    a = t1 + t2;
  }
  const std::array<std::uint32_t, 8> add{a, b, c, d, e, f, g, h};
  for (std::size_t k = 0; k < 8; ++k) hash[k] += add[k];
}

}  // namespace

std::string without_comments(const std::string& text) {
  std::string kept;
  bool quoted = false, comment = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '\n')
      quoted = comment = false;
    else if (c == '"' && !comment)
      quoted = !quoted;
    else if (c == '#' && !quoted)
      comment = true;
    if (comment) continue;
    kept += c;
    if (c == '\\' && quoted && at + 1 < text.size()) kept += text[++at];
  }
  return kept;
}

std::string case_digest(const std::string& text) {
  std::array<std::uint32_t, 8> hash{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                    0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::string padded = text + '\x80';
  while (padded.size() % 64 != 56) padded += '\0';
  const std::uint64_t bits = text.size() * 8;
  for (int k = 7; k >= 0; --k) padded += static_cast<char>((bits >> (8 * k)) & 0xff);
  for (std::size_t at = 0; at < padded.size(); at += 64)
    digest_block(hash, reinterpret_cast<const unsigned char*>(padded.data()) + at);
  std::string hex;
  for (const std::uint32_t word : hash) hex += fmt::format("{:08x}", word);
  return hex;
}

}  // namespace breccia
