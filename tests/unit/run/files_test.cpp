// The program and files that are not as it needs them: full, planted, of another kind, gone.

#include <gtest/gtest.h>

#include <filesystem>

#include "io/whole_file.hpp"
#include "unit/run/program.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace {

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

}  // namespace
}  // namespace breccia
