#include "prepare/rebar.hpp"

#include <fmt/format.h>

#include "math/constants.hpp"

namespace breccia::prepare {
namespace {

double along(double share, double edge) {
  return (share - 0.5) * edge;
}

/// The two directions of one mat; `face` is -1 at the bottom, +1 at the top.
void add_mat(std::vector<Bar>& bars, const dem::RebarConfig& rebar, const Vec3& size, double face) {
  const double r = 0.5 * rebar.diameter;
  const double outer = face * (0.5 * size.z - rebar.cover);
  const double inner = outer - face * rebar.diameter;
  const double end_x = 0.5 * size.x - r, end_y = 0.5 * size.y - r;
  for (int k = 0; k < rebar.bars; ++k) {
    const double y = along((k + 0.5) / rebar.bars, size.y);
    bars.push_back({{-end_x, y, outer}, {end_x, y, outer}, r});
  }
  for (int k = 0; k < rebar.bars; ++k) {
    const double x = along((k + 0.5) / rebar.bars, size.x);
    bars.push_back({{x, -end_y, inner}, {x, end_y, inner}, r});
  }
}

}  // namespace

std::vector<Bar> bars_through(const dem::RebarConfig& rebar, const Vec3& size) {
  std::vector<Bar> bars;
  add_mat(bars, rebar, size, -1.0);
  if (rebar.layers == 2) add_mat(bars, rebar, size, 1.0);
  return bars;
}

std::vector<std::string> bar_problems(const dem::RebarConfig& rebar, const Vec3& size) {
  std::vector<std::string> problems;
  const double d = rebar.diameter;
  const double shorter = std::min(size.x, size.y);
  if (rebar.cover < 0.5 * d)
    problems.push_back(fmt::format("cover {:.4g} m puts bars of diameter {:.4g} m outside the body",
                                   rebar.cover, d));
  const double depth = rebar.layers * (rebar.cover + 1.5 * d);  // a mat is two diameters thick
  if (depth > size.z)
    problems.push_back(
        fmt::format("{} layers of bars need {:.4g} m of depth; the body has {:.4g} m", rebar.layers,
                    depth, size.z));
  if (rebar.bars * d > shorter)
    problems.push_back(
        fmt::format("{} bars of diameter {:.4g} m do not fit beside each other", rebar.bars, d));
  if ((shorter - d) / (rebar.elements - 1) < d)
    problems.push_back(fmt::format("{} elements along a bar of length {:.4g} m overlap; at most {}",
                                   rebar.elements, shorter - d, static_cast<int>(shorter / d)));
  return problems;
}

double BarElements::mass(double density, int element, int count) const {
  const double whole = density * area * spacing;
  return element == 0 || element == count - 1 ? 0.5 * whole : whole;
}

double BarElements::inertia(double element_mass) const {
  return element_mass * (spacing * spacing / 12.0 + diameter * diameter / 16.0);
}

BarElements bar_elements(const dem::RebarConfig& rebar, const Bar& bar) {
  return {.spacing = norm(bar.b - bar.a) / (rebar.elements - 1),
          .area = pi * rebar.diameter * rebar.diameter / 4.0,
          .diameter = rebar.diameter};
}

Vec3 bar_element_centre(const Bar& bar, int element, int count) {
  return bar.a + (static_cast<double>(element) / (count - 1)) * (bar.b - bar.a);
}

double bars_volume(const dem::RebarConfig& rebar, const std::vector<Bar>& bars) {
  double volume = 0.0;
  for (const Bar& bar : bars) volume += bar_elements(rebar, bar).area * norm(bar.b - bar.a);
  return volume;
}

}  // namespace breccia::prepare
