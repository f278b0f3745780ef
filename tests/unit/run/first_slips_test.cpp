// Slips of a first case: what a reader of cases says of them, and of nothing else.

#include <gtest/gtest.h>

#include "io/case/units.hpp"
#include "io/whole_file.hpp"
#include "unit/run/program.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace first_slips_test {

constexpr const char* plate = R"(breccia = 1
method = "fdem2d"
[time]
end = "1 us"
[material.rock]
density = 2600.0
young = "30 GPa"
[[body]]
name = "rock"
shape = "plate"
material = "rock"
size = ["10 mm", "10 mm"]
mesh_size = "4 mm"
)";

std::string said_of(std::string text, const std::string& from, const std::string& to) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/plate.toml", output = folder.path() + "/said.txt";
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  replace_file(path, text);
  EXPECT_EQ(wait_for(start_program("check " + path, output)), 2);
  return read_whole_file(output);
}

TEST(FirstSlips, in_the_method_are_told_alone) {
  const std::string said = said_of(plate, "\"fdem2d\"", "\"fdem\"");
  EXPECT_NE(said.find("error: 1 problem"), std::string::npos) << said;
  EXPECT_NE(said.find("line 2, method = \"fdem\" is not one of dem3d | fdem2d | fdem3d"),
            std::string::npos)
      << said;
}

TEST(FirstSlips, of_degrees_taken_for_radians_are_told) {
  const std::string set =
      "[[joint_set]]\nname = \"set\"\nmin = [0.0, 0.0]\n"
      "max = [\"10 mm\", \"10 mm\"]\nintensity = 100.0\nlength = \"5 mm\"\n";
  const std::string said = said_of(plate + set + "angle = 30.0\n", "", "");
  EXPECT_NE(said.find("angle = 30 is outside [-6.3, 6.3] rad; did you mean \"30 deg\"?"),
            std::string::npos)
      << said;
}

TEST(FirstSlips, of_moduli_and_densities_without_their_units_are_told) {
  const auto said_with = [](const char* key, const char* value) {
    std::string text = plate;
    const std::size_t at = text.find(std::string(key) + " = ");
    text.replace(at, text.find('\n', at) - at, std::string(key) + " = " + value);
    return said_of(text, "", "");
  };
  const std::string young = said_with("young", "83.1"), none = said_with("density", "0.0"),
                    high = said_with("young", "1e16");
  EXPECT_NE(young.find("young = 83.1 is outside [1000, 1e+15] Pa; did you mean \"83.1 GPa\"?"),
            std::string::npos)
      << young;
  EXPECT_NE(none.find("density = 0 is outside"), std::string::npos) << none;
  EXPECT_EQ(none.find("did you mean"), std::string::npos) << none;
  EXPECT_EQ(high.find("did you mean"), std::string::npos) << high;
  const Range of_spheres{10.0, 1e6};
  EXPECT_EQ(meant_with_unit("2.4", "kg/m3", of_spheres), "; did you mean \"2.4 g/cm3\"?");
  EXPECT_EQ(meant_with_unit("0.001", "kg/m3", of_spheres), "");
  EXPECT_EQ(meant_with_unit("400", "rad", {-6.3, 6.3}), "");
}

TEST(FirstSlips, of_a_probe_that_reads_nothing_are_told_by_run) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/plate.toml", output = folder.path() + "/said.txt";
  replace_file(path, plate + std::string("[[probe]]\nname = \"crown\"\nquantity = \"velocity_x\"\n"
                                         "min = [\"1 m\", \"1 m\"]\nmax = [\"2 m\", \"2 m\"]\n"));
  EXPECT_EQ(wait_for(start_program("run " + path + " -o " + folder.path() + "/out", output)), 0);
  const std::string summary = read_whole_file(folder.path() + "/out/summary.json");
  EXPECT_NE(summary.find("probe.crown"), std::string::npos) << summary;
  EXPECT_NE(summary.find("takes nothing"), std::string::npos) << summary;
}

TEST(FirstSlips, in_the_name_of_a_probe_are_told) {
  const std::string probe = "[[probe]]\nname = \"time\"\nquantity = \"velocity_x\"\n";
  const std::string said = said_of(plate + probe, "", "");
  EXPECT_NE(said.find("probe.time.name: history.csv has a column of this name already"),
            std::string::npos)
      << said;
}

}  // namespace first_slips_test
}  // namespace breccia
