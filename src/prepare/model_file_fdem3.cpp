#include <algorithm>

#include "exec/error.hpp"
#include "prepare/model_file.hpp"
#include "prepare/model_sections.hpp"
#include "prepare/tetrahedra/tet_check.hpp"

namespace breccia {
namespace fdem3 {
namespace {

using namespace model_sections;

/// Every array of a model that holds plain items, the vertices first.
template <class SomeModel, class Visit>
void each_tet_array(SomeModel& model, Visit&& array) {
  array("point", model.point);
  array("tetrahedron", model.tetrahedron);
  array("group", model.group);
  array("material", model.material);
  array("velocity", model.velocity);
  array("strength", model.strength);
}

/// Discontinuities by member, so that no padding reaches the file.
struct CrackArrays {
  std::vector<prepare::Face> face;
  std::vector<std::int16_t> material;
};

void refuse_broken(const Model& model) {
  const auto fail = [] {
    throw CheckpointError("the model's tetrahedra and vertices do not fit each other");
  };
  each_tet_array(model, [&](const char* name, const auto& items) {
    if (std::string(name) != "point" && items.size() != model.tetrahedron.size()) fail();
  });
  const prepare::TetMesh mesh{
      .point = model.point, .tetrahedron = model.tetrahedron, .volumes = {}, .face_sets = {}};
  const auto problems = prepare::mesh_problems(mesh, prepare::plain_tet_names(), 1);
  if (!problems.empty()) throw CheckpointError("the model's mesh: " + problems.front());
  const auto points = static_cast<Index>(model.point.size());
  const auto is_face = [&](const prepare::Face& f) {
    return f[0] >= 0 && f[0] < f[1] && f[1] < f[2] && f[2] < points;
  };
  for (const Model::FaceSet& set : model.face_sets)
    if (!std::all_of(set.faces.begin(), set.faces.end(), is_face)) fail();
  for (const Model::Discontinuity& d : model.discontinuities)
    if (!is_face(d.face)) fail();
  const auto groups = static_cast<std::int16_t>(model.groups.size());
  if (std::any_of(model.group.begin(), model.group.end(),
                  [&](std::int16_t g) { return g < 0 || g >= groups; }))
    fail();
}

}  // namespace
}  // namespace fdem3

void save_model(CheckpointWriter& writer, const fdem3::Model& model) {
  using namespace model_sections;
  writer.text("model.groups", lines_of(model.groups));
  fdem3::each_tet_array(
      model, [&](const char* name, const auto& items) { save_array(writer, name, items); });
  std::vector<std::string> names;
  for (const fdem3::Model::FaceSet& set : model.face_sets) {
    save_array(writer, "faces." + std::to_string(names.size()), set.faces);
    names.push_back(set.name);
  }
  writer.text("model.face_sets", lines_of(names));
  fdem3::CrackArrays cracks;
  for (const fdem3::Model::Discontinuity& d : model.discontinuities) {
    cracks.face.push_back(d.face);
    cracks.material.push_back(d.material);
  }
  save_array(writer, "discontinuity_face", cracks.face);
  save_array(writer, "discontinuity_material", cracks.material);
}

fdem3::Model load_fdem3_model(const CheckpointReader& reader) {
  using namespace model_sections;
  fdem3::Model model;
  model.groups = lines_in(reader.text("model.groups"));
  fdem3::each_tet_array(model, [&](const char* array, auto& items) {
    items =
        load_array<typename std::remove_reference_t<decltype(items)>::value_type>(reader, array);
  });
  for (const std::string& name : lines_in(reader.text("model.face_sets")))
    model.face_sets.push_back(
        {name,
         load_array<prepare::Face>(reader, "faces." + std::to_string(model.face_sets.size()))});
  const auto faces = load_array<prepare::Face>(reader, "discontinuity_face");
  const auto materials = load_array<std::int16_t>(reader, "discontinuity_material");
  if (faces.size() != materials.size())
    throw CheckpointError("the model's discontinuities are not whole");
  for (std::size_t i = 0; i < faces.size(); ++i)
    model.discontinuities.push_back({faces[i], materials[i]});
  fdem3::refuse_broken(model);
  return model;
}

void refuse_misfits(const fdem3::Model& model, const fdem3::Config& config) {
  using namespace model_sections;
  refuse_unknown("material", model.material, 0, config.materials.size());
  std::vector<std::int16_t> laws;
  for (const fdem3::Model::Discontinuity& d : model.discontinuities) laws.push_back(d.material);
  refuse_unknown("discontinuity_material", laws, -1, config.joint_laws.size());
}

}  // namespace breccia
