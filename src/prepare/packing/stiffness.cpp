#include "prepare/packing/stiffness.hpp"

#include <algorithm>
#include <cmath>

#include "dem/setup/materials.hpp"
#include "math/constants.hpp"
#include "prepare/checks/by_name.hpp"
#include "prepare/packing/elastic_network.hpp"
#include "prepare/packing/fracture_energy.hpp"
#include "prepare/packing/rebar.hpp"

namespace breccia::prepare {
namespace {

using dem::BodyConfig;
using dem::Config;
using dem::MaterialConfig;
using dem::Model;

const MaterialConfig& material_of(const Config& config, const BodyConfig& body) {
  return *item_named(config.materials, body.material);
}

std::vector<Index> members_of(const Model& m, int body) {
  std::vector<Index> members;
  for (Index e = 0; e < m.size(); ++e)
    if (m.group[static_cast<std::size_t>(e)] == body) members.push_back(e);
  return members;
}

/// Volume of the concrete of a body, without its bars.  [m3]
double bulk_of(const Config& config, const BodyConfig& body) {
  if (body.shape == "file") return body.bulk_volume();
  double volume = container_of(body).volume();
  for (const BodyConfig& other : config.bodies)
    if (other.shape == "rebar" && other.rebar.in == body.name)
      volume -= bars_volume(chains_through(other.rebar, body.size));
  return volume;
}

/// The concrete links of a body and the fabric of its elements, L_a = sum of S D / (6 V_a).
class Fabric {
 public:
  /// @param bulk  volume of the body  [m3]
  Fabric(Model& m, int body, const Vec3& center, double bulk, DepthsOf depths)
      : model_(m), center_(center), depths_(std::move(depths)), members_(members_of(m, body)) {
    double cubes = 0.0;
    for (const Index e : members_) {
      const double r = m.radius[static_cast<std::size_t>(e)];
      cubes += r * r * r;
      mean_ += r / static_cast<double>(members_.size());
    }
    per_cube_ = bulk / cubes;
    for (Model::Link& link : m.links)
      if (link.kind == dem::LinkKind::concrete && m.group[static_cast<std::size_t>(link.a)] == body)
        links_.push_back(&link);
    add_up();
  }

  /// Sections for which elements at faces have as much fabric as those deep in the body.
  void even_out() { even_out(std::vector<double>(model_.position.size(), 1.0)); }

  /// Strengths, over those of the sections that links have, for which elements at faces have as
  /// much as these need. In classes, since each is a group of links with a law of its own.
  void weaken_faces() {
    std::vector<double> section, needed(model_.position.size(), 1.0);
    for (const Model::Link* link : links_) section.push_back(link->share);
    for (const Index e : members_) needed[static_cast<std::size_t>(e)] = needed_at(e);
    for (Model::Link* link : links_) link->share = 1.0;
    add_up();
    even_out(needed);
    for (std::size_t k = 0; k < links_.size(); ++k) {
      const double strength = links_[k]->share / section[k];
      links_[k]->strength = std::max(1.0, std::round(classes * strength)) / classes;
      links_[k]->share = section[k];
    }
  }

 private:
  static constexpr double classes = 16.0;
  static constexpr double skin = 3.5;  ///< depth of what faces disturb, over the mean radius  [-]
  static constexpr double most = 3.0;  ///< largest share, and the least one's inverse  [-]
  static constexpr int passes = 8;
  static constexpr std::size_t least_deep = 20;  ///< elements that a mean needs

  /// @param aims  fabric of each element over that of those deep in the body  [-]
  void even_out(const std::vector<double>& aims) {
    const double deep = deep_mean();
    std::vector<Model::Link*> near;
    for (Model::Link* link : links_) {
      const Vec3 middle = 0.5 * (place(link->a) + place(link->b));
      if (depth(middle, skin * mean_) < skin * mean_) near.push_back(link);
    }
    for (int pass = 0; pass < passes; ++pass) {
      for (Model::Link* link : near) {
        const double aim = deep * std::sqrt(aims[static_cast<std::size_t>(link->a)] *
                                            aims[static_cast<std::size_t>(link->b)]);
        link->share = std::clamp(link->share * aim / std::sqrt(fabric(link->a) * fabric(link->b)),
                                 1.0 / most, most);
      }
      add_up();
    }
  }

  /// Fabric that an element needs over that of one deep in the body: less for the part of its space
  /// between the centres of the outermost elements and a face, across which nothing pulls.  [-]
  double needed_at(Index e) const {
    const double r = model_.radius[static_cast<std::size_t>(e)];
    double sum = 0.0;
    for (const double below : depths_(place(e), skin * mean_))
      sum += 1.0 - std::clamp((mean_ - below + r) / (2.0 * r), 0.0, 1.0);
    return sum / 3.0;
  }

  double depth(const Vec3& point, double reach) const {
    const auto [x, y, z] = depths_(point, reach);
    return std::min({x, y, z});
  }
  Vec3 place(Index e) const { return model_.position[static_cast<std::size_t>(e)] - center_; }
  double& fabric(Index e) { return fabric_[static_cast<std::size_t>(e)]; }

  void add_up() {
    fabric_.assign(model_.position.size(), 0.0);
    for (const Model::Link* link : links_) {
      const double part =
          dem::link_section(model_, *link) * norm(place(link->b) - place(link->a)) / 6.0;
      fabric(link->a) += part;
      fabric(link->b) += part;
    }
    for (const Index e : members_) {
      const double r = model_.radius[static_cast<std::size_t>(e)];
      fabric(e) /= per_cube_ * r * r * r;
    }
  }

  /// Of the elements that faces do not disturb; of the deepest ones where there are too few.
  double deep_mean() {
    std::vector<std::pair<double, Index>> by_depth;
    for (const Index e : members_) by_depth.emplace_back(depth(place(e), no_limit), e);
    std::sort(by_depth.rbegin(), by_depth.rend());
    double sum = 0.0;
    std::size_t count = 0;
    for (const auto& [deep, e] : by_depth) {
      if (deep < skin * mean_ && count >= least_deep) break;
      sum += fabric(e);
      ++count;
    }
    return sum / static_cast<double>(count);
  }

  Model& model_;
  Vec3 center_;
  DepthsOf depths_;
  std::vector<Index> members_;
  std::vector<Model::Link*> links_;
  double mean_ = 0.0;           ///< radius  [m]
  double per_cube_ = 0.0;       ///< volume of an element over the cube of its radius  [-]
  std::vector<double> fabric_;  ///< of each element  [-]
};

/// Bodies of so many elements are measured even if nothing depends on it: a second or two.
constexpr std::size_t always_measured = 20'000;

/// E over that of links that all follow one strain, without moments: 0.97 to 1.10 in prisms of
/// compactness 0.5 to 0.62, range 1.2 to 1.6, size ratio 1 to 4.
constexpr double moments = 1.05;

/// Bounds of what a packing can be asked for.
constexpr double densest = 0.62, most_apart = 10.0;

/// visit(link, its length at the start) for the concrete links of a body.
template <class Visit>
void each_link(const Model& model, int body, Visit&& visit) {
  for (const Model::Link& link : model.links)
    if (link.kind == dem::LinkKind::concrete &&
        model.group[static_cast<std::size_t>(link.a)] == body)
      visit(link, norm(model.position[static_cast<std::size_t>(link.b)] -
                       model.position[static_cast<std::size_t>(link.a)]));
}

/// u_2 of a body's links from its G_F.
double opening_for_energy(const Model& model, const Config& config, int number) {
  const BodyConfig& body = config.bodies[static_cast<std::size_t>(number)];
  double longest = 0.0, mean = 0.0, solid = 0.0, least = no_limit, largest = 0.0;
  each_link(model, number,
            [&](const Model::Link&, double length) { longest = std::max(longest, length); });
  const std::vector<Index> members = members_of(model, number);
  for (const Index e : members) {
    const double r = model.radius[static_cast<std::size_t>(e)];
    mean += r / static_cast<double>(members.size());
    solid += 4.0 / 3.0 * pi * r * r * r;
    least = std::min(least, r), largest = std::max(largest, r);
  }
  const double compactness = std::min(solid / bulk_of(config, body), densest);
  return rupture_opening(
      material_of(config, body), config.contact,
      {mean, std::min(largest / least, most_apart), compactness, model.interaction_range}, longest,
      body.name);
}

bool has_section(const BodyConfig& body) {
  return body.shape == "cylinder" || ((body.shape == "box" || body.shape == "file") &&
                                      body.size.x * body.size.y * body.size.z > 0.0);
}

}  // namespace

Elasticity measured_elasticity(const Model& model, const Config& config, int number, int threads) {
  const BodyConfig& body = config.bodies[static_cast<std::size_t>(number)];
  const bool round = body.shape == "cylinder";
  const Vec3 size = round ? Vec3{2.0 * body.radius, 2.0 * body.radius, body.length} : body.size;
  const int axis = round ? 2 : size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const double length = component(size, axis);
  const double section = round ? pi * body.radius * body.radius : size.x * size.y * size.z / length;
  const ElasticNetwork network(model, config, members_of(model, number), threads);
  const auto& members = network.members();
  const auto along = static_cast<std::size_t>(axis);
  const auto place = [&](std::size_t k) {
    return model.position[static_cast<std::size_t>(members[k])] - body.center;
  };
  ElasticNetwork::Held held(members.size());
  const double layer = 0.5 * length - 1.5 * network.mean_radius();
  std::vector<std::size_t> middle;
  const double nu = material_of(config, body).poisson;
  for (std::size_t k = 0; k < members.size(); ++k) {
    const Vec3 x = place(k);
    const double at = component(x, axis);
    held.value[k] = {-nu * x.x, -nu * x.y, -nu * x.z, 0.0, 0.0, 0.0};
    held.value[k][along] = at;  // a strain of 1
    held.fixed[k][along] = std::fabs(at) > layer;
    if (std::fabs(at) < 0.25 * length) middle.push_back(k);
  }
  const Displacements u = network.relaxed(held, {}, 1e-5);
  const Displacements force = network.forces(u);
  double pull = 0.0;
  for (std::size_t k = 0; k < members.size(); ++k)
    if (held.fixed[k][along])
      pull += std::copysign(0.5, component(place(k), axis)) * force[k][along];
  // Strains of the middle half: slopes of the displacements.
  double strain[3] = {0.0, 0.0, 0.0};
  for (int c = 0; c < 3; ++c) {
    double x = 0.0, v = 0.0, xx = 0.0, xv = 0.0;
    for (const std::size_t k : middle) {
      const double p = component(place(k), c), q = u[k][static_cast<std::size_t>(c)];
      x += p, v += q, xx += p * p, xv += p * q;
    }
    const auto n = static_cast<double>(middle.size());
    strain[c] = (xv - x * v / n) / (xx - x * x / n);
  }
  const double across = strain[0] + strain[1] + strain[2] - strain[axis];
  return {pull / (section * strain[axis]), -0.5 * across / strain[axis]};
}

Elasticity estimated_elasticity(const Model& model, const Config& config, int number) {
  const BodyConfig& body = config.bodies[static_cast<std::size_t>(number)];
  const MaterialConfig& material = material_of(config, body);
  double sum = 0.0;
  each_link(model, number, [&](const Model::Link& link, double length) {
    sum += dem::link_stiffness(model, link, material) * length * length;
  });
  const double x = dem::local_elasticity(material).ratio;
  const double voigt = sum / (3.0 * bulk_of(config, body)) * (2.0 + 3.0 * x) / (4.0 + x);
  return {moments * voigt, (1.0 - x) / (4.0 + x)};
}

void even_out(Model& model, int number, const Vec3& center, const std::string& fabric,
              const DepthsOf& depths) {
  for (Model::Link& link : model.links)
    if (link.kind == dem::LinkKind::concrete &&
        model.group[static_cast<std::size_t>(link.a)] == number)
      link.share = link.strength = 1.0;
  constexpr double any_bulk = 1.0;  // its scale leaves the ratios of fabrics alone
  Fabric links(model, number, center, any_bulk, depths);
  links.even_out();
  if (fabric == "faces") links.weaken_faces();
}

void set_stiffness(Model& model, const Config& config, int threads) {
  model.bulk.resize(config.bodies.size());
  for (std::size_t k = 0; k < config.bodies.size(); ++k) {
    const BodyConfig& body = config.bodies[k];
    const MaterialConfig& material = material_of(config, body);
    if (body.shape == "rebar" || body.shape == "element" || material.law != "concrete") continue;
    const auto number = static_cast<int>(k);
    const bool corrected = material.stiffness == "measured";
    const bool even = material.fabric != "packed";
    const bool wanted =
        corrected || (has_section(body) && members_of(model, number).size() <= always_measured);
    const auto elasticity = [&] {
      return !wanted             ? Elasticity{}
             : has_section(body) ? measured_elasticity(model, config, number, threads)
                                 : estimated_elasticity(model, config, number);
    };
    const Elasticity packed = elasticity();
    if (even) {
      Fabric links(model, number, body.center, bulk_of(config, body),
                   [&](const Vec3& x, double) { return container_of(body).depths(x); });
      links.even_out();
      if (material.fabric == "faces") links.weaken_faces();
    }
    const Elasticity now = even ? elasticity() : packed;
    Model::Bulk& bulk = model.bulk[k];
    if (corrected) bulk.factor = material.young / now.young;
    bulk.young = bulk.factor * now.young;
    bulk.poisson = now.poisson;
    bulk.packed_young = packed.young;
    bulk.packed_poisson = packed.poisson;
    if (material.fracture_energy > 0.0)
      bulk.rupture_opening = opening_for_energy(model, config, number);
  }
}

}  // namespace breccia::prepare
