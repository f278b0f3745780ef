// The only file that sees libpng.

#include <png.h>
#include <zlib.h>

#include <cstring>
#include <string>
#include <vector>

#include "exec/error.hpp"
#include "io/picture/picture.hpp"
#include "io/whole_file.hpp"

namespace breccia {
namespace {

void append(png_structp png, png_bytep bytes, png_size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))
      ->append(reinterpret_cast<const char*>(bytes), count);
}

/// Encodes into `content`; false if libpng gave up. libpng leaves by longjmp: nothing here may own
/// memory.
/// @param row  room for a row with transparency
bool encode(const Image& image, std::string& content, std::vector<std::uint8_t>& row) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, &content, append, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), 8,
               image.alpha.empty() ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (image.dpi > 0) {
    const auto per_metre = static_cast<png_uint_32>(image.dpi / 0.0254 + 0.5);
    png_set_pHYs(png, info, per_metre, per_metre, PNG_RESOLUTION_METER);
  }
  png_set_compression_level(png, 1);
  png_set_compression_strategy(png, Z_RLE);  // as small, in 2/3 of the time: few rows repeat
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_write_info(png, info);
  for (int y = 0; y < image.height; ++y) {
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(y) * image.width;
    const std::uint8_t* const rgb = image.rgb.data() + 3 * first;
    for (std::ptrdiff_t x = 0; !image.alpha.empty() && x < image.width; ++x) {
      std::memcpy(row.data() + 4 * x, rgb + 3 * x, 3);
      row[static_cast<std::size_t>(4 * x + 3)] = image.alpha[static_cast<std::size_t>(first + x)];
    }
    png_write_row(png, image.alpha.empty() ? rgb : row.data());
  }
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return true;
}

}  // namespace

std::string png_content(const Image& image) {
  const auto pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  std::string content;
  content.reserve(image.rgb.size() / 2 + 1024);
  if (image.width < 1 || image.height < 1 || image.rgb.size() != 3 * pixels ||
      (!image.alpha.empty() && image.alpha.size() != pixels))
    return {};
  std::vector<std::uint8_t> row(4 * static_cast<std::size_t>(image.width));
  if (!encode(image, content, row)) return {};
  return content;
}

void write_png(const std::string& path, const Image& image) {
  write_png(path, png_content(image));
}

void write_png(const std::string& path, const std::string& content) {
  if (content.empty()) throw IoError(path + ": cannot write: the image cannot be encoded as PNG");
  replace_file(path, content);
}

namespace {

Image read_as(const std::string& path, bool with_alpha) {
  const std::string content = read_whole_file(path);
  png_image png;
  std::memset(&png, 0, sizeof png);
  png.version = PNG_IMAGE_VERSION;
  const auto fail = [&](const std::string& text) {
    png_image_free(&png);
    throw InputError(path + ": " + text);
  };
  if (png_image_begin_read_from_memory(&png, content.data(), content.size()) == 0)
    fail(std::string("cannot be read as PNG: ") + png.message);
  if (std::uint64_t{png.width} * png.height > (std::uint64_t{1} << 28))
    fail("the picture has more than 2^28 pixels");
  with_alpha = with_alpha && (png.format & PNG_FORMAT_FLAG_ALPHA) != 0;
  png.format = with_alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  Image image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  image.rgb.resize(PNG_IMAGE_SIZE(png));
  const png_color on_white{255, 255, 255};
  if (png_image_finish_read(&png, &on_white, image.rgb.data(), 0, nullptr) == 0)
    fail(std::string("cannot be read as PNG: ") + png.message);
  if (!with_alpha) return image;
  const std::size_t pixels = image.rgb.size() / 4;
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t c = 0; c < 3; ++c) image.rgb[3 * i + c] = image.rgb[4 * i + c];
    image.alpha.push_back(image.rgb[4 * i + 3]);
  }
  image.rgb.resize(3 * pixels);
  return image;
}

}  // namespace

Image read_png(const std::string& path) {
  return read_as(path, false);
}
Image read_png_with_alpha(const std::string& path) {
  return read_as(path, true);
}

}  // namespace breccia
