// Runs of the program that end before their time, and what they leave once resumed on other
// threads.

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "io/whole_file.hpp"
#include "paths.hpp"
#include "texts.hpp"
#include "unit/run/program.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace broken_off_test {

namespace fs = std::filesystem;

const std::string small_slab = std::string(source_dir) + "/cases/rc_slab/small.toml";

class BrokenOff : public ::testing::Test {
 protected:
  std::string folder(const std::string& name) const { return scratch / name; }
  nlohmann::json summary(const std::string& name) const {
    return parsed_json(read_whole_file(folder(name) + "/summary.json"));
  }
  std::string history(const std::string& name) const {
    return read_whole_file(folder(name) + "/history.csv");
  }
  pid_t start(const std::string& name, int threads) const {
    return start_program("run " + small_slab +
                         " --set checkpoint.steps=150 --set output.pictures=false --threads " +
                         std::to_string(threads) + " -o " + folder(name));
  }
  /// Waits until the run in the folder has written so many of its 1,000 rows.
  void wait_for_rows(const std::string& name, long rows) const {
    for (int i = 0; i < 60'000; ++i) {
      if (fs::exists(folder(name) + "/history.csv")) {
        const std::string text = history(name);
        if (std::count(text.begin(), text.end(), '\n') >= rows) return;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ADD_FAILURE() << "the run writes no rows";
  }
  void expect_the_same_as_whole(const std::string& name) const {
    for (const char* key : {"status", "steps", "time", "dt", "state_hash", "energy", "probe"})
      EXPECT_EQ(summary(name)[key], summary("whole")[key]) << key;
    EXPECT_GT(summary(name)["fracture"]["broken_links"], 100);
    EXPECT_EQ(history(name), history("whole"));
    const std::string links = read_whole_file(folder(name) + "/broken_links.csv");
    EXPECT_NE(links.find(",time\n"), std::string::npos);
    EXPECT_EQ(links, read_whole_file(folder("whole") + "/broken_links.csv"));
  }

  ScratchFolder scratch;
};

TEST_F(BrokenOff, by_a_signal_or_killed_a_run_ends_on_other_threads_as_if_nothing_had_been) {
  ASSERT_EQ(wait_for(start("whole", 1)), 0);
  const auto all = summary("whole")["steps"].get<std::int64_t>();

  const pid_t asked = start("asked", 2);
  wait_for_rows("asked", 300);
  ::kill(asked, SIGTERM);
  ASSERT_EQ(wait_for(asked), 128 + SIGTERM);
  EXPECT_LT(summary("asked")["steps"].get<std::int64_t>(), all);
  ASSERT_EQ(wait_for(start_program("resume " + folder("asked") + " --threads 3")), 0);
  expect_the_same_as_whole("asked");

  const pid_t killed = start("killed", 3);
  wait_for_rows("killed", 500);
  ::kill(killed, SIGKILL);
  ASSERT_EQ(wait_for(killed), -SIGKILL);
  ASSERT_EQ(wait_for(start_program("resume " + folder("killed") + " --threads 2")), 0);
  expect_the_same_as_whole("killed");
}

}  // namespace broken_off_test
}  // namespace breccia
