#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "core/most_names.hpp"
#include "dem/setup/materials.hpp"
#include "prepare/checks/by_name.hpp"
#include "prepare/checks/check_bodies.hpp"
#include "prepare/packing/body_packing.hpp"
#include "prepare/packing/rebar.hpp"
#include "prepare/shapes/carve.hpp"

namespace breccia::prepare {
namespace {

using dem::BodyConfig;
using dem::Config;
using dem::MaterialConfig;

/// The distance of x from an interval; 0 inside.  [m]
double beyond(double x, double low, double high) {
  return x < low ? low - x : x > high ? x - high : 0.0;
}
bool round(const BodyConfig& b) {
  return b.shape == "sphere" || b.shape == "element";
}
bool has_shape(const BodyConfig& b) {
  return !is_shaped(b) && (round(b) || b.shape == "box" || b.shape == "cylinder");
}
/// Half of the height of a box or cylinder.  [m]
double half_height(const BodyConfig& b) {
  return 0.5 * (b.shape == "box" ? b.size.z : b.length);
}
/// The space between two upright bodies, each a rectangle or a disc times a height, or between
/// one of them and a ball; below 0 they share space by so much.  [m]
double gap(const BodyConfig& a, const BodyConfig& b) {
  if (round(b) && !round(a)) return gap(b, a);
  const Vec3 apart = b.center - a.center;
  if (round(b)) return norm(apart) - a.radius - b.radius;
  // In the plane: corners of rectangles are sharp, so a disc's radius is taken off last.
  const double half_x =
      (a.shape == "box" ? 0.5 * a.size.x : 0.0) + (b.shape == "box" ? 0.5 * b.size.x : 0.0);
  const double half_y =
      (a.shape == "box" ? 0.5 * a.size.y : 0.0) + (b.shape == "box" ? 0.5 * b.size.y : 0.0);
  const double dx = beyond(apart.x, -half_x, half_x), dy = beyond(apart.y, -half_y, half_y);
  const double across = std::sqrt(dx * dx + dy * dy);
  const double disc_b = b.shape == "cylinder" ? b.radius : 0.0;
  if (round(a)) {
    const double aside = std::max(across - disc_b, 0.0);
    const double above = beyond(apart.z, -half_height(b), half_height(b));
    return std::sqrt(aside * aside + above * above) - a.radius;
  }
  const double along = std::abs(apart.z) - half_height(a) - half_height(b);
  if (a.shape == "box" && b.shape == "box")
    return std::max({std::abs(apart.x) - half_x, std::abs(apart.y) - half_y, along});
  const double disc_a = a.shape == "cylinder" ? a.radius : 0.0;
  return std::max(across - disc_a - disc_b, along);
}
/// Bodies of more elements are tested when they are packed.
constexpr int most_tested = 100'000;

/// The items of which something holds.
template <class Item, class Holds>
std::vector<Item> those_of(const std::vector<Item>& items, const Holds& holds) {
  std::vector<Item> those;
  std::copy_if(items.begin(), items.end(), std::back_inserter(those), holds);
  return those;
}

double extent(const BodyConfig& b) {
  return norm(b.size) + b.radius + b.length + norm(b.center);
}

class DemBodyChecks {
 public:
  explicit DemBodyChecks(const Config& config) : config_(config) {
    if (config.bodies.empty())
      problems_.push_back("body: the case has no elements; at least one [[body]] is needed");
    add_too_many(config.bodies.size(), "bodies", problems_);
    add_too_many(config.materials.size(), "materials", problems_);
    std::set<std::string> seen;
    for (const BodyConfig& b : config.bodies) {
      path_ = "body." + b.name;
      require(seen.insert(b.name).second, ": another body has this name");
      check(b);
    }
  }
  std::vector<std::string> problems_;

 private:
  template <class... Args>
  void require(bool holds, fmt::format_string<Args...> text, Args&&... args) {
    if (!holds) problems_.push_back(path_ + fmt::format(text, std::forward<Args>(args)...));
  }
  void check(const BodyConfig& b) {
    check_material(b);
    if (b.grains.any()) check_grains(b);
    if (b.shape == "rebar") return check_rebar(b);
    const MaterialConfig* of = prepare::item_named(config_.materials, b.material);
    if (of != nullptr && of->law == "ldpm") check_ldpm(b, *of);
    check_shape(b);
    const bool packed = is_packed(b) && (of == nullptr || of->law != "ldpm");
    if (packed) check_pack(b);
    require(b.shape != "box" || (b.size.x > 0.0 && b.size.y > 0.0 && b.size.z > 0.0),
            ".size needs three lengths above 0");
    const bool round_body = round(b) || b.shape == "cylinder";
    require(!round_body || b.radius > 0.0, ".radius must be above 0");
    require(b.shape != "cylinder" || b.length > 0.0, ".length must be above 0");
    require(b.shape != "stl" || !b.file.empty(), ".file is missing: an STL file");
    require(b.shape != "file" || !b.file.empty(), ".file is missing: a CSV of x,y,z,radius");
    if (packed) check_room(b);
    const MaterialConfig* material = prepare::item_named(config_.materials, b.material);
    const bool bulk = b.shape == "file" && material != nullptr && material->law != "ldpm" &&
                      dem::kind_within(material->law).has_value();
    require(!bulk || b.bulk_volume() > 0.0,
            ".volume is missing: spheres of concrete do not fill space, so their mass is density "
            "times the volume that they stand for; give volume in m3, or the size of a box");
    const bool even = material != nullptr && material->fabric != "packed";
    require(b.shape != "file" || !even || b.size.x * b.size.y * b.size.z > 0.0,
            ".size is missing: fabric = \"{}\" of {} asks how deep elements lie in their box",
            material == nullptr ? "" : material->fabric, b.material);
  }

  void check_grains(const BodyConfig& b) {
    const dem::GrainsConfig& g = b.grains;
    const MaterialConfig* const of = prepare::item_named(config_.materials, b.material);
    const MaterialConfig* const between = prepare::item_named(config_.materials, g.boundary);
    require(g.size > 0.0, ".grains.size must be above 0 for Voronoi grains");
    require(is_packed(b) || b.shape == "file",
            ".grains: packings and spheres of a file have grains, not shape {}", b.shape);
    require(between != nullptr, ".grains.boundary = \"{}\" is no material; there are: {}",
            g.boundary, prepare::all_names(config_.materials, g.boundary));
    if (of == nullptr || between == nullptr) return;
    require(of->law == "concrete" || of->law == "parallel",
            ".grains: links of law concrete and parallel have boundaries, not law {}", of->law);
    require(of->law == between->law,
            ".grains.boundary = \"{}\" is of law {}, and links of {} are of law {}", g.boundary,
            between->law, b.name, of->law);
  }

  static bool is_packed(const BodyConfig& b) {
    return b.shape == "box" || b.shape == "sphere" || b.shape == "cylinder" || b.shape == "stl";
  }
  /// @param path  of the keys, below the body's
  void check_turn(const Vec3& axis, const Vec3& across, const std::string& path) {
    require(norm(axis) > 0.0, "{}.axis is no direction", path);
    require(norm(across) == 0.0 || norm(cross(axis, across)) > 1e-6 * norm(axis) * norm(across),
            "{}.across lies along axis: it says nothing of how the body is turned", path);
  }
  void check_shape(const BodyConfig& b) {
    check_turn(b.axis, b.across, "");
    require(is_packed(b) || (b.cuts.empty() && b.joins.empty()),
            ".cut: only packings are cut, not shape {}; spheres of a file come as they are wanted",
            b.shape);
    require(is_packed(b) || b.shape == "file" || !is_shaped(b) || !b.cuts.empty(),
            ".axis turns packings and bodies from a file, not shape {}", b.shape);
    check_joins(b);
    check_solids(b.joins, "join");
    check_solids(b.cuts, "cut");
  }
  void check_joins(const BodyConfig& b) {
    if (b.joins.empty()) return;
    require(b.shape == "box" || b.shape == "sphere" || b.shape == "cylinder",
            ".join: boxes, spheres and cylinders are joined to, not shape {}", b.shape);
    const std::vector<std::string>& periodic = b.pack.periodic;
    require(
        periodic.empty() || periodic.size() == 3,
        ".pack.periodic: a body with joins is cut from a cell that is periodic along x, y and z");
    for (std::size_t k = 0; k < b.joins.size(); ++k) {
      const dem::CutConfig& join = b.joins[k];
      require(join.shape != "stl", ".join[{}]: draw the union in the STL file of the body", k);
      require(join.shape != "box" || (join.size.x > 0.0 && join.size.y > 0.0 && join.size.z > 0.0),
              ".join[{}].size needs three lengths above 0", k);
    }
  }
  void check_solids(const std::vector<dem::CutConfig>& solids, const char* key) {
    for (std::size_t k = 0; k < solids.size(); ++k) {
      const dem::CutConfig& cut = solids[k];
      const std::string path = fmt::format(".{}[{}]", key, k);
      check_turn(cut.axis, cut.across, path);
      const int flat = (cut.size.x == 0.0) + (cut.size.y == 0.0) + (cut.size.z == 0.0);
      require(cut.shape != "box" || flat <= 1, "{}.size needs two lengths above 0, or three", path);
      require((cut.shape != "sphere" && cut.shape != "cylinder") || cut.radius > 0.0,
              "{}.radius must be above 0", path);
      require(cut.shape != "cylinder" || cut.length > 0.0, "{}.length must be above 0", path);
      require(cut.shape != "stl" || !cut.file.empty(), "{}.file is missing: an STL file", path);
    }
  }

  bool has_bars(const BodyConfig& b) const { return prepare::has_bars(config_.bodies, b); }
  void check_pack(const BodyConfig& b) {
    for (const std::string& problem : pack_problems(b)) require(false, ".pack{}", problem);
    const Vec3& cell = b.pack.cell;
    require(!has_bars(b) || (cell.x == 0.0 && cell.y == 0.0 && cell.z == 0.0),
            ".pack.cell: a body with bars is no repeated cell; leave cell out");
  }

  /// Whether the largest element fits. Bodies with bars, whose elements are smaller by the bars'
  /// volume, are tested when they are packed.
  void check_room(const BodyConfig& b) {
    const double volume = container_of(b).volume();
    if (has_bars(b) || !b.joins.empty() || !(volume > 0.0) || !pack_problems(b).empty()) return;
    const double count = elements_in(b.pack, volume);
    require(count >= 1.0, ".pack.sieves: an element is larger than the body");
    require(count <= 2e9, ".pack.sieves: {:.3g} elements are too many (2e9 at most)", count);
    if (count < 1.0 || count > most_tested) return;
    const auto group = static_cast<std::uint32_t>(&b - config_.bodies.data());
    const PackingTask task =
        packing_task(b, {}, 0.0, {static_cast<std::uint64_t>(config_.seed), group});
    if (task.count > most_tested) return;
    const std::string problem = misfit(task, packing_radii(task));
    require(problem.empty(), ".pack.{}: {}", b.pack.sieves.empty() ? "count" : "sieves", problem);
  }

  void check_ldpm(const BodyConfig& b, const MaterialConfig& m) {
    require(
        b.shape == "box" || b.shape == "cylinder" || b.shape == "stl" || b.shape == "file",
        ": bodies of law ldpm are boxes, cylinders, the inside of an STL surface, or read from a "
        "file, not of shape {}",
        b.shape);
    require(b.pack.count == 0 && b.pack.sieves.empty(),
            ".pack has no use in a body of law ldpm: its grains follow from {}.mix", m.name);
    require(
        b.joins.empty(),
        ".join: bodies of law ldpm are their own shape, less cuts; draw a union as an STL surface");
  }

  void check_material(const BodyConfig& b) {
    const MaterialConfig* material = prepare::item_named(config_.materials, b.material);
    require(material != nullptr, ".material = {:?} is not a material; there are: {}", b.material,
            prepare::all_names(config_.materials, b.material));
    if (material == nullptr) return;
    require(material->fracture_energy == 0.0 || material->tensile_strength > 0.0,
            ": fracture_energy of {} needs a tensile_strength above 0", b.material);
    if (b.shape == "rebar")
      require(material->law == "steel", ": bars need a material of law steel, {} has {}",
              b.material, material->law);
    else
      require(dem::kind_within(material->law).has_value() || material->law == "grain",
              ": elements need a material of law {}grain, {} has {}", dem::laws_within(),
              b.material, material->law);
  }

  void check_rebar(const BodyConfig& b) {
    require(norm(b.velocity) == 0.0 && norm(b.spin) == 0.0,
            ": bars move with the body they reinforce; give velocity and spin there");
    const MaterialConfig* bond = prepare::item_named(config_.materials, b.rebar.interface_law);
    require(
        bond != nullptr && bond->law == "interface",
        ".rebar.interface = {:?} is not a material of law interface; there are: {}",
        b.rebar.interface_law,
        prepare::all_names(those_of(config_.materials,
                                    [](const MaterialConfig& m) { return m.law == "interface"; }),
                           b.rebar.interface_law));
    const BodyConfig* host = prepare::item_named(config_.bodies, b.rebar.in);
    const bool drawn = !b.rebar.drawn.empty();
    require(host != nullptr, ".rebar.in = {:?} is not a body; there are: {}", b.rebar.in,
            prepare::all_names(
                those_of(config_.bodies, [](const BodyConfig& o) { return o.shape != "rebar"; }),
                b.rebar.in));
    if (host == nullptr) return;
    const bool fits = drawn ? is_packed(*host) || host->shape == "file"
                            : host->shape == "box" && host->joins.empty();
    require(fits, ".rebar.in = {:?} is a body of shape {}{}: {}", b.rebar.in, host->shape,
            host->joins.empty() ? "" : " with joins",
            drawn ? "bars lie in bodies of shape box, cylinder, sphere, stl or file"
                  : "mats of bars lie in boxes; in other bodies bars are drawn one by one "
                    "([[body.rebar.bar]])");
    if (!fits) return;
    const auto problems = bar_problems(b.rebar, *host);
    for (const std::string& problem : problems) require(false, ".rebar: {}", problem);
    if (!problems.empty()) return;
    const std::vector<Chain> own = chains_through(b.rebar, host->size);
    if (drawn)
      for (const std::string& problem : crossing_problems(own, own))
        require(false, ".rebar: {}", problem);
    for (const BodyConfig& other : config_.bodies) {
      if (&other == &b) break;
      if (other.shape != "rebar" || other.rebar.in != b.rebar.in ||
          !bar_problems(other.rebar, *host).empty())
        continue;
      for (const std::string& problem :
           crossing_problems(own, chains_through(other.rebar, host->size)))
        require(false, ".rebar: with body.{}: {}", other.name, problem);
    }
  }

  const Config& config_;
  std::string path_;
};

}  // namespace

std::vector<std::string> body_problems(const Config& config) {
  return DemBodyChecks(config).problems_;
}

std::vector<std::string> overlap_problems(const std::vector<BodyConfig>& bodies) {
  std::vector<std::string> problems;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      const BodyConfig &a = bodies[i], &b = bodies[j];
      // Bars lie in their host; the spheres of a file are compared when they have been read.
      if (!has_shape(a) || !has_shape(b)) continue;
      if (gap(a, b) < -1e-9 * (extent(a) + extent(b)))
        problems.push_back(overlap_problem(a.name, b.name));
    }
  return problems;
}

}  // namespace breccia::prepare
