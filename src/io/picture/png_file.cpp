// The only file that sees libpng.

#include <png.h>

#include <cstring>
#include <string>

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
bool encode(const Image& image, std::string& content) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, &content, append, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, 1);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_write_info(png, info);
  for (int y = 0; y < image.height; ++y) {
    png_write_row(png, image.rgb.data() + 3 * static_cast<std::ptrdiff_t>(y) * image.width);
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
      !encode(image, content))
    return {};
  return content;
}

void write_png(const std::string& path, const Image& image) {
  write_png(path, png_content(image));
}

void write_png(const std::string& path, const std::string& content) {
  if (content.empty()) throw IoError(path + ": cannot write: the image cannot be encoded as PNG");
  replace_file(path, content);
}

Image read_png(const std::string& path) {
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
  png.format = PNG_FORMAT_RGB;
  Image image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  image.rgb.resize(PNG_IMAGE_SIZE(png));
  const png_color white{255, 255, 255};
  if (png_image_finish_read(&png, &white, image.rgb.data(), 0, nullptr) == 0)
    fail(std::string("cannot be read as PNG: ") + png.message);
  return image;
}

}  // namespace breccia
