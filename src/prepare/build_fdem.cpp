#include "prepare/build_fdem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>

#include "exec/error.hpp"
#include "prepare/checks/check_bodies.hpp"
#include "prepare/checks/refusal.hpp"
#include "prepare/meshing/body_mesh.hpp"
#include "prepare/meshing/crack_path.hpp"
#include "prepare/meshing/heterogeneity.hpp"
#include "prepare/meshing/joint_sets.hpp"
#include "prepare/meshing/mesh_check.hpp"
#include "prepare/meshing/mesh_order.hpp"
#include "prepare/meshing/mesh_overlap.hpp"

namespace breccia {
namespace {

using fdem::BodyConfig;
using fdem::DiscontinuityConfig;
using fdem::Model;
using prepare::Mesh;

std::int16_t index_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::int16_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// Collects the triangles of all bodies.
class Assembly {
 public:
  Assembly(const std::vector<BodyConfig>& bodies,
           const std::vector<DiscontinuityConfig>& discontinuities, const FdemNames& names,
           std::int64_t seed, const std::string& case_folder)
      : bodies_(bodies), names_(names) {
    prepare::MeshingContext context{.seed = seed, .number = 0, .folder = case_folder, .lines = {}};
    for (const DiscontinuityConfig& d : discontinuities)
      for (std::size_t k = 1; d.embedded && k < d.points.size(); ++k)
        context.lines.push_back({d.points[k - 1], d.points[k]});
    for (const BodyConfig& body : bodies)
      if (body.shape == "part") prepare::add_outline(body, edge_of(body.of), context.lines);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      model_.groups.push_back(bodies[b].name);
      if (bodies[b].shape == "part") continue;
      context.number = static_cast<std::uint32_t>(b);
      try {
        add(static_cast<std::int16_t>(b), context);
      } catch (const InputError& error) {
        problems_.push_back("body." + bodies[b].name + ": " + error.what());
      }
    }
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (bodies[b].shape == "part") take_part(b);
    prepare::refuse(problems_, "with the model");
  }
  Model& model() { return model_; }

 private:
  /// A mesh whose vertices are in the model.
  struct Placed {
    Mesh mesh;
    std::vector<Index> vertex;  ///< of the model, of each point; -1: not used yet
    std::vector<int> owner;     ///< body of each triangle; -1: none yet
  };

  void add(std::int16_t group, const prepare::MeshingContext& context) {
    const BodyConfig& body = bodies_[static_cast<std::size_t>(group)];
    Placed own;
    Placed* placed = &own;
    if (body.shape == "mesh" || body.shape == "geo")
      placed = &files_[{body.file, body.center.x, body.center.y, body.mesh_size, body.jitter}];
    if (placed->mesh.triangle.empty()) {
      placed->mesh = prepare::mesh_of(body, context);
      prepare::check_mesh(placed->mesh);
      placed->vertex.assign(placed->mesh.point.size(), -1);
      placed->owner.assign(placed->mesh.triangle.size(), -1);
    }
    for (const Index t : prepare::triangles_of(body, placed->mesh)) {
      int& owner = placed->owner[static_cast<std::size_t>(t)];
      if (owner == group) continue;  // in two parts of this body
      if (owner >= 0)
        throw InputError(fmt::format("parts of {} are also those of body.{}", body.file,
                                     bodies_[static_cast<std::size_t>(owner)].name));
      owner = group;
      add_triangle(*placed, placed->mesh.triangle[static_cast<std::size_t>(t)], group);
    }
    add_edge_sets(*placed);
    add_inner_edges(*placed);
  }

  double edge_of(const std::string& name) const {
    for (const BodyConfig& body : bodies_)
      if (body.name == name) return body.mesh_size;
    return 0.0;
  }

  /// Triangles of another body whose centroid lies in a part of it become those of the part.
  void take_part(std::size_t number) {
    const BodyConfig& part = bodies_[number];
    const auto host = index_of(model_.groups, part.of);
    bool any = false;
    for (std::size_t t = 0; t < model_.triangle.size(); ++t) {
      if (model_.group[t] != host) continue;
      if (!prepare::in_part(part, prepare::centroid(model_.point, model_.triangle[t]))) continue;
      model_.group[t] = static_cast<std::int16_t>(number);
      model_.material[t] = index_of(names_.materials, part.material);
      any = true;
    }
    if (!any)
      problems_.push_back(
          fmt::format("body.{}: no triangle of body.{} lies in it", part.name, part.of));
  }

  void add_triangle(Placed& placed, const prepare::Triangle& triangle, std::int16_t group) {
    const BodyConfig& body = bodies_[static_cast<std::size_t>(group)];
    prepare::Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      Index& vertex = placed.vertex[static_cast<std::size_t>(triangle[k])];
      if (vertex < 0) {
        vertex = static_cast<Index>(model_.point.size());
        model_.point.push_back(prepare::at(placed.mesh.point, triangle[k]));
      }
      corners[k] = vertex;
    }
    model_.triangle.push_back(corners);
    model_.group.push_back(group);
    model_.material.push_back(index_of(names_.materials, body.material));
    model_.velocity.push_back(body.velocity);
    model_.strength.push_back(1.0F);
  }

  /// Edges whose two ends are in the model; each once in a set.
  void add_edge_sets(const Placed& placed) {
    for (const prepare::EdgeSet& given : placed.mesh.edge_sets) {
      auto set = std::find_if(model_.edge_sets.begin(), model_.edge_sets.end(),
                              [&](const Model::EdgeSet& s) { return s.name == given.name; });
      if (set == model_.edge_sets.end())
        set = model_.edge_sets.insert(set, Model::EdgeSet{given.name, {}});
      for (const prepare::Edge& edge : given.edges) {
        const Index a = placed.vertex[static_cast<std::size_t>(edge[0])],
                    b = placed.vertex[static_cast<std::size_t>(edge[1])];
        if (a >= 0 && b >= 0) set->edges.push_back({std::min(a, b), std::max(a, b)});
      }
      std::sort(set->edges.begin(), set->edges.end());
      set->edges.erase(std::unique(set->edges.begin(), set->edges.end()), set->edges.end());
    }
  }

  /// Of quadrangles in the model, once more for each body of their file.
  void add_inner_edges(const Placed& placed) {
    for (const prepare::Edge& edge : placed.mesh.inner) {
      const Index a = placed.vertex[static_cast<std::size_t>(edge[0])],
                  b = placed.vertex[static_cast<std::size_t>(edge[1])];
      if (a >= 0 && b >= 0)
        model_.discontinuities.push_back({{std::min(a, b), std::max(a, b)}, Model::as_one});
    }
  }

  const std::vector<BodyConfig>& bodies_;
  const FdemNames& names_;
  std::map<std::tuple<std::string, double, double, double, double>, Placed> files_;
  Model model_;
  std::vector<std::string> problems_;
};

/// Streams of random numbers: packings of the DEM use those below the first, one for each body.
constexpr std::uint32_t grain_stream = 0x20000, strength_stream = 0x30000;

/// One body of a model that is whole and in order.
class BodyInModel {
 public:
  BodyInModel(Model& model, const std::vector<BodyConfig>& bodies, std::size_t number)
      : model_(model), body_(bodies[number]), number_(number) {
    for (std::size_t t = 0; t < model.triangle.size(); ++t) {
      if (static_cast<std::size_t>(model.group[t]) != number) continue;
      triangles_.push_back(t);
      places_.push_back(prepare::centroid(model.point, model.triangle[t]));
    }
  }

  void give_minerals(const FdemNames& names, std::int64_t seed, const std::string& folder) {
    const fdem::GrainsConfig& grains = body_.grains;
    if (grains.kind.empty()) return;
    std::vector<int> minerals;
    if (grains.kind == "picture") {
      minerals = from_picture((std::filesystem::path(folder) / grains.file).string());
    } else {
      const Random random = random_of(seed, grain_stream);
      std::vector<std::uint64_t> keys(triangles_.size());
      for (std::size_t k = 0; k < keys.size(); ++k) keys[k] = k;
      if (grains.kind == "voronoi") keys = prepare::voronoi_grains(places_, grains.size, random);
      if (!grains.boundary.empty()) find_boundaries(keys);
      minerals = by_share(keys, random);
    }
    for (std::size_t k = 0; k < triangles_.size(); ++k)
      model_.material[triangles_[k]] = index_of(
          names.materials, grains.minerals[static_cast<std::size_t>(minerals[k])].material);
  }

  /// Edges between two grains, if their joints have a law of their own.
  const std::vector<prepare::Edge>& boundaries() const { return boundaries_; }

  void give_strength(std::int64_t seed) {
    if (body_.weibull.modulus <= 0.0) return;
    const auto factors = prepare::weibull_factors(
        places_, body_.weibull.modulus, body_.weibull.length, random_of(seed, strength_stream));
    for (std::size_t k = 0; k < triangles_.size(); ++k) model_.strength[triangles_[k]] = factors[k];
  }

  /// The open cracks of the body.
  std::vector<prepare::Edge> open_edges(std::vector<std::string>& problems) const {
    std::vector<prepare::Edge> edges;
    std::vector<prepare::Triangle> own;
    for (std::size_t k = 0; k < body_.notches.size(); ++k) {
      const fdem::NotchConfig& notch = body_.notches[k];
      if (notch.width > 0.0) continue;
      if (own.empty())
        for (const std::size_t t : triangles_) own.push_back(model_.triangle[t]);
      const auto found = prepare::edges_along({notch.from, notch.to}, model_.point, own);
      if (found.empty())
        problems.push_back(fmt::format(
            "body.{}: notch[{}] meets no edge between two triangles of the body", body_.name, k));
      edges.insert(edges.end(), found.begin(), found.end());
    }
    return edges;
  }

 private:
  Random random_of(std::int64_t seed, std::uint32_t stream) const {
    return {static_cast<std::uint64_t>(seed), stream + static_cast<std::uint32_t>(number_)};
  }

  /// Triangles of one key get one mineral.
  std::vector<int> by_share(const std::vector<std::uint64_t>& keys, const Random& random) const {
    std::map<std::uint64_t, double> area_of;
    for (std::size_t k = 0; k < keys.size(); ++k)
      area_of[keys[k]] += prepare::signed_area(model_.point, model_.triangle[triangles_[k]]);
    std::vector<double> areas, shares;
    std::vector<std::uint64_t> pieces;
    for (const auto& [key, area] : area_of) {
      pieces.push_back(key);
      areas.push_back(area);
    }
    for (const fdem::MineralConfig& mineral : body_.grains.minerals)
      shares.push_back(mineral.fraction);
    const std::vector<int> given = prepare::minerals_by_share(areas, pieces, shares, random);
    std::vector<int> minerals;
    for (const std::uint64_t key : keys)
      minerals.push_back(given[static_cast<std::size_t>(
          std::lower_bound(pieces.begin(), pieces.end(), key) - pieces.begin())]);
    return minerals;
  }

  std::vector<int> from_picture(const std::string& path) const {
    std::vector<std::array<int, 3>> colors;
    for (const fdem::MineralConfig& mineral : body_.grains.minerals) {
      const int rgb = std::stoi(mineral.color, nullptr, 16);
      colors.push_back({rgb >> 16, (rgb >> 8) & 255, rgb & 255});
    }
    Vec2 low{1e300, 1e300}, high{-1e300, -1e300};
    for (const std::size_t t : triangles_)
      for (const Index v : model_.triangle[t]) {
        const Vec2 p = prepare::at(model_.point, v);
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
    return prepare::minerals_by_picture(places_, read_png(path), low, high, colors);
  }

  /// @param grains  of the triangles
  void find_boundaries(const std::vector<std::uint64_t>& grains) {
    std::map<prepare::Edge, std::uint64_t> first;
    for (std::size_t k = 0; k < triangles_.size(); ++k) {
      const prepare::Triangle& t = model_.triangle[triangles_[k]];
      for (std::size_t side = 0; side < 3; ++side) {
        const Index a = t[side], b = t[(side + 1) % 3];
        const prepare::Edge edge{std::min(a, b), std::max(a, b)};
        const auto [found, is_new] = first.try_emplace(edge, grains[k]);
        if (!is_new && found->second != grains[k]) boundaries_.push_back(edge);
      }
    }
  }

  Model& model_;
  const BodyConfig& body_;
  std::size_t number_;
  std::vector<prepare::Edge> boundaries_;
  std::vector<std::size_t> triangles_;
  std::vector<Vec2> places_;  ///< of the triangles' centroids  [m]
};

/// Joints of their own, and cracks at the start: boundaries of grains first, then notches, then
/// discontinuities; on an edge of several, the last counts. Those behind the first `single` are of
/// sets, whose lines may miss all bodies.
void crack(Model& model, std::map<prepare::Edge, std::int16_t> material,
           const std::vector<prepare::Edge>& notches,
           const std::vector<DiscontinuityConfig>& discontinuities, std::size_t single,
           const FdemNames& names, std::vector<std::string>& problems) {
  for (const prepare::Edge& edge : notches) material[edge] = -1;
  for (std::size_t k = 0; k < discontinuities.size(); ++k) {
    const DiscontinuityConfig& d = discontinuities[k];
    const auto edges = prepare::edges_along(d.points, model.point, model.triangle);
    if (edges.empty() && k < single)
      problems.push_back("discontinuity." + d.name + ": meets no edge between two triangles");
    for (const prepare::Edge& edge : edges)
      material[edge] = d.kind == "open" ? std::int16_t{-1} : index_of(names.joints, d.material);
  }
  for (const auto& [edge, given] : material) model.discontinuities.push_back({edge, given});
}

/// One sentence for each pair of bodies that lie in each other.
void check_overlaps(const Model& model, std::vector<std::string>& problems) {
  std::set<std::pair<int, int>> seen;
  for (const prepare::Overlap& pair : prepare::overlaps_of(model.point, model.triangle)) {
    const int a = model.group[static_cast<std::size_t>(pair.a)],
              b = model.group[static_cast<std::size_t>(pair.b)];
    if (!seen.insert({std::min(a, b), std::max(a, b)}).second) continue;
    const Vec2 place =
        prepare::centroid(model.point, model.triangle[static_cast<std::size_t>(pair.a)]);
    const std::string& name = model.groups[static_cast<std::size_t>(std::min(a, b))];
    problems.push_back(
        a == b ? fmt::format("body.{}: two of its triangles overlap near ({:.6g}, {:.6g}) m", name,
                             place.x, place.y)
               : fmt::format("body.{} and body.{} overlap at the start near ({:.6g}, {:.6g}) m; "
                             "move one of them",
                             name, model.groups[static_cast<std::size_t>(std::max(a, b))], place.x,
                             place.y));
  }
}

}  // namespace

FdemNames names_of(const fdem::Config& config) {
  FdemNames names;
  for (const fdem::MaterialConfig& m : config.materials) names.materials.push_back(m.name);
  for (const fdem::JointConfig& j : config.joint_laws) names.joints.push_back(j.name);
  return names;
}

fdem::Model build_fdem_model(const std::vector<BodyConfig>& bodies,
                             const std::vector<DiscontinuityConfig>& discontinuities,
                             const FdemNames& names, std::int64_t seed,
                             const std::string& case_folder,
                             const std::vector<fdem::JointSetConfig>& joint_sets) {
  std::vector<std::string> faults = prepare::body_problems(bodies, discontinuities, names);
  std::vector<DiscontinuityConfig> cracks = discontinuities;
  for (std::size_t k = 0; k < joint_sets.size(); ++k) {
    for (const std::string& fault : prepare::joint_set_problems(joint_sets[k], names.joints))
      faults.push_back(fault);
    if (!faults.empty()) continue;
    try {
      const auto lines = prepare::lines_of_set(joint_sets[k], seed, k, case_folder);
      cracks.insert(cracks.end(), lines.begin(), lines.end());
    } catch (const InputError& error) {
      faults.push_back("joint_set." + joint_sets[k].name + ": " + error.what());
    }
  }
  prepare::refuse(faults, "with the model");
  Assembly assembly(bodies, cracks, names, seed, case_folder);
  Model& model = assembly.model();
  prepare::order_along_curve(model);

  std::vector<std::string> problems;
  std::vector<prepare::Edge> notches;
  std::map<prepare::Edge, std::int16_t> boundaries;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    BodyInModel body(model, bodies, b);
    try {
      body.give_minerals(names, seed, case_folder);
    } catch (const InputError& error) {
      problems.push_back("body." + bodies[b].name + ".grains: " + error.what());
    }
    for (const prepare::Edge& edge : body.boundaries())
      boundaries[edge] = index_of(names.joints, bodies[b].grains.boundary);
    body.give_strength(seed);
    const auto edges = body.open_edges(problems);
    notches.insert(notches.end(), edges.begin(), edges.end());
  }
  crack(model, std::move(boundaries), notches, cracks, discontinuities.size(), names, problems);
  check_overlaps(model, problems);
  prepare::refuse(problems, "with the model");
  return std::move(model);
}

fdem::Model build_model(const fdem::Config& config, const std::string& case_folder) {
  return build_fdem_model(config.bodies, config.discontinuities, names_of(config), config.seed,
                          case_folder, config.joint_sets);
}

}  // namespace breccia
