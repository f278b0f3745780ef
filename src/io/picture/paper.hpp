#pragma once
// Surfaces that annotations are drawn on: the pixels of an image, or another kind of page.

#include <string_view>

#include "io/picture/color_map.hpp"
#include "io/picture/picture.hpp"

namespace breccia {

/// Places are pixels from the upper left corner; `scale` is that of text.
class Paper {
 public:
  int width, height;  ///<  [pixels]

  Paper(int wide, int high) : width(wide), height(high) {}
  virtual ~Paper() = default;
  virtual void fill(int left, int top, int right, int bottom, const Color& color) = 0;
  /// A line of text; (x, y) is its upper left corner.
  virtual void write(int x, int y, std::string_view text, int scale, const Color& color) = 0;
  /// A straight stroke.
  virtual void stroke(double from_x, double from_y, double to_x, double to_y, double thick,
                      const Color& color) = 0;
  /// Fades what lies under annotations, so that they can be read; on the white ground nothing
  /// changes.
  virtual void veil(int left, int top, int right, int bottom, int scale) = 0;
};

class ImagePaper : public Paper {
 public:
  explicit ImagePaper(Image& image) : Paper(image.width, image.height), image_(image) {}
  void fill(int left, int top, int right, int bottom, const Color& color) override;
  void write(int x, int y, std::string_view text, int scale, const Color& color) override;
  void stroke(double from_x, double from_y, double to_x, double to_y, double thick,
              const Color& color) override;
  void veil(int left, int top, int right, int bottom, int scale) override;

 private:
  Image& image_;
};

}  // namespace breccia
