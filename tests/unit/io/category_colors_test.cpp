// Colours of ranks, bodies and other categories: as many as there are, they can be told apart.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "io/picture/color_map.hpp"
#include "io/whole_file.hpp"
#include "paths.hpp"

namespace breccia {
namespace category_colors_test {

constexpr std::size_t many = 32, first = 10;
using Three = std::array<double, 3>;
using Matrix = std::array<Three, 3>;

// Machado, Oliveira and Fernandes (2009): eyes that miss red, and that miss green.
constexpr Matrix all{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr Matrix no_red{{{0.152286, 1.052583, -0.204868},
                         {0.114503, 0.786281, 0.099216},
                         {-0.003882, -0.048116, 1.051998}}};
constexpr Matrix no_green{{{0.367322, 0.860646, -0.227968},
                           {0.280085, 0.672501, 0.047413},
                           {-0.011820, 0.042940, 0.968881}}};

Three times(const Matrix& m, const Three& v) {
  Three sum{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) sum[i] += m[i][j] * v[j];
  return sum;
}

double linear(double channel) {
  return channel <= 0.04045 ? channel / 12.92 : std::pow((channel + 0.055) / 1.055, 2.4);
}

/// In OKLab (Ottosson 2020), where equal distances look alike.
Three seen(const Color& color, const Matrix& eye) {
  Three light = times(eye, {linear(color.red), linear(color.green), linear(color.blue)});
  for (double& x : light) x = std::clamp(x, 0.0, 1.0);
  Three cone = times({{{0.4122214708, 0.5363325363, 0.0514459929},
                       {0.2119034982, 0.6806995451, 0.1073969566},
                       {0.0883024619, 0.2817188376, 0.6299787005}}},
                     light);
  for (double& x : cone) x = std::cbrt(x);
  return times({{{0.2104542553, 0.7936177850, -0.0040720468},
                 {1.9779984951, -2.4285922050, 0.4505937099},
                 {0.0259040371, 0.7827717662, -0.8086757660}}},
               cone);
}

/// Least distance of one of the later colours from any other.
double least_distance(const Matrix& eye) {
  double least = 1.0;
  for (std::size_t i = first; i < many; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Three a = seen(category_color(i), eye), b = seen(category_color(j), eye);
      least = std::min(least, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
    }
  return least;
}

TEST(CategoryColors, are_told_apart_by_all_eyes) {
  EXPECT_GT(least_distance(all), 0.07);
  EXPECT_GT(least_distance(no_red), 0.045);
  EXPECT_GT(least_distance(no_green), 0.045);
  EXPECT_EQ(category_color(many).red, category_color(0).red);
}

TEST(CategoryColors, are_those_of_reports) {
  const std::string source = read_whole_file(std::string(source_dir) + "/web/report/src/colors.js");
  const std::size_t begin = source.find("CATEGORIES"), end = source.find(']', begin);
  std::size_t at = begin;
  for (std::size_t i = 0; i < many; ++i) {
    at = source.find('#', at) + 1;
    ASSERT_LT(at, end);
    const unsigned long rgb = std::stoul(source.substr(at, 6), nullptr, 16);
    const Color color = category_color(i);
    const auto byte = [](float channel) {
      return static_cast<unsigned long>(std::lround(255.0F * channel));
    };
    EXPECT_EQ(rgb >> 16, byte(color.red)) << i;
    EXPECT_EQ(rgb >> 8 & 255UL, byte(color.green)) << i;
    EXPECT_EQ(rgb & 255UL, byte(color.blue)) << i;
  }
  EXPECT_GT(source.find('#', at), end);
}

}  // namespace category_colors_test
}  // namespace breccia
