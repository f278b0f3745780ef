// `breccia check` of bolts in tetrahedra: what it refuses, by line and key.

#include <gtest/gtest.h>

#include "io/whole_file.hpp"
#include "paths.hpp"
#include "unit/run/program.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace bolts_command_test {

/// The output of `check` for the example with one piece of its text changed; empty: it is good.
std::string said_of(const std::string& from, const std::string& to) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/bolted.toml", output = folder.path() + "/said.txt";
  std::string text = read_whole_file(source_dir + std::string("/tests/attack/bolted_3d.toml"));
  text.replace(text.find(from), from.size(), to);
  replace_file(path, text);
  const int code = wait_for(start_program("check " + path, output));
  if (code == 0) return "";
  EXPECT_EQ(code, 2);
  return read_whole_file(output);
}
void expect_said(const std::string& from, const std::string& to, const std::string& part) {
  const std::string text = said_of(from, to);
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(BoltsCommand, checks_those_in_space) {
  EXPECT_EQ(said_of("bedding", "bedding"), "");
  expect_said("segment = \"2 mm\"\ndiameter", "segment = \"0.5 mm\"\ndiameter",
              "line 37, bolt.bolt.segment: 0.0004843 m are stiffer than the corners of tetrahedra");
  expect_said("\"1 mm\", \"-7 mm\"]", "\"1 mm\", \"-9 mm\"]",
              "bolt.bolt.points: (0 m, 1 mm, -9 mm) lies in no body; block is nearest, 1 mm away");
  expect_said("axis = [0.1, 0.2, 1.0]\n", "",
              "bolt.rib.axis: a ring needs the direction of its axis");
  expect_said("area = 4e-8", "spacing = 1.0",
              "bolt.rib.spacing is not a key of fdem3d; fdem2d has it");
  const std::string text = said_of("0.0, \"4 mm\"]\nradius", "0.0, \"9 mm\"]\nradius");
  const std::string part = "bolt.rib.points: ";
  const std::size_t first = text.find(part);
  ASSERT_NE(first, std::string::npos) << text;
  EXPECT_EQ(text.find(part, first + 1), std::string::npos);  // of a ring the first one alone
}

}  // namespace bolts_command_test
}  // namespace breccia
