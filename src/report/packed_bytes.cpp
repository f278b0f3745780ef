#include "report/packed_bytes.hpp"

#include <zlib.h>

#include <algorithm>
#include <cmath>

#include "exec/error.hpp"

namespace breccia::report {
namespace {

double on_scale(bool root, double value) {
  return root ? std::copysign(std::sqrt(std::abs(value)), value) : value;
}

}  // namespace

void Planes::add(const std::vector<std::uint32_t>& numbers, int width) {
  for (int plane = 0; plane < width; ++plane)
    for (const std::uint32_t number : numbers)
      bytes_.push_back(static_cast<char>(number >> (8 * plane) & 255U));
}

std::uint32_t zigzag(std::uint32_t difference, int width) {
  const int unused = 32 - 8 * width;
  const auto shifted = static_cast<std::int32_t>(difference << unused);
  const std::int32_t value = shifted >> unused;  // with its sign
  const std::uint32_t folded =
      (static_cast<std::uint32_t>(value) << 1) ^ static_cast<std::uint32_t>(value >> 31);
  return folded & (~std::uint32_t{0} >> unused);
}

std::uint32_t Scale::step_of(float value) const {
  const double low_end = on_scale(root, low), high_end = on_scale(root, high);
  const double place = on_scale(root, std::isnan(value) ? 0.0 : static_cast<double>(value));
  if (!(high_end > low_end)) return 0;
  const double share = std::clamp((place - low_end) / (high_end - low_end), 0.0, 1.0);
  return static_cast<std::uint32_t>(std::lround(share * last));
}

std::string deflated(std::string_view bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  const int status =
      compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()), 9);
  if (status != Z_OK) throw DeviceError("not enough memory to compress the data of a report");
  packed.resize(size);
  return packed;
}

std::string base64(std::string_view bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text.push_back(k <= count ? digits[three >> (18 - 6 * k) & 63U] : '=');
  }
  return text;
}

}  // namespace breccia::report
