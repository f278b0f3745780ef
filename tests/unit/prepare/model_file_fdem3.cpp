// Models of tetrahedra on disk.

#include <gtest/gtest.h>

#include "prepare/model_file.hpp"
#include "unit/prepare/fdem3_scenes.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia::fdem3 {
namespace model_file_fdem3_test {

std::string bytes_of(const Model& model, const std::string& path) {
  CheckpointWriter writer;
  save_model(writer, model);
  writer.write(path);
  std::string bytes;
  const CheckpointReader reader(path);
  for (const CheckpointReader::Section& section : reader.sections())
    for (const std::byte b : section.bytes) bytes += static_cast<char>(b);
  return bytes;
}

Model small_model() {
  BodyConfig body = regular_box({0.03, 0.02, 0.02}, 0.01);
  body.weibull = {.modulus = 4.0, .length = 0.0};
  body.velocity = {1.0, 2.0, 3.0};
  Model model = built({body});
  const prepare::MeshFace face = prepare::faces_of(model.tetrahedron).front();
  model.face_sets.push_back({"left", {face.corners}});
  model.discontinuities.push_back({face.corners, -1});
  return model;
}

std::string loading_fails(const Model& model) {
  const ScratchFolder scratch;
  bytes_of(model, scratch / "bad.br");
  const CheckpointReader reader(scratch / "bad.br");
  try {
    load_fdem3_model(reader);
  } catch (const CheckpointError& error) {
    return error.what();
  }
  return "";
}

TEST(ModelFileFdem3, GivesBackTheModelThatWasBuilt) {
  const ScratchFolder scratch;
  const Model model = small_model();
  const std::string bytes = bytes_of(model, scratch / "built.br");
  const CheckpointReader reader(scratch / "built.br");
  ASSERT_TRUE(holds_model(reader));
  const Model read = load_fdem3_model(reader);
  EXPECT_EQ(read.groups, model.groups);
  EXPECT_EQ(read.tetrahedron, model.tetrahedron);
  EXPECT_EQ(read.strength, model.strength);
  ASSERT_EQ(read.face_sets.size(), 1U);
  EXPECT_EQ(read.face_sets[0].name, "left");
  EXPECT_EQ(read.face_sets[0].faces, model.face_sets[0].faces);
  ASSERT_EQ(read.discontinuities.size(), 1U);
  EXPECT_EQ(read.discontinuities[0].material, -1);
  EXPECT_EQ(bytes_of(read, scratch / "read.br"), bytes);
}

TEST(ModelFileFdem3, KindsOfModelsAreToldApart) {
  const ScratchFolder scratch;
  bytes_of(small_model(), scratch / "built.br");
  const CheckpointReader reader(scratch / "built.br");
  EXPECT_THROW(load_fdem_model(reader), CheckpointError);
  EXPECT_THROW(load_model(reader), CheckpointError);
}

TEST(ModelFileFdem3, RefusesModelsThatAreNoModels) {
  EXPECT_EQ(loading_fails(small_model()), "");
  Model model = small_model();
  model.tetrahedron[3][2] = static_cast<Index>(model.point.size());
  EXPECT_TRUE(mentions(loading_fails(model), "has corner"));
  model = small_model();
  std::swap(model.tetrahedron[3][0], model.tetrahedron[3][1]);
  EXPECT_TRUE(mentions(loading_fails(model), "is turned inside out"));
  model = small_model();
  model.strength.pop_back();
  EXPECT_TRUE(mentions(loading_fails(model), "do not fit each other"));
  model = small_model();
  model.group[0] = 1;
  EXPECT_TRUE(mentions(loading_fails(model), "do not fit each other"));
  model = small_model();
  std::swap(model.face_sets[0].faces[0][0], model.face_sets[0].faces[0][1]);
  EXPECT_TRUE(mentions(loading_fails(model), "do not fit each other"));
}

TEST(ModelFileFdem3, RefusesMaterialsThatTheCaseDoesNotHave) {
  Model model = small_model();
  Config config = case_of({});
  refuse_misfits(model, config);
  model.discontinuities[0].material = 1;
  EXPECT_THROW(refuse_misfits(model, config), CheckpointError);
  model = small_model();
  config.materials.clear();
  EXPECT_THROW(refuse_misfits(model, config), CheckpointError);
}

}  // namespace model_file_fdem3_test
}  // namespace breccia::fdem3
