#include "prepare/checks/check_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "fdem_shared/shape.hpp"
#include "io/round_numbers.hpp"
#include "math/constants.hpp"
#include "prepare/checks/in_situ.hpp"
#include "prepare/checks/outlines.hpp"
#include "prepare/packing/body_packing.hpp"
#include "prepare/shapes/carve.hpp"

namespace breccia::prepare {
namespace {

/// Aerated concrete has 300 kg/m3, steel 7850, the densest metal 22,600.
void look_at_density(const std::string& material, double density,
                     std::vector<std::string>& doubts) {
  constexpr double lightest = 100.0, heaviest = 25e3, least_of_rock = 0.5, most_of_rock = 30.0;
  const std::string key = "material." + material + ".density";
  const auto add = [&](const char* than, double meant, const std::string& as_written) {
    const bool likely = meant >= least_of_rock && meant <= most_of_rock;
    doubts.push_back(fmt::format(
        "{} = {:g} kg/m3 is {}; {}", key, density, than,
        likely ? fmt::format("did you mean \"{}\"? Rock and concrete have 2 to 3 g/cm3", as_written)
               : "kg/m3, g/cm3 and t/m3 are allowed, and numbers without a unit are kg/m3"));
  };
  if (density < lightest)
    add("lighter than any rock or concrete", density, fmt::format("{:g} g/cm3", density));
  if (density > heaviest)
    add("heavier than any metal", 1e-6 * density, fmt::format("{:g} kg/m3", 1e-3 * density));
}

/// A joint that slides without pressure before its tension is reached.
void look_at_apex(const std::string& key, const fdem::StrengthConfig& s,
                  std::vector<std::string>& doubts) {
  const double slope = std::tan(s.friction_angle);
  if (!(s.tension * slope > s.cohesion)) return;
  doubts.push_back(fmt::format(
      "{}.tension = {} is never reached: the joint slides from cohesion / tan(friction_angle) = {} "
      "on, the apex of its strength; tension is at most that",
      key, stress_text(s.tension), stress_text(s.cohesion / slope)));
}

/// The shortest length across a body that a mesh must fill, of a plate in space the middle one: it
/// may be a slice of one element; 0: only a file tells.  [m]
double least_side(const fdem::BodyConfig& b) {
  if (b.shape == "plate" || b.shape == "beam") return std::min(b.size.x, b.size.y);
  if (b.shape == "disc") return 2.0 * b.radius;
  if (b.shape == "ring") return b.radius - b.inner_radius;
  return 0.0;
}
double least_side(const fdem3::BodyConfig& b) {
  if (b.shape == "box") {
    std::array sides{b.size.x, b.size.y, b.size.z};
    std::sort(sides.begin(), sides.end());
    return b.mesh_size < 0.2 * sides[1] ? sides[1] : sides[0];
  }
  if (b.shape == "cylinder")
    return b.mesh_size < 0.4 * b.radius ? 2.0 * b.radius : std::min(2.0 * b.radius, b.height);
  if (b.shape == "sphere") return 2.0 * b.radius;
  return 0.0;
}

template <class Body>
void look_at_mesh(const Body& b, std::vector<std::string>& doubts) {
  const double side = least_side(b);
  if (!(side > 0.0) || !(b.mesh_size > 1.001 * side)) return;
  doubts.push_back(
      fmt::format("body.{0}.mesh_size = {1} is longer than the shortest side of {0}, {2}: one "
                  "element across it "
                  "shows neither bending nor cracks; a fifth of the side, {3}, or less is usual",
                  b.name, length_text(b.mesh_size), length_text(side), length_text(0.2 * side)));
}

/// Size of the elements of a body; 0: not known before it is built.  [m]
double element_size(const fdem::BodyConfig& b, const fdem::Config&) {
  return b.mesh_size;
}
double element_size(const fdem3::BodyConfig& b, const fdem3::Config&) {
  return b.mesh_size;
}
double element_size(const dem::BodyConfig& b, const dem::Config&) {
  if ((b.shape != "box" && b.shape != "sphere" && b.shape != "cylinder") || b.pack.count < 1 ||
      is_shaped(b))
    return 0.0;
  const double volume = compactness_of(b.pack) * container_of(b).volume();
  return std::cbrt(6.0 / pi * volume / b.pack.count);
}

/// Places and sizes that a case names besides its bodies.
struct Placed {
  std::string key;
  std::vector<std::pair<std::size_t, double>> places;  ///< axis and coordinate  [m]
  std::vector<double> sizes;                           ///<  [m]
};

Placed item_of(const std::string& key, const Bounds& bounds, std::size_t axes) {
  Placed item{key, {}, {}};
  for (std::size_t k = 0; k < axes; ++k)
    for (const double x : {bounds.low[k], bounds.high[k]})
      if (std::abs(x) < no_limit) item.places.emplace_back(k, x);
  return item;
}
template <class Vector>
void add_place(Placed& item, const Vector& at) {
  const Vec3 x = fdem_shared::to_space(at);
  const std::array all{x.x, x.y, x.z};
  for (std::size_t k = 0; k < (std::is_same_v<Vector, Vec2> ? 2U : 3U); ++k)
    item.places.emplace_back(k, all[k]);
}

std::vector<Placed> items_of(const dem::Config& config) {
  std::vector<Placed> items;
  for (const auto& s : config.supports)
    items.push_back(item_of("support." + s.name, region_bounds(s), 3));
  for (const auto& w : config.walls) {
    if (w.shape == "stl") continue;
    Placed& item = items.emplace_back(Placed{"wall." + w.name, {}, {}});
    add_place(item, w.point);
    for (const double size : {w.radius, w.length, w.size.x, w.size.y})
      if (size > 0.0) item.sizes.push_back(size);
  }
  return items;
}
template <class Config>
std::vector<Placed> items_of(const Config& config) {
  constexpr std::size_t axes = std::is_same_v<Config, fdem::Config> ? 2 : 3;
  std::vector<Placed> items;
  for (const auto& s : config.supports)
    items.push_back(item_of("support." + s.name, region_bounds(s.region), axes));
  for (const auto& load : config.loads)
    items.push_back(item_of("load." + load.name, region_bounds(load.region), axes));
  for (const auto& bolt : config.bolts) {
    Placed& item = items.emplace_back(Placed{"bolt." + bolt.name, {}, {}});
    for (const auto& point : bolt.points) add_place(item, point);
    if (bolt.is_ring()) add_place(item, bolt.center), item.sizes.push_back(bolt.radius);
  }
  return items;
}

double length_of(const Bounds& b) {
  double length = 0.0;
  for (std::size_t k = 0; k < 3; ++k) length = std::max(length, b.high[k] - b.low[k]);
  return length;
}

/// Lengths of which one is in metres and the others in millimetres, or the other way round.
template <class Config>
class Lengths {
 public:
  Lengths(const Config& config, const std::string& folder)
      : config_(config), outlines_(outlines_of(config, &folder)) {
    for (std::size_t i = 0; i < outlines_.size(); ++i) {
      const auto& b = config.bodies[i];
      Outline& o = outlines_[i];
      if constexpr (std::is_same_v<Config, dem::Config>) {
        o.in_another |= b.shape == "rebar";
        if (b.shape == "element" && o.bounds)
          for (std::size_t k = 0; k < 3; ++k) {
            o.bounds->low[k] -= b.radius;
            o.bounds->high[k] += b.radius;
          }
      }
    }
  }

  void look(std::vector<std::string>& doubts) const {
    for (std::size_t i = 0; i < outlines_.size(); ++i) {
      const Outline& o = outlines_[i];
      if (o.in_another || !o.bounds) continue;
      look_at_items(i, doubts);
      for (std::size_t j = 0; j < outlines_.size(); ++j)
        if (j != i && !outlines_[j].in_another && outlines_[j].bounds) look_at_pair(i, j, doubts);
      look_at_distance(i, doubts);
    }
  }

 private:
  double element(std::size_t i) const { return element_size(config_.bodies[i], config_); }
  std::string key_of(std::size_t i) const {
    const auto& b = config_.bodies[i];
    const bool round = b.shape == "disc" || b.shape == "ring" || b.shape == "sphere" ||
                       b.shape == "cylinder" || b.shape == "element";
    return "body." + b.name + (round ? ".radius" : ".size");
  }

  /// All that supports, walls and loads name lies within half an element around the origin, in a
  /// body of a hundred times that: it does not reach the body's faces.
  void look_at_items(std::size_t i, std::vector<std::string>& doubts) const {
    const Bounds& b = *outlines_[i].bounds;
    const double length = length_of(b), edge = element(i);
    if (!(edge > 0.0)) return;
    const double within = std::min(0.01 * length, 0.5 * edge);
    std::set<std::string> telling;
    double reach = 0.0;
    for (const Placed& item : items_of(config_)) {
      for (const auto& [axis, x] : item.places) {
        const double from_face = std::min(std::abs(x - b.low[axis]), std::abs(x - b.high[axis]));
        if (from_face <= within) continue;
        reach = std::max(reach, std::abs(x));
        if (x != 0.0) telling.insert(item.key);
      }
      for (const double size : item.sizes) reach = std::max(reach, size);
    }
    if (telling.size() < 2 || !(reach <= within)) return;
    doubts.push_back(fmt::format(
        "{}: {} is {} long, and all that {} and {} name lies within {}, less than one of its "
        "elements: are both in the right unit? Numbers without one are metres",
        key_of(i), outlines_[i].name, length_text(length), *telling.begin(), *telling.rbegin(),
        length_text(reach)));
  }

  /// A body that is far smaller than one element of another.
  void look_at_pair(std::size_t large, std::size_t small, std::vector<std::string>& doubts) const {
    const double edge = element(large), length = length_of(*outlines_[small].bounds);
    if (!(length > 0.0) || !(length < 0.05 * edge)) return;
    doubts.push_back(
        fmt::format("{}: {} is {} long, and one element of {} is {}: are both in the right unit? "
                    "Numbers without one are metres",
                    key_of(small), outlines_[small].name, length_text(length),
                    outlines_[large].name, length_text(edge)));
  }

  struct Neighbour {
    std::size_t number = 0;
    double away = no_limit;  ///<  [m]; no_limit: none, or a body whose outline is not known
  };
  Neighbour nearest_to(std::size_t i) const {
    const Bounds& own = *outlines_[i].bounds;
    Neighbour nearest;
    for (std::size_t j = 0; j < outlines_.size(); ++j) {
      const Outline& o = outlines_[j];
      if (j == i || o.in_another) continue;
      if (!o.bounds) return {};
      double away = 0.0;
      for (std::size_t k = 0; k < 3; ++k)
        away = std::max({away, own.low[k] - o.bounds->high[k], o.bounds->low[k] - own.high[k]});
      if (away < nearest.away) nearest = {j, away};
    }
    return nearest;
  }

  /// A body that lies a hundred times its length from all others; of two such the second is told.
  void look_at_distance(std::size_t i, std::vector<std::string>& doubts) const {
    const auto [j, away] = nearest_to(i);
    if (!(away < no_limit) || (j > i && nearest_to(j).number == i)) return;
    const double longer =
        std::max(length_of(*outlines_[i].bounds), length_of(*outlines_[j].bounds));
    if (!(longer > 0.0) || !(away > 100.0 * longer)) return;
    doubts.push_back(
        fmt::format("body.{}.center: it lies {} from {}, which is nearest, and neither is longer "
                    "than {}: are all in the right unit? Numbers without one are metres",
                    outlines_[i].name, length_text(away), outlines_[j].name, length_text(longer)));
  }

  const Config& config_;
  std::vector<Outline> outlines_;
};

template <class Config>
std::vector<std::string> of_meshes(const Config& config, const std::string& folder) {
  std::vector<std::string> doubts;
  for (const auto& m : config.materials) {
    look_at_density(m.name, m.density, doubts);
    if (m.joints != "none") look_at_apex("material." + m.name + ".joint", m.joint, doubts);
  }
  for (const auto& joint : config.joint_laws)
    look_at_apex("joint." + joint.name + ".strength", joint.strength, doubts);
  for (const auto& body : config.bodies) look_at_mesh(body, doubts);
  Lengths<Config>(config, folder).look(doubts);
  return doubts;
}

}  // namespace

std::vector<std::string> doubtful_values(const dem::Config& config, const std::string& folder) {
  std::vector<std::string> doubts;
  for (const dem::MaterialConfig& m : config.materials)
    if (m.law != "grain" && m.law != "interface") look_at_density(m.name, m.density, doubts);
  Lengths<dem::Config>(config, folder).look(doubts);
  return doubts;
}
std::vector<std::string> doubtful_values(const fdem::Config& config, const std::string& folder) {
  return of_meshes(config, folder);
}
std::vector<std::string> doubtful_values(const fdem3::Config& config, const std::string& folder) {
  return of_meshes(config, folder);
}

}  // namespace breccia::prepare
