#include "prepare/model_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "dem/setup/model_arrays.hpp"
#include "exec/error.hpp"
#include "exec/plain_vector.hpp"
#include "prepare/meshing/mesh_check.hpp"
#include "prepare/model_sections.hpp"

namespace breccia {
namespace {

using namespace model_sections;

/// Links by member, so that no padding reaches the file.
struct LinkArrays {
  PlainVector<Index> a, b;
  PlainVector<std::uint8_t> kind;
  PlainVector<std::int16_t> material;
  PlainVector<double> share;
  PlainVector<std::uint8_t> parted;
  PlainVector<double> strength;  ///< empty: 1

  void resize(std::size_t count) {
    for (PlainVector<Index>* end : {&a, &b}) end->resize(count);
    for (PlainVector<std::uint8_t>* byte : {&kind, &parted}) byte->resize(count);
    for (PlainVector<double>* number : {&share, &strength}) number->resize(count);
    material.resize(count);
  }
};

template <class Arrays, class Visit>
void each_link_array(Arrays& links, Visit&& array) {
  array("link_a", links.a);
  array("link_b", links.b);
  array("link_kind", links.kind);
  array("link_material", links.material);
  array("link_share", links.share);
  array("link_parted", links.parted);
}

/// Facets of LDPM by member, likewise.
struct FacetArrays {
  std::vector<std::array<Index, 4>> corners;
  std::vector<Vec3> center;
  std::vector<double> area;
};

template <class T, class Memory>
void load_into(std::vector<T, Memory>& items, const CheckpointReader& reader,
               const std::string& name) {
  items = load_array<T, Memory>(reader, name);
}

std::string wall_mesh_name(std::size_t k) {
  return "wall_mesh." + std::to_string(k);
}

void refuse_misfits(const dem::Model& model) {
  const auto fail = [] {
    throw CheckpointError("the model's elements and links do not fit each other");
  };
  each_element_array(model, [&](const char*, const auto& items) {
    if (items.size() != model.position.size()) fail();
  });
  each_element_number(model, [&](Index number, int least) {
    if (number < least || number >= model.size()) fail();
  });
  const dem::Model::Link* before = nullptr;
  for (const dem::Model::Link& link : model.links) {
    if (link.a >= link.b || static_cast<std::size_t>(link.kind) >= dem::link_kinds) fail();
    if (before != nullptr && std::tie(link.a, link.b) < std::tie(before->a, before->b)) fail();
    before = &link;
  }
  std::size_t facets = 0;
  for (const dem::Model::Link& link : model.links)
    if (link.kind == dem::LinkKind::ldpm) ++facets;
  if (facets != model.facets.size()) fail();
  if (!model.bulk.empty() && model.bulk.size() != model.groups.size()) fail();
  const auto groups = static_cast<std::int16_t>(model.groups.size());
  if (std::any_of(model.group.begin(), model.group.end(),
                  [&](std::int16_t g) { return g < 0 || g >= groups; }))
    fail();
}

/// Every array of a model of triangles that holds plain items.
template <class Model, class Visit>
void each_triangle_array(Model& model, Visit&& array) {
  array("point", model.point);
  array("triangle", model.triangle);
  array("group", model.group);
  array("material", model.material);
  array("velocity", model.velocity);
  array("strength", model.strength);
}

/// Discontinuities by member, so that no padding reaches the file.
struct DiscontinuityArrays {
  std::vector<std::array<Index, 2>> edge;
  std::vector<std::int16_t> material;
};

void refuse_misfits(const fdem::Model& model) {
  const auto fail = [] {
    throw CheckpointError("the model's triangles and vertices do not fit each other");
  };
  each_triangle_array(model, [&](const char* name, const auto& items) {
    if (std::string(name) != "point" && items.size() != model.triangle.size()) fail();
  });
  const auto points = static_cast<Index>(model.point.size());
  const auto is_point = [&](Index i) { return i >= 0 && i < points; };
  for (const auto& corners : model.triangle)
    if (!std::all_of(corners.begin(), corners.end(), is_point)) fail();
  for (const fdem::Model::EdgeSet& set : model.edge_sets)
    for (const auto& edge : set.edges)
      if (!is_point(edge[0]) || !is_point(edge[1])) fail();
  const prepare::Mesh mesh{
      .point = model.point, .triangle = model.triangle, .parts = {}, .edge_sets = {}};
  const auto problems = prepare::mesh_problems(mesh, prepare::plain_names(), 1);
  if (!problems.empty()) throw CheckpointError("the model's mesh: " + problems.front());
  for (const fdem::Model::Discontinuity& d : model.discontinuities)
    if (!is_point(d.edge[0]) || !is_point(d.edge[1])) fail();
  const auto groups = static_cast<std::int16_t>(model.groups.size());
  if (std::any_of(model.group.begin(), model.group.end(),
                  [&](std::int16_t g) { return g < 0 || g >= groups; }))
    fail();
}

}  // namespace

void save_model(CheckpointWriter& writer, const fdem::Model& model) {
  writer.text("model.groups", lines_of(model.groups));
  each_triangle_array(
      model, [&](const char* name, const auto& items) { save_array(writer, name, items); });
  std::vector<std::string> names;
  for (const fdem::Model::EdgeSet& set : model.edge_sets) {
    save_array(writer, "edges." + std::to_string(names.size()), set.edges);
    names.push_back(set.name);
  }
  writer.text("model.edge_sets", lines_of(names));
  DiscontinuityArrays discontinuities;
  for (const fdem::Model::Discontinuity& d : model.discontinuities) {
    discontinuities.edge.push_back(d.edge);
    discontinuities.material.push_back(d.material);
  }
  save_array(writer, "discontinuity_edge", discontinuities.edge);
  save_array(writer, "discontinuity_material", discontinuities.material);
}

fdem::Model load_fdem_model(const CheckpointReader& reader) {
  fdem::Model model;
  model.groups = lines_in(reader.text("model.groups"));
  each_triangle_array(model, [&](const char* array, auto& items) {
    items =
        load_array<typename std::remove_reference_t<decltype(items)>::value_type>(reader, array);
  });
  for (const std::string& name : lines_in(reader.text("model.edge_sets")))
    model.edge_sets.push_back(
        {name, load_array<std::array<Index, 2>>(
                   reader, "edges." + std::to_string(model.edge_sets.size()))});
  const auto edges = load_array<std::array<Index, 2>>(reader, "discontinuity_edge");
  const auto materials = load_array<std::int16_t>(reader, "discontinuity_material");
  if (edges.size() != materials.size())
    throw CheckpointError("the model's discontinuities are not whole");
  for (std::size_t i = 0; i < edges.size(); ++i)
    model.discontinuities.push_back({edges[i], materials[i]});
  refuse_misfits(model);
  return model;
}

void save_model(CheckpointWriter& writer, const dem::Model& model) {
  writer.text("model.groups", lines_of(model.groups));
  writer.value("model.interaction_range", model.interaction_range);
  save_array(writer, "bulk", model.bulk);
  each_element_array(model,
                     [&](const char* name, const auto& items) { save_array(writer, name, items); });
  LinkArrays links;
  links.resize(model.links.size());
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const dem::Model::Link& link = model.links[i];
    links.a[i] = link.a;
    links.b[i] = link.b;
    links.kind[i] = static_cast<std::uint8_t>(link.kind);
    links.material[i] = link.material;
    links.share[i] = link.share;
    links.parted[i] = link.parted ? 1 : 0;
    links.strength[i] = link.strength;
  }
  each_link_array(links,
                  [&](const char* name, const auto& items) { save_array(writer, name, items); });
  const auto weaker = [](double strength) { return strength != 1.0; };
  if (std::any_of(links.strength.begin(), links.strength.end(), weaker))
    save_array(writer, "link_strength", links.strength);
  for (std::size_t k = 0; k < model.wall_meshes.size(); ++k)
    save_array(writer, wall_mesh_name(k), model.wall_meshes[k]);
  if (model.facets.empty()) return;
  FacetArrays facets;
  for (const dem::Model::Facet& f : model.facets) {
    facets.corners.push_back({f.a, f.b, f.c, f.d});
    facets.center.push_back(f.center);
    facets.area.push_back(f.area);
  }
  save_array(writer, "facet_corners", facets.corners);
  save_array(writer, "facet_center", facets.center);
  save_array(writer, "facet_area", facets.area);
}

void refuse_misfits(const dem::Model& model, const dem::Config& config) {
  refuse_unknown("material", model.material, 0, config.materials.size());
  std::vector<std::int16_t> laws;
  for (const dem::Model::Link& link : model.links) laws.push_back(link.material);
  refuse_unknown("link_material", laws, 0, config.materials.size());
  const auto has_file = [](const dem::WallConfig& wall) { return wall.shape == "stl"; };
  if (static_cast<std::size_t>(std::count_if(config.walls.begin(), config.walls.end(), has_file)) !=
      model.wall_meshes.size())
    throw CheckpointError("the model has not the triangles of the case's walls");
}

void refuse_misfits(const fdem::Model& model, const fdem::Config& config) {
  refuse_unknown("material", model.material, 0, config.materials.size());
  std::vector<std::int16_t> laws;
  for (const fdem::Model::Discontinuity& d : model.discontinuities) laws.push_back(d.material);
  refuse_unknown("discontinuity_material", laws, fdem::Model::as_one, config.joint_laws.size());
}

bool holds_model(const CheckpointReader& reader) {
  return reader.has("model.position") || reader.has("model.triangle") ||
         reader.has("model.tetrahedron") || reader.has("spheres.model.position");
}

dem::Model load_model(const CheckpointReader& reader) {
  dem::Model model;
  model.groups = lines_in(reader.text("model.groups"));
  model.interaction_range = reader.value<double>("model.interaction_range");
  model.bulk = load_array<dem::Model::Bulk>(reader, "bulk");
  each_element_array(model,
                     [&](const char* array, auto& items) { load_into(items, reader, array); });
  LinkArrays links;
  each_link_array(links, [&](const char* array, auto& items) { load_into(items, reader, array); });
  if (reader.has("model.link_strength")) load_into(links.strength, reader, "link_strength");
  if (links.b.size() != links.a.size() || links.kind.size() != links.a.size() ||
      links.material.size() != links.a.size() || links.share.size() != links.a.size() ||
      links.parted.size() != links.a.size() ||
      (!links.strength.empty() && links.strength.size() != links.a.size()))
    throw CheckpointError("the model's links are not whole");
  Index facet = 0;
  model.links.resize(links.a.size());
  for (std::size_t i = 0; i < links.a.size(); ++i) {
    const auto kind = static_cast<dem::LinkKind>(links.kind[i]);
    model.links[i] = {links.a[i],
                      links.b[i],
                      kind,
                      links.material[i],
                      links.share[i],
                      kind == dem::LinkKind::ldpm ? facet++ : -1,
                      links.parted[i] != 0,
                      links.strength.empty() ? 1.0 : links.strength[i]};
  }
  while (reader.has("model." + wall_mesh_name(model.wall_meshes.size())))
    model.wall_meshes.push_back(load_array<Vec3>(reader, wall_mesh_name(model.wall_meshes.size())));
  if (reader.has("model.facet_area")) {
    const auto corners = load_array<std::array<Index, 4>>(reader, "facet_corners");
    const auto center = load_array<Vec3>(reader, "facet_center");
    const auto area = load_array<double>(reader, "facet_area");
    if (corners.size() != area.size() || center.size() != area.size())
      throw CheckpointError("the model's facets are not whole");
    for (std::size_t k = 0; k < area.size(); ++k) {
      const auto& c = corners[k];
      model.facets.push_back({c[0], c[1], c[2], c[3], center[k], area[k]});
    }
  }
  refuse_misfits(model);
  return model;
}

}  // namespace breccia
