// The commands of the first hour: new, doctor, keys, as people type them.

#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "io/whole_file.hpp"
#include "unit/run/program.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace first_hour_test {

struct FirstHour : testing::Test {
  ScratchFolder folder;
  std::string told;
  int run(const std::string& arguments) {
    const int code =
        wait_for(start_program(arguments, folder / "told.txt", "cd " + folder.path() + ";"));
    told = read_whole_file(folder / "told.txt");
    return code;
  }
  bool says(const std::string& part) const { return told.find(part) != std::string::npos; }
};

TEST_F(FirstHour, every_template_is_a_case_that_passes_check) {
  std::string files;
  for (const char* name : {"beam", "cylinder", "plate", "slope", "disc", "slab", "bar"}) {
    EXPECT_EQ(run(std::string("new ") + name), 0) << told;
    files += std::string(" ") + name + ".toml";
  }
  EXPECT_EQ(run("check" + files), 0) << told;
  std::istringstream lines(told);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << line;
}

TEST_F(FirstHour, the_laboratory_refuses_cases_whose_specimens_it_cannot_make) {
  ASSERT_EQ(run("new bar"), 0) << told;
  for (const char* command : {"test", "calibrate"}) {
    EXPECT_EQ(run(std::string(command) + " bar.toml --material rock"), 2) << told;
    EXPECT_TRUE(says("bar.toml: specimens are made for method = \"dem3d\"")) << told;
  }
}

TEST_F(FirstHour, new_overwrites_nothing_and_lists_what_there_is) {
  EXPECT_EQ(run("new beam sub/mine.toml"), 0) << told;
  EXPECT_TRUE(std::filesystem::exists(folder / "sub/mine.toml"));
  EXPECT_EQ(run("new disc sub/mine.toml"), 2);
  EXPECT_EQ(run("new beem"), 2);
  EXPECT_TRUE(says("did you mean beam?")) << told;
  EXPECT_EQ(run("new"), 0);
  EXPECT_TRUE(says("slope")) << told;
  EXPECT_EQ(run("new --help"), 0);
  EXPECT_TRUE(says("slab, bar")) << told;
}

TEST_F(FirstHour, doctor_tells_cores_memory_programs_and_disk_and_leaves_nothing) {
  EXPECT_EQ(run("doctor"), 0) << told;
  for (const char* word : {"cores", "memory", "MPI", "GPU", "gmsh", "ffmpeg", "paraview", "MB/s"})
    EXPECT_TRUE(says(word)) << word << " in\n" << told;
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path()))
    ++files;
  EXPECT_EQ(files, 1U);  // what it told
}

TEST_F(FirstHour, explain_tells_formula_and_draws_the_law) {
  EXPECT_EQ(run("explain tensile_strength --svg law.svg"), 0) << told;
  EXPECT_TRUE(says("zeta") && says("normal stress [MPa]")) << told;
  const std::string svg = read_whole_file(folder / "law.svg");
  EXPECT_NE(svg.find("2.2"), std::string::npos);  // the strength, on the axis
  EXPECT_EQ(run("explain joint.tension"), 0) << told;
  EXPECT_EQ(run("explain material.my_rock.joint.tension"), 0) << told;
  EXPECT_TRUE(says("G_I")) << told;
  EXPECT_EQ(run("explain rate --svg rate.svg"), 0) << told;
  EXPECT_TRUE(says("Malvar and Ross") && says("log10 of the strain rate in 1/s")) << told;
  EXPECT_NE(read_whole_file(folder / "rate.svg").find("9.43"), std::string::npos);
  EXPECT_EQ(run("explain tensile_strenght"), 2);
}

TEST_F(FirstHour, explain_tells_the_keys_of_a_table) {
  EXPECT_EQ(run("explain in_situ"), 0) << told;
  EXPECT_TRUE(says("[in_situ]  (method fdem2d)") && says("xx_slope = ")) << told;
  EXPECT_TRUE(says("[[stage.material]] in_situ = ")) << told;  // and the key of that name
  EXPECT_EQ(run("explain load"), 0) << told;
  EXPECT_TRUE(says("[[load]]  (method fdem3d)") && says("dug_by")) << told;
  EXPECT_FALSE(says("may be")) << told;
}

TEST_F(FirstHour, keys_are_found_by_words_and_near_words_are_told) {
  EXPECT_EQ(run("keys young"), 0);
  EXPECT_TRUE(says("young = \"30 GPa\"")) << told;
  EXPECT_EQ(run("keys young restitution"), 0);  // no key is about both
  EXPECT_TRUE(says("young = \"30 GPa\"") && says("restitution = ")) << told;
  EXPECT_EQ(run("keys young poisson"), 0);  // those of bedding are about both
  EXPECT_TRUE(says("bedding") && !says("young = \"30 GPa\"")) << told;
  EXPECT_EQ(run("keys friction angle"), 0);
  EXPECT_FALSE(says("spin")) << told;
  EXPECT_EQ(run("keys supprt"), 2);
  EXPECT_TRUE(says("did you mean support?")) << told;
  EXPECT_EQ(run("keys --schema"), 0);
  EXPECT_TRUE(says("json-schema.org")) << told;
}

TEST_F(FirstHour, a_time_to_end_at_may_have_a_unit_and_a_model_any_name) {
  ASSERT_EQ(run("new slab"), 0) << told;
  ASSERT_EQ(run("prepare slab.toml -o model"), 0) << told;
  const std::string go = "run model --force --set output.frames=0 -o out";
  EXPECT_EQ(run(go + " --until 20us"), 0) << told;
  EXPECT_TRUE(read_whole_file(folder / "out/summary.json").find("\"time\": 2.") !=
              std::string::npos);
  EXPECT_EQ(run(go + " --until 20kg"), 2);
  EXPECT_TRUE(says("20kg is no time such as 0.002 (s) or 2ms")) << told;
  EXPECT_EQ(run("render nowhere"), 3);
  EXPECT_TRUE(says("nowhere: cannot be read: there is no such folder")) << told;
}

}  // namespace first_hour_test
}  // namespace breccia
