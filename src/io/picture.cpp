#include "io/picture.hpp"

namespace breccia {

Extent bulk_extent(const Frame&) {
  return {{0, 0, 0}, {1, 1, 1}};
}
bool has_field(const Frame&, const std::string&) {
  return true;
}
Image render(const Frame&, const RenderOptions& options) {
  return {options.width, options.height,
          std::vector<std::uint8_t>(std::size_t(3 * options.width * options.height), 255)};
}
void write_png(const std::string&, const Image&) {}

}  // namespace breccia
