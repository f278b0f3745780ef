#include "io/picture/color_map.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "exec/error.hpp"

namespace breccia {
namespace {

constexpr Color from_bytes(std::uint32_t rgb) {
  return {static_cast<float>(rgb >> 16 & 255U) / 255.0F,
          static_cast<float>(rgb >> 8 & 255U) / 255.0F, static_cast<float>(rgb & 255U) / 255.0F};
}

// Nodes at even distances. Viridis by S. van der Walt and N. Smith (2015, public domain); diverging
// after K. Moreland (2009), "Diverging color maps for scientific visualization".
constexpr std::array viridis{from_bytes(0x440154), from_bytes(0x482878), from_bytes(0x3e4989),
                             from_bytes(0x31688e), from_bytes(0x26828e), from_bytes(0x1f9e89),
                             from_bytes(0x35b779), from_bytes(0x6ece58), from_bytes(0xb5de2b),
                             from_bytes(0xfde725)};
constexpr std::array diverging{from_bytes(0x3b4cc0), from_bytes(0x6282ea), from_bytes(0x8db0fe),
                               from_bytes(0xb8d0f9), from_bytes(0xdddddd), from_bytes(0xf5c4ad),
                               from_bytes(0xf49a7b), from_bytes(0xde604d), from_bytes(0xb40426)};
constexpr std::array damage_colors{from_bytes(0xded6c6), from_bytes(0xe9ca9a), from_bytes(0xf0a85a),
                                   from_bytes(0xe67a2e), from_bytes(0xcf4620), from_bytes(0xa81c18),
                                   from_bytes(0x6e0a14)};
constexpr std::array earth{from_bytes(0xe4dfd4), from_bytes(0xecdcbd), from_bytes(0xf3cf9f),
                           from_bytes(0xf2b98b), from_bytes(0xeaa184)};
// Magma by the authors of viridis.
constexpr std::array magma{from_bytes(0x000004), from_bytes(0x180f3d), from_bytes(0x440f76),
                           from_bytes(0x721f81), from_bytes(0x9e2f7f), from_bytes(0xcd4071),
                           from_bytes(0xf1605d), from_bytes(0xfd9668), from_bytes(0xfeca8d),
                           from_bytes(0xfcfdbf)};
constexpr std::array gray{from_bytes(0x202020), from_bytes(0xf0f0f0)};
// From the eleventh on each lies as far from all before it as can be, in OKLab, of eyes that see
// all colours and of those that miss red or green (Machado and others 2009).
constexpr std::array categories{
    from_bytes(0xded6c6), from_bytes(0x4a78a8), from_bytes(0x5c5f66), from_bytes(0x6aa56b),
    from_bytes(0xd98c3f), from_bytes(0x8d6bb1), from_bytes(0x46a3a8), from_bytes(0xc25b6e),
    from_bytes(0x9a8a3c), from_bytes(0xd0a2c4), from_bytes(0x481888), from_bytes(0x184818),
    from_bytes(0xc8c828), from_bytes(0x187818), from_bytes(0x781858), from_bytes(0x48d888),
    from_bytes(0x5848b8), from_bytes(0x8898e8), from_bytes(0xd8e888), from_bytes(0x284878),
    from_bytes(0x18c8e8), from_bytes(0x2888e8), from_bytes(0x288878), from_bytes(0x981838),
    from_bytes(0x883898), from_bytes(0x88d8e8), from_bytes(0x986848), from_bytes(0xd878c8),
    from_bytes(0x88b898), from_bytes(0xd8a818), from_bytes(0x785888), from_bytes(0x3868c8)};

std::span<const Color> nodes_of(ColorMap map) {
  switch (map) {
    case ColorMap::diverging:
      return diverging;
    case ColorMap::damage:
      return damage_colors;
    case ColorMap::ground:
      return earth;
    case ColorMap::magma:
      return magma;
    case ColorMap::gray:
      return gray;
    case ColorMap::viridis:
      break;
  }
  return viridis;
}

}  // namespace

Color blend(const Color& a, const Color& b, float share) {
  return {a.red + share * (b.red - a.red), a.green + share * (b.green - a.green),
          a.blue + share * (b.blue - a.blue)};
}

Color shaded(const Color& color, float factor) {
  return {std::min(1.0F, factor * color.red), std::min(1.0F, factor * color.green),
          std::min(1.0F, factor * color.blue)};
}

ColorMap map_named(const std::string& name) {
  if (name == "viridis") return ColorMap::viridis;
  if (name == "diverging") return ColorMap::diverging;
  if (name == "damage") return ColorMap::damage;
  if (name == "ground") return ColorMap::ground;
  if (name == "magma") return ColorMap::magma;
  if (name == "gray") return ColorMap::gray;
  throw InputError("no map of colours \"" + name +
                   "\"; there are viridis, magma, diverging, damage, ground and gray");
}

Color map_color(ColorMap map, float share) {
  if (!(share == share)) return {1.0F, 0.0F, 1.0F};
  const std::span<const Color> nodes = nodes_of(map);
  const float place = std::clamp(share, 0.0F, 1.0F) * static_cast<float>(nodes.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), nodes.size() - 2);
  return blend(nodes[below], nodes[below + 1], place - static_cast<float>(below));
}

Color category_color(std::size_t number) {
  return categories[number % categories.size()];
}

}  // namespace breccia
