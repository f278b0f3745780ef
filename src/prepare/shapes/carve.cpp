#include "prepare/shapes/carve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
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
  Cut(const CutConfig& cut, const std::string& case_folder) : solid_(solid_of(cut)) {
    if (cut.shape == "stl")
      surface_.emplace(read_surface(path_in(case_folder, cut.file), cut.file_unit));
  }
  bool holds(const Vec3& point) const {
    return surface_ ? surface_->holds(inside(point)) : solid_.depth(point) > 0.0;
  }
  /// Whether some of the segment from a to b lies within.
  bool parts(const Vec3& a, const Vec3& b) const {
    if (surface_) return surface_->parts(inside(a), inside(b));
    const Solid::Span span = solid_.span(a, b);
    return span.low <= span.high;
  }

 private:
  Vec3 inside(const Vec3& point) const { return solid_.frame.in(point - solid_.center); }

  Solid solid_;
  std::optional<Surface> surface_;
};

/// The surface of a body, for places of its upright whole. Particles of LDPM lie on faces of the
/// box around it: within, as seen here.
class Shell {
 public:
  Shell(const BodyConfig& body, const dem::MaterialConfig& material, const std::string& case_folder)
      : surface_(read_surface(path_in(case_folder, body.file), body.file_unit)),
        center_(body.center),
        middle_(0.5 * (surface_.low() + surface_.high())),
        inwards_(material.law == "ldpm" ? 1e-9 : 0.0) {}

  const Surface& surface() const { return surface_; }
  bool holds(const Vec3& x) const { return surface_.holds(within(x)); }
  bool parts(const Vec3& a, const Vec3& b) const { return surface_.parts(within(a), within(b)); }

 private:
  Vec3 within(const Vec3& x) const {
    const Vec3 own = x - center_;
    return own - inwards_ * (own - middle_);
  }

  Surface surface_;
  Vec3 center_, middle_;
  double inwards_;
};

/// Leaves the elements that are kept, and what joins them.
void keep_only(Model& model, const std::vector<bool>& kept) {
  std::vector<Index> number(kept.size(), -1);
  Index next = 0;
  for (std::size_t e = 0; e < kept.size(); ++e)
    if (kept[e]) number[e] = next++;
  const auto gone = [&](Index e) { return e >= 0 && !kept[static_cast<std::size_t>(e)]; };
  std::vector<Index> facet(model.facets.size(), -1);
  PlainVector<Model::Facet> facets;
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
    const MaterialConfig& material = *item_named(config_.materials, body.material);
    std::optional<Shell> shell;
    if (body.shape == "stl") shell.emplace(body, material, folder_);
    if (shell)
      remove(
          number, body, [&](const Vec3& x) { return !shell->holds(x); },
          [&](const Vec3& a, const Vec3& b) { return shell->parts(a, b); });
    if (shell && material.fabric != "packed")
      even_out(model_, number, body.center, material.fabric, [&](const Vec3& x, double reach) {
        return std::array{shell->surface().distance(x, reach), no_limit, no_limit};
      });
    if (body.joins.empty())
      turn(number, body);
    else
      unite(number, body, material.fabric);
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
  bool is_bar_in(Index e, const BodyConfig& body) const {
    const auto group = static_cast<std::size_t>(model_.group[static_cast<std::size_t>(e)]);
    const BodyConfig& of = config_.bodies[group];
    return of.shape == "rebar" && of.rebar.in == body.name;
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

  /// Leaves what lies in the solids of a body with joins; the box around them stands upright.
  void unite(int number, const BodyConfig& body, const std::string& fabric) {
    const Union whole(body);
    remove(
        number, body, [&](const Vec3& x) { return !(whole.depth(x) > 0.0); },
        [&](const Vec3& a, const Vec3& b) { return whole.parts(a, b); });
    if (fabric != "packed")
      even_out(model_, number, {}, fabric, [&](const Vec3& x, double) {
        return std::array{whole.depth(x), no_limit, no_limit};
      });
    for (Index e = 0; e < model_.size(); ++e)
      if (is_of(e, number) || is_bar_in(e, body))
        model_.velocity[static_cast<std::size_t>(e)] =
            body.velocity + cross(body.spin, place(e) - body.center);
  }

  /// Turns a body, and bars in it, about its centre; how it moves is as the case says.
  void turn(int number, const BodyConfig& body) {
    const Frame3 frame = frame_of(body.axis, body.across);
    const auto turned = [&](const Vec3& x) { return body.center + frame.out(x - body.center); };
    for (Index e = 0; e < model_.size(); ++e) {
      const auto at = static_cast<std::size_t>(e);
      if (!is_of(e, number) && !is_bar_in(e, body)) continue;
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

bool is_shaped(const BodyConfig& body) {
  const bool upright =
      body.axis.x == 0.0 && body.axis.y == 0.0 && body.axis.z > 0.0 && norm(body.across) == 0.0;
  return !upright || body.shape == "stl" || !body.cuts.empty() || !body.joins.empty();
}

BodyConfig whole_of(const BodyConfig& body, const std::string& case_folder) {
  BodyConfig whole = body;
  whole.axis = {0.0, 0.0, 1.0};
  whole.across = {};
  whole.cuts.clear();
  whole.joins.clear();
  if (!body.joins.empty()) {
    const Union all(body);
    whole.shape = "box";
    whole.size = all.high() - all.low();
    whole.center = 0.5 * (all.low() + all.high());
    const double box = whole.size.x * whole.size.y * whole.size.z;
    whole.pack.count =
        static_cast<int>(std::min(std::round(body.pack.count * box / all.volume()), 2e9));
    return whole;
  }
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

dem::Config with_whole_bodies(const dem::Config& config, const std::string& case_folder) {
  dem::Config whole = config;
  for (BodyConfig& body : whole.bodies) body = whole_of(body, case_folder);
  for (BodyConfig& bars : whole.bodies) {
    if (bars.shape != "rebar") continue;
    const BodyConfig& host = *item_named(config.bodies, bars.rebar.in);
    const Vec3 moved = host.center - item_named(whole.bodies, host.name)->center;
    if (host.shape != "stl" && host.joins.empty()) continue;
    // The box around joined solids stands upright in the case; a surface is turned later.
    const Frame3 frame = host.joins.empty() ? Frame3{} : frame_of(host.axis, host.across);
    for (dem::BarConfig& bar : bars.rebar.drawn) {
      for (Vec3& point : bar.points) point = moved + frame.out(point);
      bar.step = frame.out(bar.step);
    }
  }
  return whole;
}

std::function<bool(const Vec3&)> shape_within(const BodyConfig& body,
                                              const dem::MaterialConfig& material,
                                              const std::string& case_folder) {
  if (body.shape == "stl")
    return [shell = std::make_shared<Shell>(body, material, case_folder)](const Vec3& x) {
      return shell->holds(x);
    };
  if (!body.joins.empty())
    return [whole = Union(body)](const Vec3& x) { return whole.depth(x) > 0.0; };
  return {};
}

void carve(Model& model, const dem::Config& config, const std::string& case_folder) {
  Carving carving(model, config, case_folder);
  for (std::size_t k = 0; k < config.bodies.size(); ++k) carving.carve(static_cast<int>(k));
}

}  // namespace breccia::prepare
