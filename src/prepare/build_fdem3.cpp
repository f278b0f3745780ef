#include "prepare/build_fdem3.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "core/random.hpp"
#include "exec/error.hpp"
#include "prepare/checks/check_bodies.hpp"
#include "prepare/checks/refusal.hpp"
#include "prepare/meshing/heterogeneity.hpp"
#include "prepare/tetrahedra/crack_faces.hpp"
#include "prepare/tetrahedra/joint_discs.hpp"
#include "prepare/tetrahedra/tet_body.hpp"
#include "prepare/tetrahedra/tet_check.hpp"
#include "prepare/tetrahedra/tet_order.hpp"
#include "prepare/tetrahedra/tet_overlap.hpp"

namespace breccia::fdem3 {
namespace {

/// Index of the material or joint law of a name; it is there.
template <class Items>
std::int16_t index_in(const Items& items, const std::string& name) {
  return static_cast<std::int16_t>(
      std::find_if(items.begin(), items.end(), [&](const auto& i) { return i.name == name; }) -
      items.begin());
}

/// Collects the tetrahedra of all bodies.
class TetAssembly {
 public:
  TetAssembly(const Config& config, const std::string& case_folder) : config_(config) {
    prepare::TetContext context{
        .seed = config.seed, .number = 0, .folder = case_folder, .cracks = {}};
    for (const DiscontinuityConfig& d : config.discontinuities)
      if (d.embedded) context.cracks.push_back(d);
    std::vector<std::string> problems;
    for (std::size_t b = 0; b < config.bodies.size(); ++b) {
      model_.groups.push_back(config.bodies[b].name);
      if (config.bodies[b].shape == "part") continue;
      context.number = static_cast<std::uint32_t>(b);
      try {
        add(static_cast<std::int16_t>(b), context);
      } catch (const InputError& error) {
        problems.push_back("body." + config.bodies[b].name + ": " + error.what());
      }
    }
    for (std::size_t b = 0; b < config.bodies.size(); ++b)
      if (config.bodies[b].shape == "part" && !take_part(b))
        problems.push_back(fmt::format("body.{}: no tetrahedron of body.{} lies in it",
                                       config.bodies[b].name, config.bodies[b].of));
    prepare::refuse(problems, "with the model");
  }
  Model& model() { return model_; }

 private:
  /// A mesh whose vertices are in the model.
  struct Placed {
    prepare::TetMesh mesh;
    std::vector<Index> vertex;  ///< of the model, of each point; -1: not used yet
    std::vector<int> owner;     ///< body of each tetrahedron; -1: none yet
  };

  void add(std::int16_t group, const prepare::TetContext& context) {
    const BodyConfig& body = config_.bodies[static_cast<std::size_t>(group)];
    Placed own;
    Placed* placed = &own;
    if (body.shape == "mesh")
      placed = &files_[{body.file, body.center.x, body.center.y, body.center.z, body.jitter}];
    if (placed->mesh.tetrahedron.empty()) {
      placed->mesh = prepare::mesh_of(body, context);
      prepare::check_mesh(placed->mesh);
      placed->vertex.assign(placed->mesh.point.size(), -1);
      placed->owner.assign(placed->mesh.tetrahedron.size(), -1);
    }
    const std::int16_t material = index_in(config_.materials, body.material);
    for (const Index t : prepare::tetrahedra_of(body, placed->mesh)) {
      int& owner = placed->owner[static_cast<std::size_t>(t)];
      if (owner == group) continue;  // in two parts of this body
      if (owner >= 0)
        throw InputError(fmt::format("parts of {} are also those of body.{}", body.file,
                                     config_.bodies[static_cast<std::size_t>(owner)].name));
      owner = group;
      model_.tetrahedron.push_back(
          corners_in_model(*placed, placed->mesh.tetrahedron[static_cast<std::size_t>(t)]));
      model_.group.push_back(group);
      model_.material.push_back(material);
      model_.velocity.push_back(body.velocity);
      model_.strength.push_back(1.0F);
    }
    add_face_sets(*placed);
  }

  /// Tetrahedra of another body whose middle lies in a part of it become those of the part.
  /// @returns whether there are any
  bool take_part(std::size_t number) {
    const BodyConfig& part = config_.bodies[number];
    const auto host = index_in(config_.bodies, part.of);
    const std::int16_t material = index_in(config_.materials, part.material);
    bool any = false;
    for (std::size_t t = 0; t < model_.tetrahedron.size(); ++t) {
      if (model_.group[t] != host) continue;
      if (!prepare::in_part(part, prepare::centroid(model_.point, model_.tetrahedron[t]))) continue;
      model_.group[t] = static_cast<std::int16_t>(number);
      model_.material[t] = material;
      any = true;
    }
    return any;
  }

  prepare::Tetrahedron corners_in_model(Placed& placed, prepare::Tetrahedron corners) {
    for (Index& corner : corners) {
      Index& vertex = placed.vertex[static_cast<std::size_t>(corner)];
      if (vertex < 0) {
        vertex = static_cast<Index>(model_.point.size());
        model_.point.push_back(prepare::at(placed.mesh.point, corner));
      }
      corner = vertex;
    }
    return corners;
  }

  /// Faces whose three vertices are in the model; each once in a set.
  void add_face_sets(const Placed& placed) {
    for (const prepare::FaceSet& given : placed.mesh.face_sets) {
      auto set = std::find_if(model_.face_sets.begin(), model_.face_sets.end(),
                              [&](const Model::FaceSet& s) { return s.name == given.name; });
      if (set == model_.face_sets.end())
        set = model_.face_sets.insert(set, Model::FaceSet{given.name, {}});
      for (prepare::Face face : given.faces) {
        for (Index& v : face) v = placed.vertex[static_cast<std::size_t>(v)];
        if (*std::min_element(face.begin(), face.end()) >= 0)
          set->faces.push_back(prepare::sorted(face));
      }
      std::sort(set->faces.begin(), set->faces.end());
      set->faces.erase(std::unique(set->faces.begin(), set->faces.end()), set->faces.end());
    }
  }

  const Config& config_;
  std::map<std::tuple<std::string, double, double, double, double>, Placed> files_;
  Model model_;
};

/// Streams of random numbers: meshes use those below the first, one for each body.
constexpr std::uint32_t tet_grain_stream = 0x20000, tet_strength_stream = 0x30000;

/// One body of a model that is whole and in order.
class TetBodyInModel {
 public:
  TetBodyInModel(Model& model, const Config& config, std::size_t number)
      : model_(model), config_(config), body_(config.bodies[number]), number_(number) {
    if (body_.grains.kind.empty() && body_.weibull.modulus <= 0.0) return;  // none is asked for
    for (std::size_t t = 0; t < model.tetrahedron.size(); ++t) {
      if (static_cast<std::size_t>(model.group[t]) != number) continue;
      tetrahedra_.push_back(t);
      places_.push_back(prepare::centroid(model.point, model.tetrahedron[t]));
    }
  }

  /// @param grain  gets the grain of each tetrahedron, where faces between grains have a law
  void give_minerals(std::vector<std::uint64_t>& grain) {
    const fdem::GrainsConfig& grains = body_.grains;
    if (grains.kind.empty()) return;
    const Random random = random_of(tet_grain_stream);
    std::vector<std::uint64_t> keys(tetrahedra_.size());
    for (std::size_t k = 0; k < keys.size(); ++k) keys[k] = k;
    if (grains.kind == "voronoi") keys = prepare::voronoi_grains(places_, grains.size, random);
    if (!grains.boundary.empty()) {
      grain.resize(model_.tetrahedron.size());
      for (std::size_t k = 0; k < keys.size(); ++k) grain[tetrahedra_[k]] = keys[k];
    }
    const std::vector<int> minerals = by_share(keys, random);
    for (std::size_t k = 0; k < tetrahedra_.size(); ++k)
      model_.material[tetrahedra_[k]] = index_in(
          config_.materials, grains.minerals[static_cast<std::size_t>(minerals[k])].material);
  }

  void give_strength() {
    if (body_.weibull.modulus <= 0.0) return;
    const auto factors = prepare::weibull_factors(
        places_, body_.weibull.modulus, body_.weibull.length, random_of(tet_strength_stream));
    for (std::size_t k = 0; k < tetrahedra_.size(); ++k)
      model_.strength[tetrahedra_[k]] = factors[k];
  }

 private:
  Random random_of(std::uint32_t stream) const {
    return {static_cast<std::uint64_t>(config_.seed), stream + static_cast<std::uint32_t>(number_)};
  }

  /// Tetrahedra of one key get one mineral.
  std::vector<int> by_share(const std::vector<std::uint64_t>& keys, const Random& random) const {
    std::map<std::uint64_t, double> volume_of;
    for (std::size_t k = 0; k < keys.size(); ++k)
      volume_of[keys[k]] +=
          prepare::signed_volume(model_.point, model_.tetrahedron[tetrahedra_[k]]);
    std::vector<double> volumes, shares;
    std::vector<std::uint64_t> pieces;
    for (const auto& [key, volume] : volume_of) {
      pieces.push_back(key);
      volumes.push_back(volume);
    }
    for (const fdem::MineralConfig& mineral : body_.grains.minerals)
      shares.push_back(mineral.fraction);
    const std::vector<int> given = prepare::minerals_by_share(volumes, pieces, shares, random);
    std::vector<int> minerals;
    minerals.reserve(keys.size());
    for (const std::uint64_t key : keys)
      minerals.push_back(given[static_cast<std::size_t>(
          std::lower_bound(pieces.begin(), pieces.end(), key) - pieces.begin())]);
    return minerals;
  }

  Model& model_;
  const Config& config_;
  const BodyConfig& body_;
  std::size_t number_;
  std::vector<std::size_t> tetrahedra_;
  std::vector<Vec3> places_;  ///< of the tetrahedra's centroids  [m]
};

/// Laws of faces between two grains of one body, where the body gives one.
/// @param grain  of each tetrahedron; empty: no body does
std::map<prepare::Face, std::int16_t> grain_boundaries(const Model& model, const Config& config,
                                                       const std::vector<prepare::MeshFace>& faces,
                                                       const std::vector<std::uint64_t>& grain) {
  std::map<prepare::Face, std::int16_t> law;
  if (grain.empty()) return law;
  for (const prepare::MeshFace& face : faces) {
    if (face.tetrahedra[1] < 0) continue;
    const auto a = static_cast<std::size_t>(face.tetrahedra[0]),
               b = static_cast<std::size_t>(face.tetrahedra[1]);
    if (model.group[a] != model.group[b] || grain[a] == grain[b]) continue;
    const std::string& name =
        config.bodies[static_cast<std::size_t>(model.group[a])].grains.boundary;
    if (!name.empty()) law[face.corners] = index_in(config.joint_laws, name);
  }
  return law;
}

/// Cracks at the start; on a face of several, the last counts.
/// @param material  laws of faces between grains
/// @param single  how many of them are no parts of sets; each must meet a face, and of a set one
void crack(Model& model, const Config& config, std::size_t single,
           const std::vector<prepare::MeshFace>& faces,
           std::map<prepare::Face, std::int16_t> material, std::vector<std::string>& problems) {
  std::map<std::string, bool> sets;  // whether one of theirs met a face
  for (std::size_t k = 0; k < config.discontinuities.size(); ++k) {
    const DiscontinuityConfig& d = config.discontinuities[k];
    const auto follows = [&](Index t) {
      auto body = static_cast<std::size_t>(model.group[static_cast<std::size_t>(t)]);
      if (config.bodies[body].shape == "part")
        body = static_cast<std::size_t>(index_in(config.bodies, config.bodies[body].of));
      return d.embedded && prepare::follows_cracks(config.bodies[body]);
    };
    const auto found = prepare::faces_along(d, model.point, model.tetrahedron, faces, follows);
    if (k >= single)
      sets[d.name] = sets[d.name] || !found.empty();
    else if (found.empty())
      problems.push_back("discontinuity." + d.name + ": meets no face between two tetrahedra");
    for (const prepare::Face& face : found)
      material[face] =
          d.kind == "open" ? std::int16_t{-1} : index_in(config.joint_laws, d.material);
  }
  for (const auto& [name, met] : sets)
    if (!met) problems.push_back("joint_set." + name + ": meets no face between two tetrahedra");
  for (const auto& [face, given] : material) model.discontinuities.push_back({face, given});
}

/// One sentence for each pair of bodies that lie in each other.
void look_for_overlaps(const Model& model, const std::vector<prepare::MeshFace>& faces,
                       std::vector<std::string>& problems) {
  std::set<std::pair<int, int>> seen;
  for (const prepare::TetOverlap& pair :
       prepare::overlaps_of(model.point, model.tetrahedron, faces)) {
    const auto [a, b] = std::minmax({model.group[static_cast<std::size_t>(pair.a)],
                                     model.group[static_cast<std::size_t>(pair.b)]});
    if (!seen.insert({a, b}).second) continue;
    const Vec3 x =
        prepare::centroid(model.point, model.tetrahedron[static_cast<std::size_t>(pair.a)]);
    const std::string place = fmt::format("near ({:.6g}, {:.6g}, {:.6g}) m", x.x, x.y, x.z);
    const std::string& name = model.groups[static_cast<std::size_t>(a)];
    problems.push_back(
        a == b ? fmt::format("body.{}: two of its tetrahedra overlap {}", name, place)
               : fmt::format("body.{} and body.{} overlap at the start {}; move one of them", name,
                             model.groups[static_cast<std::size_t>(b)], place));
  }
}

/// Vertices of one body that lie at one place: tetrahedra beside them look joined and are not.
void look_for_seams(const Model& model, std::vector<std::string>& problems) {
  std::vector<std::int16_t> group(model.point.size());
  for (std::size_t t = 0; t < model.tetrahedron.size(); ++t)
    for (const Index v : model.tetrahedron[t]) group[static_cast<std::size_t>(v)] = model.group[t];
  std::vector<Index> order(model.point.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](Index v) {
    const Vec3& p = prepare::at(model.point, v);
    return std::tuple(group[static_cast<std::size_t>(v)], p.x, p.y, p.z);
  };
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return key(a) < key(b); });
  std::set<std::int16_t> told;
  for (std::size_t k = 1; k < order.size(); ++k) {
    const std::int16_t body = group[static_cast<std::size_t>(order[k])];
    if (key(order[k]) != key(order[k - 1]) || !told.insert(body).second) continue;
    const Vec3& p = prepare::at(model.point, order[k]);
    problems.push_back(
        fmt::format("body.{}: two vertices lie at one place, ({:.6g}, {:.6g}, {:.6g}) m: "
                    "tetrahedra beside them are not joined; give them one vertex, and cracks a "
                    "[[discontinuity]]",
                    model.groups[static_cast<std::size_t>(body)], p.x, p.y, p.z));
  }
}

}  // namespace
}  // namespace breccia::fdem3

namespace breccia {

fdem3::Model build_model(const fdem3::Config& given, const std::string& case_folder) {
  prepare::refuse(prepare::body_problems(given), "with the model");
  fdem3::Config config = given;
  config.discontinuities = prepare::cracks_with_sets(given, case_folder);
  fdem3::TetAssembly assembly(config, case_folder);
  fdem3::Model& model = assembly.model();
  prepare::order_along_curve(model);
  std::vector<std::uint64_t> grain;
  for (std::size_t b = 0; b < config.bodies.size(); ++b) {
    fdem3::TetBodyInModel body(model, config, b);
    body.give_minerals(grain);
    body.give_strength();
  }
  std::vector<std::string> problems;
  const std::vector<prepare::MeshFace> faces = prepare::faces_of(model.tetrahedron);
  fdem3::crack(model, config, given.discontinuities.size(), faces,
               fdem3::grain_boundaries(model, config, faces, grain), problems);
  fdem3::look_for_overlaps(model, faces, problems);
  fdem3::look_for_seams(model, problems);
  prepare::refuse(problems, "with the model");
  return std::move(model);
}

}  // namespace breccia
