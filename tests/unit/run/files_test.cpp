// The program and files that are not as it needs them: full, planted, of another kind, gone.

#include <gtest/gtest.h>

#include <filesystem>

#include "io/whole_file.hpp"
#include "unit/run/program.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace files_test {

namespace fs = std::filesystem;

/// A ball that flies.
const std::string one_ball = R"(
time.end = "1 ms"
[output]
frames = 2
width = 64
height = 64
[material.rock]
law = "grain"
young = "1 GPa"
[[body]]
name = "ball"
shape = "element"
material = "rock"
radius = "10 mm"
velocity = [2.0, 0.0, 0.0]
)";

class ProgramAndFiles : public testing::Test {
 protected:
  ProgramAndFiles() { replace_file(path("ball.toml"), one_ball); }

  /// The exit code; what it said is in output().
  int run(const std::string& arguments, const std::string& first = "") {
    return wait_for(start_program(arguments, path("output.txt"), first));
  }
  std::string output() const { return read_whole_file(path("output.txt")); }
  bool told(const std::string& text) const { return output().find(text) != std::string::npos; }
  std::string path(const std::string& name) const { return scratch_ / name; }
  std::size_t entries_of(const std::string& name) const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(path(name)), fs::directory_iterator()));
  }

 private:
  ScratchFolder scratch_;
};

TEST_F(ProgramAndFiles, a_quota_on_file_sizes_ends_every_command_with_3) {
  ASSERT_EQ(run("run " + path("ball.toml") + " -o " + path("out")), 0) << output();
  fs::create_directory(path("made"));
  const std::string quota = "ulimit -f 1;";  // 512 bytes
  EXPECT_EQ(run("prepare " + path("ball.toml") + " -o " + path("made/ball.br"), quota), 3);
  EXPECT_EQ(run("render " + path("out") + " -o " + path("made/ball.png"), quota), 3);
  EXPECT_EQ(run("keys", quota), 3);
  EXPECT_EQ(entries_of("made"), 0U);
}

TEST_F(ProgramAndFiles, energies_that_are_no_numbers_are_told_with_their_step_and_never_written) {
  replace_file(path("plate.toml"), R"(
method = "fdem2d"
time.end = "1 us"
[output]
frames = 0
[in_situ]
xx = 1e15
yy = 1e15
[material.rock]
young = 1000.0
joints = "none"
[[body]]
name = "plate"
material = "rock"
size = ["8 mm", "8 mm"]
mesh_size = "2 mm"
structured = true
velocity = [1.0, 0.0]
)");
  EXPECT_EQ(run("run " + path("plate.toml") + " -o " + path("out")), 4) << output();
  EXPECT_TRUE(told("error: step 0, t = 0.000000e+00 s: ")) << output();
  const std::string rows = read_whole_file(path("out/history.csv"));
  EXPECT_EQ(rows.find("inf"), std::string::npos) << rows;
  EXPECT_EQ(rows.find("nan"), std::string::npos) << rows;
}

TEST_F(ProgramAndFiles, nothing_is_written_through_links_that_wait_in_the_folder) {
  const std::string precious = path("precious");
  replace_file(precious, "precious");
  for (const char* name : {"history.csv", "log.jsonl", ".lock", "case.toml", "summary.json"}) {
    const std::string out = path(std::string("out_") + name);
    fs::create_directory(out);
    fs::create_symlink(precious, out + "/" + name);
    fs::create_symlink(precious, out + "/" + name + ".tmp");
    EXPECT_NE(run("run " + path("ball.toml") + " -o " + out), 0) << name;
    EXPECT_EQ(read_whole_file(precious), "precious") << name;
  }
  fs::create_directory(path("out"));
  for (const char* name : {"case.toml", "summary.json", "elements.pvd"})
    fs::create_symlink(precious, path("out/") + name + ".tmp");
  EXPECT_EQ(run("run " + path("ball.toml") + " -o " + path("out")), 0) << output();
  EXPECT_EQ(read_whole_file(precious), "precious");
}

TEST_F(ProgramAndFiles, a_script_of_a_case_runs_only_where_that_is_allowed) {
  replace_file(path("plate.geo"), "SystemCall \"touch " + path("made") + "\";\n" + R"(
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 1, 1};
)");
  replace_file(path("geo.toml"), R"(
method = "fdem2d"
time.end = 1e-9
output.pictures = false
material.rock.young = 1e10
[[body]]
name = "plate"
shape = "geo"
file = "plate.geo"
material = "rock"
mesh_size = 0.5
)");
  EXPECT_EQ(run("check " + path("geo.toml")), 0) << output();
  EXPECT_TRUE(told("needs --allow-scripts for plate.geo")) << output();
  EXPECT_EQ(run("run " + path("geo.toml") + " -o " + path("out")), 2);
  EXPECT_TRUE(told("--allow-scripts")) << output();
  EXPECT_EQ(run("prepare " + path("geo.toml") + " -o " + path("geo.br")), 2);
  EXPECT_FALSE(fs::exists(path("made")));
  EXPECT_EQ(run("prepare " + path("geo.toml") + " --allow-scripts -o " + path("geo.br")), 0)
      << output();
  EXPECT_TRUE(fs::exists(path("made")));
  fs::remove(path("made"));
  EXPECT_EQ(run("run " + path("geo.br") + " --steps 1 -o " + path("out")), 0) << output();
  EXPECT_FALSE(fs::exists(path("made")));
}

TEST_F(ProgramAndFiles, what_a_killed_run_left_goes_when_it_is_resumed) {
  ASSERT_EQ(run("run " + path("ball.toml") + " --steps 5 -o " + path("out")), 0) << output();
  const std::string left = ".0123456789abcdef.tmp";
  for (const char* name : {"summary.json", "checkpoints/a.br", "fields/a.vtu", "pictures/0000.png"})
    replace_file(path("out/") + name + left, "half");
  for (const char* name : {"out/notes.tmp", "out/a.0123.tmp"}) replace_file(path(name), "mine");
  ASSERT_EQ(run("resume " + path("out")), 0) << output();
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path("out")))
    EXPECT_FALSE(entry.path().string().ends_with(left)) << entry.path();
  for (const char* name : {"out/notes.tmp", "out/a.0123.tmp"}) EXPECT_TRUE(fs::exists(path(name)));
}

}  // namespace files_test
}  // namespace breccia
