#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>

#include <filesystem>

#include "exec/error.hpp"
#include "io/picture/picture.hpp"
#include "unit/io/slab_scene.hpp"

namespace breccia {
namespace png_file_test {

/// Decodes with libpng's simplified interface.
Image read_png(const std::string& path) {
  png_image file{};
  file.version = PNG_IMAGE_VERSION;
  Image image;
  if (png_image_begin_read_from_file(&file, path.c_str()) == 0) return image;
  file.format = PNG_FORMAT_RGB;
  image.width = static_cast<int>(file.width);
  image.height = static_cast<int>(file.height);
  image.rgb.resize(PNG_IMAGE_SIZE(file));
  png_image_finish_read(&file, nullptr, image.rgb.data(), 0, nullptr);
  return image;
}

TEST(png_file, libpng_reads_back_the_same_pixels) {
  const std::string path = (std::filesystem::temp_directory_path() /
                            ("breccia_png_" + std::to_string(getpid()) + ".png"))
                               .string();
  RenderOptions options;
  options.width = 641;
  const Image image = render(test::slab_scene(), options);
  write_png(path, image);
  const Image read = read_png(path);
  EXPECT_EQ(read.width, 641);
  EXPECT_EQ(read.height, 960);
  EXPECT_EQ(read.rgb, image.rgb);
  std::filesystem::remove(path);
}

TEST(png_file, a_path_that_cannot_be_written_is_named_with_the_reason) {
  try {
    write_png("/nowhere/picture.png", {1, 1, {0, 0, 0}});
    FAIL();
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/picture.png"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos);
  }
  EXPECT_THROW(write_png("/tmp/never.png", {2, 2, {0, 0, 0}}), IoError);
  EXPECT_THROW(write_png("/dev/full/x.png", {1, 1, {0, 0, 0}}), IoError);
}

}  // namespace png_file_test
}  // namespace breccia
