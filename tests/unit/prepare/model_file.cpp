#include "prepare/model_file.hpp"

#include <gtest/gtest.h>

#include "exec/error.hpp"
#include "prepare/build.hpp"
#include "unit/prepare/models.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace model_file_test {

std::string bytes_of(const dem::Model& model, const std::string& path) {
  CheckpointWriter writer;
  save_model(writer, model);
  writer.write(path);
  std::string bytes;
  const CheckpointReader reader(path);
  for (const CheckpointReader::Section& section : reader.sections())
    for (const std::byte b : section.bytes) bytes += static_cast<char>(b);
  return bytes;
}

TEST(ModelFile, GivesBackTheModelThatWasBuilt) {
  const ScratchFolder scratch;
  dem::Config config = dem::small_slab();
  config.materials[0].fabric = "even";
  config.materials[0].stiffness = "measured";
  const dem::Model built = build_model(config, "");
  const std::string bytes = bytes_of(built, scratch / "built.br");
  const CheckpointReader reader(scratch / "built.br");
  ASSERT_TRUE(holds_model(reader));
  const dem::Model read = load_model(reader);
  EXPECT_EQ(read.groups, built.groups);
  EXPECT_EQ(read.position.size(), built.position.size());
  EXPECT_EQ(read.links.size(), built.links.size());
  ASSERT_EQ(read.bulk.size(), 2U);
  EXPECT_NE(read.bulk[0].factor, 1.0);
  EXPECT_NEAR(read.bulk[0].young, 30e9, 1.0);
  EXPECT_EQ(bytes_of(read, scratch / "read.br"), bytes);
}

TEST(ModelFile, GivesBackTheFacetsOfLdpm) {
  const ScratchFolder scratch;
  const dem::Model built = build_model(dem::ldpm_cube(), "");
  const std::string bytes = bytes_of(built, scratch / "built.br");
  const CheckpointReader reader(scratch / "built.br");
  const dem::Model read = load_model(reader);
  ASSERT_EQ(read.facets.size(), built.links.size());
  EXPECT_EQ(read.links.back().facet, static_cast<Index>(read.facets.size()) - 1);
  EXPECT_EQ(bytes_of(read, scratch / "read.br"), bytes);
  dem::Model less = built;
  less.facets.pop_back();
  bytes_of(less, scratch / "bad.br");
  const CheckpointReader bad(scratch / "bad.br");
  EXPECT_THROW(load_model(bad), CheckpointError);
}

TEST(ModelFile, RefusesLinksToElementsThatAreNotThere) {
  const ScratchFolder scratch;
  dem::Model model = build_model(dem::small_slab(), "");
  model.links.back().b = model.size();
  bytes_of(model, scratch / "bad.br");
  const CheckpointReader reader(scratch / "bad.br");
  EXPECT_THROW(load_model(reader), CheckpointError);
}

}  // namespace model_file_test
}  // namespace breccia
