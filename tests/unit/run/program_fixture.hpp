#pragma once
// Cases for tests of the program, and the folder in which they run.

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "io/whole_file.hpp"
#include "texts.hpp"
#include "unit/run/program.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace program_test {

namespace fs = std::filesystem;

/// Two balls that collide head-on.
inline const std::string two_balls = R"(
breccia = 1
method = "dem3d"
energy = { warn = 0.0, stop = 0.0 }  # 15 steps a collision cost 7 % of its energy
[time]
end = "2 ms"
[output]
frames = 2
width = 64
height = 64
[material.rock]
law = "grain"
young = "1 GPa"
[[body]]
name = "left"
shape = "element"
material = "rock"
center = [-0.011, 0.0, 0.0]
radius = "10 mm"
velocity = [2.0, 0.0, 0.0]
[[body]]
name = "right"
shape = "element"
material = "rock"
center = [0.011, 0.0, 0.0]
radius = "10 mm"
velocity = [-2.0, 0.0, 0.0]
[[probe]]
name = "left_x"
on = "left"
quantity = "position_x"
[[check]]
name = "elements"
value = "model.elements"
expected = 2
)";

class Program : public testing::Test {
 protected:
  Program() {
    replace_file(scratch / "balls.toml", two_balls);
    std::string long_case = two_balls;
    replace_file(scratch / "long.toml", long_case.replace(long_case.find("2 ms"), 4, "900 s"));
  }

  /// The exit code; what it said is in output().
  int run(const std::string& arguments) {
    return wait_for(start_program(arguments, scratch / "output.txt"));
  }
  std::string output() const { return read_whole_file(scratch / "output.txt"); }
  std::string path(const std::string& name) const { return scratch / name; }
  nlohmann::json summary(const std::string& name) const {
    return parsed_json(read_whole_file(path(name) + "/summary.json"));
  }
  /// Waits until the run in the folder has begun to step.
  void wait_until_running(const std::string& name) const {
    for (int i = 0; i < 2000 && !fs::exists(path(name) + "/history.csv"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }

  ScratchFolder scratch;
};
}  // namespace program_test
}  // namespace breccia
