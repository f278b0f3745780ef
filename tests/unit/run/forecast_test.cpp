// What `breccia check` foresees of a run: items, step, time and memory.

#include "run/machine/forecast.hpp"

#include <gtest/gtest.h>

#include "dem/setup/config.hpp"
#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"
#include "io/whole_file.hpp"
#include "paths.hpp"
#include "prepare/build.hpp"
#include "run/case.hpp"
#include "run/method/dem_method.hpp"
#include "unit/run/beam_case.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace forecast_test {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Forecast, of_a_plate_is_near_what_the_model_has) {
  const fdem::Config config = read_case<fdem::Config>(CaseText{beam, "beam.toml"}, {});
  const Forecast f = forecast(config, ".");
  EXPECT_NEAR(f.items, 1109.0, 60.0);  // 0.3 x 0.04 m2 over triangles of 5 mm edges
  EXPECT_NEAR(f.bonds, 1.5 * f.items - 68.0, 1.0);
  EXPECT_NEAR(f.steps, 1e-3 / f.step, 1.0);
  EXPECT_GT(f.here_s, 1e-9 * f.steps * f.items);
  EXPECT_LT(f.here_s, 1e-5 * f.steps * f.items);
  fdem::Config silent = config;
  silent.output.frames = 0;
  silent.output.history = config.time.end;
  EXPECT_GT(f.output_s, 10.0 * forecast(silent, ".").output_s);
  EXPECT_TRUE(has(f.step_rule, "joints") && has(f.step_rule, "5 mm")) << f.step_rule;
}

TEST(Forecast, of_a_file_of_spheres_counts_their_memory_and_packs_nothing) {
  const ScratchFolder folder;
  std::string spheres;
  for (int i = 0; i < 30; ++i)
    for (int j = 0; j < 30; ++j)
      for (int k = 0; k < 30; ++k)
        spheres += std::to_string(0.1 * i) + "," + std::to_string(0.1 * j) + "," +
                   std::to_string(0.1 * k) + ",0.05\n";
  replace_file(folder / "block.csv", spheres);
  const std::string text =
      "method = \"dem3d\"\ntime.end = 1e-3\n[material.c]\nlaw = \"concrete\"\n"
      "[[body]]\nname = \"block\"\nshape = \"file\"\n"
      "file = \"block.csv\"\nvolume = 27.0\nmaterial = \"c\"\n";
  const Forecast f =
      forecast(read_case<dem::Config>(CaseText{text, "block.toml"}, {}), folder.path());
  EXPECT_EQ(f.items, 27000.0);
  EXPECT_GT(f.memory, 27000.0 * 2000.0);
  EXPECT_LT(f.setup_s, 1.0);
}

/// So few elements that no specimen is packed: they are looked at as they are.
TEST(Forecast, of_single_elements_and_short_files_is_the_step_of_their_run) {
  const ScratchFolder folder;
  replace_file(folder / "two.csv", "0,0,0,0.01\n0,0,0.02,0.01\n");
  const std::string start =
      "method = \"dem3d\"\ntime.end = 1e-4\n[material.g]\nlaw = \"grain\"\n"
      "young = \"70 GPa\"\n[material.p]\nlaw = \"parallel\"\n[[body]]\n";
  const std::string ball =
      "name = \"ball\"\nshape = \"element\"\nmaterial = \"g\"\nradius = 0.01\n";
  const std::string two =
      "name = \"two\"\nshape = \"file\"\nfile = \"two.csv\"\nvolume = 1e-5\n"
      "center = [1.0, 0.0, 0.0]\nmaterial = \"p\"\n";
  for (const std::string& bodies : {ball, two, ball + "[[body]]\n" + two}) {
    const auto config = read_case<dem::Config>(CaseText{start + bodies, "few.toml"}, {});
    const Forecast f = forecast(config, folder.path());
    const auto run = make_method(config, build_model(config, folder.path()), Exec{});
    EXPECT_NEAR(f.step / run->time_step(), 1.0, 1e-9) << bodies;
    EXPECT_NEAR(f.steps, config.time.end / f.step, 1.0);
    EXPECT_FALSE(has(f.step_rule, "max_step")) << f.step_rule;
  }
}

TEST(Forecast, of_a_union_counts_what_is_left_of_the_box_around_it) {
  const auto config = read_case<dem::Config>(
      CaseText{"method = \"dem3d\"\ntime.end = 1e-4\n[material.c]\nlaw = \"concrete\"\n[[body]]\n"
               "name = \"tee\"\nmaterial = \"c\"\nsize = [0.4, 0.06, 0.12]\npack.count = 1500\n"
               "[[body.join]]\ncenter = [0.0, 0.0, 0.08]\nsize = [0.4, 0.16, 0.04]\n",
               "tee.toml"},
      {});
  const dem::Model model = build_model(config, ".");
  const Forecast f = forecast(config, ".");
  EXPECT_NEAR(f.items, static_cast<double>(model.size()), 0.05 * f.items);
  EXPECT_NEAR(f.bonds, static_cast<double>(model.links.size()), 0.1 * f.bonds);
}

TEST(Forecast, of_tetrahedra_of_a_file_counts_what_the_file_holds) {
  const std::string folder = std::string(source_dir) + "/cases/moving_box_3d";
  const Case read = load_case(folder + "/small.toml", {});
  const auto& config = std::get<fdem3::Config>(read.config);
  const Forecast f = forecast(config, folder);
  EXPECT_NEAR(f.items, 6.0 * 125.0 + 3.0 * 486.0, 1.0);  // 125 cubes, three plates
  EXPECT_GT(f.steps, 1000.0);
}

TEST(Forecast, half_the_mesh_size_is_four_times_the_triangles_and_half_the_step) {
  fdem::Config config = read_case<fdem::Config>(CaseText{beam, "beam.toml"}, {});
  const Forecast coarse = forecast(config, ".");
  config.bodies.front().mesh_size *= 0.5;
  const Forecast fine = forecast(config, ".");
  EXPECT_NEAR(fine.items / coarse.items, 4.0, 1e-9);
  EXPECT_NEAR(coarse.step / fine.step, 2.0, 0.1);
}

TEST(Forecast, of_concrete_by_its_grains_is_near_what_the_model_has) {
  const std::string path = std::string(source_dir) + "/cases/ldpm_cube/small.toml";
  dem::Config config = read_case<dem::Config>(path, {});
  config.bodies.front().size = {0.12, 0.1, 0.05};  // more than a specimen
  const Forecast f = forecast(config, ".");
  const dem::Model model = build_model(config, ".");
  EXPECT_NEAR(f.items / model.size(), 1.0, 0.06);
  EXPECT_NEAR(f.bonds / static_cast<double>(model.links.size()), 1.0, 0.06);
  EXPECT_NEAR(f.step, 0.69e-6, 0.1e-6);
  EXPECT_GT(f.memory, 400.0 * f.bonds);
  EXPECT_EQ(f.gpu_s, 0.0);
}

TEST(Forecast, counts_the_tests_for_a_fracture_energy_and_the_programs_own_memory) {
  const std::string path = std::string(source_dir) + "/cases/dog_bone/small.toml";
  const std::string folder = std::string(source_dir) + "/cases/dog_bone";
  dem::Config config = read_case<dem::Config>(path, {});
  const Forecast f = forecast(config, folder);
  for (dem::MaterialConfig& m : config.materials) m.fracture_energy = 0.0;
  const Forecast without = forecast(config, folder);
  EXPECT_GT(f.setup_s, 5.0 * without.setup_s);
  EXPECT_EQ(f.step, without.step);
  EXPECT_GT(f.memory, 30e6);
  EXPECT_FALSE(f.may_end_early);
}

TEST(Forecast, ends_with_the_last_of_stages_that_end_by_time_and_says_when_others_may_end_early) {
  const std::string folder = std::string(source_dir) + "/cases/dfn_slope";
  auto config = read_case<fdem::Config>(folder + "/small.toml", {});
  ASSERT_EQ(config.time.end, 5.0);
  const Forecast by_time = forecast(config, folder);
  EXPECT_NEAR(by_time.steps, 0.8 / by_time.step, 1.0);  // stages of 0.3, 0.2 and 0.3 s
  EXPECT_FALSE(by_time.may_end_early);
  config.stages.back().until = 0.0;
  EXPECT_NEAR(forecast(config, folder).steps, 5.0 / by_time.step, 1.0);
  config.stages.front().rest = 1e-5;
  EXPECT_TRUE(forecast(config, folder).may_end_early);
}

/// The smallest triangle between lines rules their mesh, which specimens have none of.
TEST(Forecast, of_lines_in_a_free_mesh_is_a_bound_until_a_model_tells_its_step) {
  const std::string folder = std::string(source_dir) + "/cases/dfn_slope";
  auto config = read_case<fdem::Config>(folder + "/small.toml", {});
  const Forecast before = forecast(config, folder);
  EXPECT_TRUE(before.cut_by_lines);
  EXPECT_FALSE(before.of_model);
  const Forecast f = forecast(config, folder, {33.4e-6, "contact"});
  EXPECT_EQ(f.step, 33.4e-6);
  EXPECT_TRUE(has(f.step_rule, "contact of the model")) << f.step_rule;
  EXPECT_NEAR(f.steps, 0.8 / 33.4e-6, 1.0);
  EXPECT_GT(f.here_s, 2.0 * before.here_s);
  EXPECT_GT(f.gpu_s, 2.0 * before.gpu_s);
  EXPECT_FALSE(f.cut_by_lines);
  config.joint_sets.clear();
  EXPECT_FALSE(forecast(config, folder).cut_by_lines);
  config.discontinuities.resize(2);
  EXPECT_TRUE(forecast(config, folder).cut_by_lines);
  const std::string prism = std::string(source_dir) + "/cases/jointed_prism";
  auto solid = read_case<fdem3::Config>(prism + "/small.toml", {});
  EXPECT_TRUE(forecast(solid, prism).cut_by_lines);
  EXPECT_EQ(forecast(solid, prism, {0.2e-6, "joints"}).step, 0.2e-6);
  solid.bodies.front().structured = true;
  EXPECT_FALSE(forecast(solid, prism).cut_by_lines);
}

TEST(Forecast, of_spheres_takes_the_step_of_their_model) {
  const std::string path = std::string(source_dir) + "/cases/ldpm_cube/small.toml";
  const auto config = read_case<dem::Config>(path, {});
  const Forecast f = forecast(config, ".", {0.5e-6, ""});
  EXPECT_EQ(f.step, 0.5e-6);
  EXPECT_EQ(f.step_rule, "elements of the model as it is set up");
  EXPECT_NEAR(f.steps, config.time.end / 0.5e-6, 1.0);
}

/// Whatever its joints meet: the specimen that is timed has none of them.
TEST(Forecast, of_a_set_of_joints_in_space_does_not_depend_on_where_they_lie) {
  const std::string folder = std::string(source_dir) + "/cases/jointed_prism";
  auto config = read_case<fdem3::Config>(folder + "/small.toml", {});
  const double step = forecast(config, folder).step;
  config.seed = 2;
  EXPECT_EQ(forecast(config, folder).step, step);
}

TEST(Forecast, memory_follows_the_pixels_of_the_pictures) {
  fdem::Config config = read_case<fdem::Config>(CaseText{beam, "beam.toml"}, {});
  config.output.frames = 4;
  const double as_low_as_the_beam = forecast(config, ".").memory;
  config.output.height = 960;
  EXPECT_NEAR(forecast(config, ".").memory - as_low_as_the_beam, 98.0 * 1280.0 * (960 - 358), 1e6);
  config.output.pictures = false;
  EXPECT_LT(forecast(config, ".").memory, as_low_as_the_beam - 40e6);
}

}  // namespace forecast_test
}  // namespace breccia
