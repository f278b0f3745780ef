#include "prepare/build_fdem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "exec/error.hpp"
#include "prepare/body_mesh.hpp"
#include "prepare/check_bodies.hpp"
#include "prepare/mesh_check.hpp"
#include "prepare/mesh_order.hpp"

namespace breccia {
namespace {

using fdem::BodyConfig;
using fdem::DiscontinuityConfig;
using fdem::Model;
using prepare::Mesh;

[[noreturn]] void refuse(const std::vector<std::string>& problems) {
  std::string text = fmt::format("{} problem{} with the model; nothing was run.", problems.size(),
                                 problems.size() == 1 ? "" : "s");
  for (const std::string& problem : problems) text += "\n  " + problem;
  throw InputError(text);
}

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
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      model_.groups.push_back(bodies[b].name);
      context.number = static_cast<std::uint32_t>(b);
      try {
        add(static_cast<std::int16_t>(b), context);
      } catch (const InputError& error) {
        problems_.push_back("body." + bodies[b].name + ": " + error.what());
      }
    }
    if (!problems_.empty()) refuse(problems_);
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
    for (const Index t : triangles_of(body, placed->mesh)) {
      int& owner = placed->owner[static_cast<std::size_t>(t)];
      if (owner == group) continue;  // in two parts of this body
      if (owner >= 0)
        throw InputError(fmt::format("parts of {} are also those of body.{}", body.file,
                                     bodies_[static_cast<std::size_t>(owner)].name));
      owner = group;
      add_triangle(*placed, placed->mesh.triangle[static_cast<std::size_t>(t)], group);
    }
    add_edge_sets(*placed);
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

  /// The triangles of a mesh that are a body: those of its parts, or all.
  static std::vector<Index> triangles_of(const BodyConfig& body, const Mesh& mesh) {
    std::vector<Index> triangles;
    if (body.parts.empty())
      for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
        triangles.push_back(static_cast<Index>(t));
    for (const std::string& name : body.parts) {
      const auto found = std::find_if(mesh.parts.begin(), mesh.parts.end(),
                                      [&](const prepare::Part& part) { return part.name == name; });
      if (found != mesh.parts.end()) {
        triangles.insert(triangles.end(), found->triangles.begin(), found->triangles.end());
        continue;
      }
      std::string there;
      for (const prepare::Part& part : mesh.parts) there += (there.empty() ? "" : ", ") + part.name;
      throw InputError(fmt::format("parts: {} has no part \"{}\"; it has: {}", body.file, name,
                                   there.empty() ? "none" : there));
    }
    return triangles;
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

  const std::vector<BodyConfig>& bodies_;
  const FdemNames& names_;
  std::map<std::tuple<std::string, double, double, double, double>, Placed> files_;
  Model model_;
  std::vector<std::string> problems_;
};

}  // namespace

fdem::Model build_fdem_model(const std::vector<BodyConfig>& bodies,
                             const std::vector<DiscontinuityConfig>& discontinuities,
                             const FdemNames& names, std::int64_t seed,
                             const std::string& case_folder) {
  const std::vector<std::string> wrong = prepare::body_problems(bodies, discontinuities, names);
  if (!wrong.empty()) refuse(wrong);
  Assembly assembly(bodies, discontinuities, names, seed, case_folder);
  Model& model = assembly.model();
  prepare::order_along_curve(model);
  return std::move(model);
}

}  // namespace breccia
