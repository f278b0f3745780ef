// Checkpoints and models whose digests are right and whose content is not: `.br` files are passed
// on, and what they hold must lead nowhere but to where something is.

#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "prepare/build.hpp"
#include "prepare/build_fdem.hpp"
#include "prepare/model_file.hpp"
#include "run/case_keys.hpp"
#include "run/method/dem_method.hpp"
#include "run/method/fdem_method.hpp"
#include "unit/prepare/models.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace forged_test {

/// A reinforced slab, a ball that lies in a wall and on the slab, a support that moves.
dem::Config dem_case() {
  dem::Config config = dem::small_slab();
  dem::BodyConfig ball = dem::sphere_body("ball", {0.0, 0.0, 0.075}, 0.02, 20, 0.35);
  ball.material = "gravel";  // grains, which nothing links, are in contact
  config.bodies.push_back(ball);
  dem::WallConfig wall;
  wall.name = "floor";
  wall.point = {0.0, 0.0, -0.05};
  wall.normal = {0.0, 0.0, 1.0};
  config.walls = {wall};
  dem::SupportConfig support;
  support.name = "pulled";
  support.on = "slab";
  support.max.x = -0.14;
  support.velocity = {-1.0, 0.0, 0.0};
  config.supports = {support};
  config.time.end = 1.0;
  return config;
}

/// Two plates that are pressed together, one with a vein.
const CaseText fdem_text{R"(
method = "fdem2d"
time.end = 1.0
[material.rock]
young = "30 GPa"
joint = { tension = "3 MPa", energy_open = 1.0 }
[joint.vein]
strength = { tension = "1 MPa", energy_open = 1.0 }
[[body]]
name = "low"
material = "rock"
size = ["8 mm", "8 mm"]
mesh_size = "2 mm"
structured = true
[[body]]
name = "high"
material = "rock"
size = ["8 mm", "8 mm"]
center = [0.0, "8.01 mm"]
mesh_size = "2 mm"
structured = true
velocity = [0.0, -5.0]
[[discontinuity]]
name = "vein"
points = [["-4 mm", "0 mm"], ["4 mm", "0 mm"]]
kind = "cohesive"
material = "vein"
embedded = false
[[support]]
name = "down"
on = "low"
max = [1.0, "-3.9 mm"]
velocity = [0.0, 0.0]
)",
                         "plates"};

using Sections = std::vector<CheckpointReader::Section>;

/// Writes the sections of a file anew, with right digests, after a change to one of them.
void forge(const std::string& from, const std::string& to, const std::string& name,
           const std::function<void(std::vector<std::byte>&)>& change) {
  const CheckpointReader reader(from);
  CheckpointWriter writer;
  for (const CheckpointReader::Section& s : reader.sections()) {
    std::vector<std::byte> bytes(s.bytes.begin(), s.bytes.end());
    if (s.name == name) change(bytes);
    writer.section(s.name, bytes.data(), bytes.size() / s.item_bytes, s.item_bytes);
  }
  writer.write(to);
}

/// A number of `width` bytes at a place.
void put(std::vector<std::byte>& bytes, std::size_t at, std::size_t width, std::int64_t number) {
  std::memcpy(bytes.data() + at, &number, width);
}

/// Puts numbers that lead nowhere into the first, the middle and the last item of a section, one at
/// a time, and counts the loads that do not refuse them.
template <class Load>
void expect_refusals(const std::string& good, const std::string& bad, const std::string& name,
                     std::size_t width, const Load& load) {
  const CheckpointReader reader(good);
  const std::size_t size = reader.section(name).bytes.size();
  ASSERT_GE(size, width) << name << " is empty: the test tests nothing";
  std::vector<std::int64_t> numbers{-7, width == 1 ? 200 : 30'000};
  if (width > 2) numbers.push_back(0x7fffffff);
  if (width > 4) numbers.push_back(std::int64_t{1} << 40);
  const std::size_t last = size - width, middle = size / 2 / width * width;
  for (const std::size_t at : {std::size_t{0}, std::min(middle, last), last})
    for (const std::int64_t number : numbers) {
      forge(good, bad, name, [&](std::vector<std::byte>& b) { put(b, at, width, number); });
      EXPECT_THROW(load(CheckpointReader(bad)), CheckpointError)
          << name << ", byte " << at << ": " << number;
    }
}

struct Field {
  const char* name;
  std::size_t width;
};

template <class Make>
void forge_each(const Make& make, const std::vector<Field>& fields,
                const std::vector<const char*>& sized) {
  const ScratchFolder folder;
  const std::string good = folder / "good.br", bad = folder / "bad.br";
  {
    const std::unique_ptr<Method> method = make();
    for (int n = 0; n < 30; ++n) method->advance({1.0, 1'000'000});
    CheckpointWriter writer;
    method->save(writer);
    writer.write(good);
  }
  const auto load = [&](const CheckpointReader& reader) { make()->load(&reader); };
  EXPECT_NO_THROW(load(CheckpointReader(good)));
  for (const Field& f : fields) expect_refusals(good, bad, f.name, f.width, load);
  for (const char* name : sized) {
    forge(good, bad, name, [](std::vector<std::byte>& bytes) { bytes.clear(); });
    EXPECT_THROW(load(CheckpointReader(bad)), CheckpointError) << name << " is empty";
  }
}

TEST(Forged, dem_checkpoints_are_refused) {
  const dem::Config config = dem_case();
  const dem::Model model = build_model(config, "");
  forge_each([&] { return make_method(config, model, Exec{}, nullptr); },
             {{"elements.id", 4},
              {"elements.group", 2},
              {"elements.material", 2},
              {"elements.motion", 2},
              {"concrete.a", 4},
              {"concrete.b", 4},
              {"steel.a", 4},
              {"steel.b", 4},
              {"interface.a", 4},
              {"interface.b", 4},
              {"interface.before", 4},
              {"interface.after", 4},
              {"contacts.a", 4},
              {"contacts.b", 4},
              {"contacts.key", 8},
              {"wall_contacts.a", 4},
              {"wall_contacts.b", 4},
              {"wall_contacts.key", 8}},
             {"elements.id", "concrete.a", "contacts.a", "travel.margin"});
}

TEST(Forged, fdem_checkpoints_are_refused) {
  const auto config = read_case<fdem::Config>(fdem_text, {});
  const fdem::Model model = build_fdem_model(config.bodies, config.discontinuities,
                                             {{"rock"}, {"vein"}}, config.seed, "");
  forge_each([&] { return make_method(config, model, Exec{}, nullptr); },
             {{"triangles.id", 4},
              {"triangles.group", 2},
              {"triangles.material", 4},
              {"triangles.hold", 4},
              {"joints.edge_a", 4},
              {"joints.edge_b", 4},
              {"joints.law", 4},
              {"joints.stage", 1},
              {"couples.a", 4},
              {"couples.b", 4},
              {"couples.key", 8},
              {"reach.triangle", 4}},
             {"changed.flags", "exposed.vertex", "joint_force.force", "triangles.id"});
}

TEST(Forged, dem_models_are_refused) {
  const ScratchFolder folder;
  const dem::Config config = dem_case();
  CheckpointWriter writer;
  save_model(writer, build_model(config, ""));
  writer.write(folder / "good.br");
  const auto load = [&](const CheckpointReader& reader) {
    refuse_misfits(load_model(reader), config);
  };
  EXPECT_NO_THROW(load(CheckpointReader(folder / "good.br")));
  for (const auto& [name, width] : {Field{"model.group", 2},
                                    {"model.material", 2},
                                    {"model.bar_previous", 4},
                                    {"model.bar_next", 4},
                                    {"model.link_a", 4},
                                    {"model.link_b", 4},
                                    {"model.link_kind", 1},
                                    {"model.link_material", 2}})
    expect_refusals(folder / "good.br", folder / "bad.br", name, width, load);
}

TEST(Forged, fdem_models_are_refused) {
  const ScratchFolder folder;
  const auto config = read_case<fdem::Config>(fdem_text, {});
  CheckpointWriter writer;
  save_model(writer, build_fdem_model(config.bodies, config.discontinuities, {{"rock"}, {"vein"}},
                                      config.seed, ""));
  writer.write(folder / "good.br");
  const auto load = [&](const CheckpointReader& reader) {
    refuse_misfits(load_fdem_model(reader), config);
  };
  EXPECT_NO_THROW(load(CheckpointReader(folder / "good.br")));
  for (const auto& [name, width] : {Field{"model.triangle", 4},
                                    {"model.group", 2},
                                    {"model.material", 2},
                                    {"model.discontinuity_edge", 4},
                                    {"model.discontinuity_material", 2}})
    expect_refusals(folder / "good.br", folder / "bad.br", name, width, load);
}

}  // namespace forged_test
}  // namespace breccia
