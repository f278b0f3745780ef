// A run of cases/ldpm_cube that is killed or cut goes on to the same bits.

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "io/whole_file.hpp"
#include "run/results/checkpoints.hpp"
#include "texts.hpp"
#include "unit/run/program.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace ldpm_program_test {

class LdpmProgram : public testing::Test {
 protected:
  int run(const std::string& arguments) {
    return wait_for(start_program(arguments, folder / "output.txt"));
  }
  std::string output() const { return read_whole_file(folder / "output.txt"); }
  std::string hash_of(const std::string& name) const {
    const auto summary = parsed_json(read_whole_file(folder / name + "/summary.json"));
    return summary["state_hash"].get<std::string>() + " at " + summary["steps"].dump();
  }
  /// From the start, fast enough for softening within the steps.
  std::string pull(const std::string& name) const {
    return "run " + std::string(source_dir) +
           "/cases/ldpm_cube/small.toml --set output.frames=0 --set checkpoint.steps=40 "
           "--set 'support.head.velocity=[0, 0, 1]' --set support.head.ramp=1e-5 -o " +
           (folder / name);
  }
  ScratchFolder folder;
};

TEST_F(LdpmProgram, resumes_to_the_same_bits_after_a_cut_and_after_a_kill) {
  ASSERT_EQ(run(pull("whole") + " --steps 1000"), 0) << output();
  ASSERT_EQ(run(pull("cut") + " --steps 400"), 0) << output();
  EXPECT_NE(hash_of("cut"), hash_of("whole"));
  ASSERT_EQ(run("resume " + (folder / "cut") + " --threads 1 --steps 1000"), 0) << output();
  EXPECT_EQ(hash_of("cut"), hash_of("whole"));

  const pid_t child = start_program(pull("killed"));
  const std::string checkpoints = folder / "killed" + "/checkpoints";
  for (int i = 0; i < 4000; ++i) {
    if (std::filesystem::exists(checkpoints) && !list_checkpoints(checkpoints).empty()) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ::kill(child, SIGKILL);
  EXPECT_EQ(wait_for(child), -SIGKILL);
  ASSERT_EQ(run("resume " + (folder / "killed") + " --threads 1 --steps 1000"), 0) << output();
  EXPECT_EQ(hash_of("killed"), hash_of("whole"));
}

}  // namespace ldpm_program_test
}  // namespace breccia
