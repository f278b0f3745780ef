#pragma once
// Which corners and sides of a model a case means.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include "core/keys.hpp"
#include "exec/error.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// Membership of a region, with its names looked up once.
/// @tparam Shape  tells the corners and named sides of a model, and what a region takes besides
///                its box
template <class Shape, class Model, class RegionConfig>
class Region {
  using Vector = typename Shape::Vector;
  using SideCorners = std::array<Index, Shape::dimension>;

 public:
  Region(const Model& model, const RegionConfig& config, const std::string& where)
      : model_(model), config_(config) {
    if (!config.on.empty()) {
      const auto found = std::find(model.groups.begin(), model.groups.end(), config.on);
      if (found == model.groups.end())
        throw InputError(where + ".on = \"" + config.on + "\" is not a body");
      group_ = static_cast<std::int16_t>(found - model.groups.begin());
    }
    const std::string& named = Shape::named_sides(config);
    if (named.empty()) return;
    std::string known;
    for (const auto& set : Shape::side_sets(model)) {
      known += (known.empty() ? "" : ", ") + set.name;
      if (set.name != named) continue;
      named_ = true;
      take(Shape::sides_of_set(set));
    }
    if (!named_)
      throw InputError(where + "." + Shape::side_words + " = \"" + named + "\" is no " +
                       Shape::named_word +
                       " of a mesh; there are: " + (known.empty() ? "none" : known));
  }

  /// Whether a corner of an element lies in it.
  bool takes(std::size_t element, Index vertex) const {
    if (group_ >= 0 && model_.group[element] != group_) return false;
    if (named_ && on_sides_.count(vertex) == 0) return false;
    const Vector& x = model_.point[at(vertex)];
    bool inside = true;
    for (int axis = 0; axis < Shape::dimension; ++axis)
      inside = inside && part_of(x, axis) >= part_of(config_.min, axis) &&
               part_of(x, axis) <= part_of(config_.max, axis);
    return (inside && Shape::is_within(config_, x)) != config_.outside;
  }
  /// Whether a side on the border lies in it. @param corners  ascending
  bool takes_side(std::size_t element, const SideCorners& corners) const {
    if (named_ && sides_.count(corners) == 0) return false;
    return std::all_of(corners.begin(), corners.end(),
                       [&, this](Index vertex) { return takes(element, vertex); });
  }

  /// "; the nearest, at (x, y) m, is 0.001 m away", of boxes, circles and spheres alone.
  std::string nearest_corner() const {
    if (config_.outside || named_ || !Shape::is_plain(config_)) return "";
    double least = no_limit;
    Vector nearest{};
    const auto& corners = Shape::corners_of(model_);
    for (std::size_t t = 0; t < corners.size(); ++t) {
      if (group_ >= 0 && model_.group[t] != group_) continue;
      for (const Index vertex : corners[t]) {
        const double away = distance(model_.point[at(vertex)]);
        if (away >= least) continue;
        least = away;
        nearest = model_.point[at(vertex)];
      }
    }
    if (!(least < no_limit)) return "";
    char text[160], place[80];
    const Vec3 x = to_space(nearest);
    if (Shape::dimension == 2)
      std::snprintf(place, sizeof place, "%.4g, %.4g", x.x, x.y);
    else
      std::snprintf(place, sizeof place, "%.4g, %.4g, %.4g", x.x, x.y, x.z);
    std::snprintf(text, sizeof text, "; the nearest, at (%s) m, is %.3g m away", place, least);
    return text;
  }

 private:
  template <class Sides>
  void take(const Sides& sides) {
    for (SideCorners side : sides) {
      on_sides_.insert(side.begin(), side.end());
      std::sort(side.begin(), side.end());
      sides_.insert(side);
    }
  }
  /// How far a point lies outside.
  double distance(const Vector& x) const {
    Vector beside{};
    for (int axis = 0; axis < Shape::dimension; ++axis)
      part_of(beside, axis) = std::max({part_of(config_.min, axis) - part_of(x, axis),
                                        part_of(x, axis) - part_of(config_.max, axis), 0.0});
    const Vector out = x - config_.center;
    const double away = std::sqrt(dot(beside, beside));
    return config_.radius > 0.0 ? std::max(away, std::sqrt(dot(out, out)) - config_.radius) : away;
  }

  const Model& model_;
  const RegionConfig& config_;
  std::int16_t group_ = -1;
  bool named_ = false;  ///< it takes a named set of sides alone
  std::set<SideCorners> sides_;
  std::set<Index> on_sides_;
};

/// Corners of a model in a region, by where they are at the start.
/// @throws InputError naming `where` if there are none, or a name does not exist
template <class Shape, class Model, class RegionConfig>
std::vector<Index> corners_within(const Model& model, const RegionConfig& config,
                                  const std::string& where) {
  const Region<Shape, Model, RegionConfig> region(model, config, where);
  const auto& of = Shape::corners_of(model);
  std::vector<Index> corners;
  for (std::size_t t = 0; t < of.size(); ++t)
    for (std::size_t k = 0; k < of[t].size(); ++k)
      if (region.takes(t, of[t][k]))
        corners.push_back(Shape::corners * static_cast<Index>(t) + static_cast<Index>(k));
  if (corners.empty())
    throw InputError(where + ": its region holds no corner of any " + Shape::element +
                     region.nearest_corner());
  return corners;
}

}  // namespace breccia::fdem_shared
