#include "prepare/shapes/carve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "dem/setup/model_arrays.hpp"
#include "exec/error.hpp"
#include "prepare/checks/by_name.hpp"
#include "prepare/ldpm/body.hpp"
#include "prepare/packing/linking.hpp"
#include "prepare/packing/stiffness.hpp"

namespace breccia::prepare {
namespace {

using dem::BodyConfig;
using dem::CutConfig;
using dem::Model;

std::string path_in(const std::string& folder, const std::string& file) {
  return (std::filesystem::path(folder) / file).string();
}

/// Cut of a body.
class Cut {
 public:
  Cut(const CutConfig& cut, const std::string& case_folder)
      : center_(cut.center), frame_(frame_of(cut.axis, cut.across)) {
    if (cut.shape == "stl")
      surface_.emplace(read_surface(path_in(case_folder, cut.file), cut.file_unit));
    container_.shape = cut.shape == "sphere"     ? Container::Shape::sphere
                       : cut.shape == "cylinder" ? Container::Shape::cylinder
                                                 : Container::Shape::box;
    container_.size = cut.size;
    container_.radius = cut.radius;
    container_.length = cut.length;
  }
  bool holds(const Vec3& point) const {
    const Vec3 p = frame_.in(point - center_);
    return surface_ ? surface_->holds(p) : container_.depth(p) > 0.0;
  }
  /// Whether some of the segment from a to b lies within.
  bool parts(const Vec3& a, const Vec3& b) const {
    const Vec3 from = frame_.in(a - center_), to = frame_.in(b - center_);
    return surface_ ? surface_->parts(from, to) : passes(from, to);
  }

 private:
  /// Narrows [low, high] to where value + slope t lies within +-half.
  static bool narrow(double value, double slope, double half, double& low, double& high) {
    if (slope == 0.0) return std::abs(value) <= half;
    const double one = (-half - value) / slope, other = (half - value) / slope;
    low = std::max(low, std::min(one, other));
    high = std::min(high, std::max(one, other));
    return low <= high;
  }
  bool passes(const Vec3& from, const Vec3& to) const {
    const Vec3 along = to - from;
    double low = 0.0, high = 1.0;
    if (container_.shape == Container::Shape::box) {
      const Vec3 half = 0.5 * container_.size;
      return narrow(from.x, along.x, half.x, low, high) &&
             narrow(from.y, along.y, half.y, low, high) &&
             narrow(from.z, along.z, half.z, low, high);
    }
    const bool ball = container_.shape == Container::Shape::sphere;
    if (!ball && !narrow(from.z, along.z, 0.5 * container_.length, low, high)) return false;
    const Vec3 flat{along.x, along.y, ball ? along.z : 0.0};
    const Vec3 start{from.x, from.y, ball ? from.z : 0.0};
    const double squared = dot(flat, flat);
    const double nearest = squared > 0.0 ? std::clamp(-dot(start, flat) / squared, low, high) : low;
    return norm(start + nearest * flat) <= container_.radius;
  }

  Vec3 center_;
  Frame3 frame_;
  Container container_;
  std::optional<Surface> surface_;
};

/// Leaves the elements that are kept, and what joins them.
void keep_only(Model& model, const std::vector<bool>& kept) {
  std::vector<Index> number(kept.size(), -1);
  Index next = 0;
  for (std::size_t e = 0; e < kept.size(); ++e)
    if (kept[e]) number[e] = next++;
  const auto gone = [&](Index e) { return e >= 0 && !kept[static_cast<std::size_t>(e)]; };
  std::vector<Index> facet(model.facets.size(), -1);
  std::vector<Model::Facet> facets;
  for (std::size_t f = 0; f < facet.size(); ++f) {
    const Model::Facet& one = model.facets[f];
    if (gone(one.a) || gone(one.b) || gone(one.c) || gone(one.d)) continue;
    facet[f] = static_cast<Index>(facets.size());
    facets.push_back(one);
  }
  model.facets.swap(facets);
  std::erase_if(model.links, [&](const Model::Link& link) {
    return gone(link.a) || gone(link.b) ||
           (link.facet >= 0 && facet[static_cast<std::size_t>(link.facet)] < 0);
  });
  for (Model::Link& link : model.links)
    if (link.facet >= 0) link.facet = facet[static_cast<std::size_t>(link.facet)];
  dem::each_element_array(model, [&](const char*, auto& items) {
    std::size_t to = 0;
    for (std::size_t e = 0; e < kept.size(); ++e)
      if (kept[e]) items[to++] = items[e];
    items.resize(to);
  });
  dem::each_element_number(model, [&](Index& element, int) {
    if (element >= 0) element = number[static_cast<std::size_t>(element)];
  });
}

class Carving {
 public:
  Carving(Model& model, const dem::Config& config, const std::string& case_folder)
      : model_(model), config_(config), folder_(case_folder) {}

  void carve(int number) {
    const BodyConfig& body = config_.bodies[static_cast<std::size_t>(number)];
    if (!is_shaped(body)) return;
    std::optional<Surface> surface;
    if (body.shape == "stl")
      surface.emplace(read_surface(path_in(folder_, body.file), body.file_unit));
    if (surface)
      remove(
          number, body, [&](const Vec3& x) { return !surface->holds(x - body.center); },
          [&](const Vec3& a, const Vec3& b) {
            return surface->parts(a - body.center, b - body.center);
          });
    const MaterialConfig& material = *item_named(config_.materials, body.material);
    if (surface && material.fabric == "even")
      even_out(model_, number, body.center,
               [&](const Vec3& x, double reach) { return surface->distance(x, reach); });
    turn(number, body);
    for (const CutConfig& asked : body.cuts) {
      const Cut cut(asked, folder_);
      remove(
          number, body, [&](const Vec3& x) { return cut.holds(x); },
          [&](const Vec3& a, const Vec3& b) { return cut.parts(a, b); });
    }
  }

 private:
  using MaterialConfig = dem::MaterialConfig;

  bool is_of(Index e, int number) const {
    return model_.group[static_cast<std::size_t>(e)] == number;
  }
  const Vec3& place(Index e) const { return model_.position[static_cast<std::size_t>(e)]; }

  template <class Gone, class Parts>
  void remove(int number, const BodyConfig& body, const Gone& gone, const Parts& parts) {
    drop_links(model_, [&](const Model::Link& link) {
      const bool a = is_of(link.a, number), b = is_of(link.b, number);
      const bool bonds_bar = link.kind == dem::LinkKind::interface && (a || b);
      return ((a && b) || bonds_bar) &&
             (gone(place(link.a)) || gone(place(link.b)) || parts(place(link.a), place(link.b)));
    });
    std::vector<bool> linked(static_cast<std::size_t>(model_.size()));
    for (const Model::Link& link : model_.links)
      if (!link.parted && is_of(link.a, number) && is_of(link.b, number))
        linked[static_cast<std::size_t>(link.a)] = linked[static_cast<std::size_t>(link.b)] = true;
    const bool grains = item_named(config_.materials, body.material)->law == "grain";
    std::vector<bool> kept(static_cast<std::size_t>(model_.size()), true);
    Index left = 0;
    for (Index e = 0; e < model_.size(); ++e) {
      if (!is_of(e, number)) continue;
      const auto at = static_cast<std::size_t>(e);
      kept[at] = !gone(place(e)) && (grains || linked[at]);
      left += kept[at] ? 1 : 0;
    }
    if (left == 0)
      throw InputError(
          fmt::format("body.{}: nothing is left of it: its elements are too large for "
                      "its shape, or all of it is cut out",
                      body.name));
    keep_only(model_, kept);
    if (item_named(config_.materials, body.material)->law == "ldpm") part_grains(number);
  }

  /// Grains on both sides of a cut overlap without a facet now.
  void part_grains(int number) {
    std::vector<Index> own(static_cast<std::size_t>(model_.size()), -1);
    std::vector<Vec3> position;
    std::vector<double> radius;
    for (Index e = 0; e < model_.size(); ++e) {
      if (!is_of(e, number)) continue;
      own[static_cast<std::size_t>(e)] = static_cast<Index>(position.size());
      position.push_back(place(e));
      radius.push_back(model_.radius[static_cast<std::size_t>(e)]);
    }
    std::set<std::pair<Index, Index>> edges;
    for (const Model::Link& link : model_.links)
      if (link.facet >= 0 && is_of(link.a, number))
        edges.insert(std::minmax(own[static_cast<std::size_t>(link.a)],
                                 own[static_cast<std::size_t>(link.b)]));
    part_strangers(position, edges, radius);
    for (Index e = 0; e < model_.size(); ++e)
      if (const Index k = own[static_cast<std::size_t>(e)]; k >= 0)
        model_.radius[static_cast<std::size_t>(e)] = radius[static_cast<std::size_t>(k)];
  }

  /// Turns a body, and bars in it, about its centre; how it moves is as the case says.
  void turn(int number, const BodyConfig& body) {
    const Frame3 frame = frame_of(body.axis, body.across);
    const auto turned = [&](const Vec3& x) { return body.center + frame.out(x - body.center); };
    for (Index e = 0; e < model_.size(); ++e) {
      const auto at = static_cast<std::size_t>(e);
      const BodyConfig& of = config_.bodies[static_cast<std::size_t>(model_.group[at])];
      if (!is_of(e, number) && !(of.shape == "rebar" && of.rebar.in == body.name)) continue;
      model_.position[at] = turned(model_.position[at]);
      model_.velocity[at] = body.velocity + cross(body.spin, model_.position[at] - body.center);
    }
    for (Model::Facet& facet : model_.facets)
      if (is_of(facet.a, number)) facet.center = turned(facet.center);
  }

  Model& model_;
  const dem::Config& config_;
  const std::string& folder_;
};

}  // namespace

Frame3 frame_of(const Vec3& axis, const Vec3& across) {
  const double length = norm(axis);
  const Vec3 z = (1.0 / length) * axis;
  if (norm(across) > 0.0) {
    const Vec3 aside = across - dot(across, z) * z;
    const Vec3 x = (1.0 / norm(aside)) * aside;
    return {x, cross(z, x), z};
  }
  const double aside = z.x * z.x + z.y * z.y;
  if (z.z < 0.0 && aside == 0.0) return {{1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}, z};
  // Rodrigues' formula about the cross product of the old z and the new; 1 - z^2 = x^2 + y^2.
  const double share = z.z < 0.0 ? (1.0 - z.z) / aside : 1.0 / (1.0 + z.z);
  return {{1.0 - share * z.x * z.x, -share * z.x * z.y, -z.x},
          {-share * z.x * z.y, 1.0 - share * z.y * z.y, -z.y},
          z};
}

bool is_shaped(const BodyConfig& body) {
  const bool upright =
      body.axis.x == 0.0 && body.axis.y == 0.0 && body.axis.z > 0.0 && norm(body.across) == 0.0;
  return !upright || body.shape == "stl" || !body.cuts.empty();
}

BodyConfig whole_of(const BodyConfig& body, const std::string& case_folder) {
  BodyConfig whole = body;
  whole.axis = {0.0, 0.0, 1.0};
  whole.across = {};
  whole.cuts.clear();
  if (body.shape != "stl") return whole;
  const Surface surface = read_surface(path_in(case_folder, body.file), body.file_unit);
  whole.shape = "box";
  whole.file.clear();
  whole.size = surface.high() - surface.low();
  whole.center = body.center + 0.5 * (surface.low() + surface.high());
  const double box = whole.size.x * whole.size.y * whole.size.z;
  whole.pack.count =
      static_cast<int>(std::min(std::round(body.pack.count * box / surface.volume()), 2e9));
  return whole;
}

void carve(Model& model, const dem::Config& config, const std::string& case_folder) {
  Carving carving(model, config, case_folder);
  for (std::size_t k = 0; k < config.bodies.size(); ++k) carving.carve(static_cast<int>(k));
}

}  // namespace breccia::prepare
