#include "run/machine/memory_plan.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <thread>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "unit/run/program.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace memory_plan_test {

namespace fs = std::filesystem;

/// Text of the kernel about a machine with 8 GB to spare.
class Machine {
 public:
  Machine() { write("proc/meminfo", "MemTotal: 16000000 kB\nMemAvailable: 8000000 kB\n"); }
  void write(const std::string& name, const std::string& content) {
    fs::create_directories(fs::path(folder_ / name).parent_path());
    replace_file(folder_ / name, content);
  }
  double available() const { return available_memory(folder_.path()); }

 private:
  ScratchFolder folder_;
};

TEST(MemoryPlan, the_tightest_of_machine_and_control_groups_counts) {
  Machine machine;
  EXPECT_EQ(machine.available(), 8.192e9);
  machine.write("proc/self/cgroup", "0::/user/job\n");
  machine.write("sys/fs/cgroup/user/job/memory.max", "max\n");
  machine.write("sys/fs/cgroup/user/job/memory.current", "1000000\n");
  EXPECT_EQ(machine.available(), 8.192e9);
  machine.write("sys/fs/cgroup/user/memory.max", "3000000000\n");
  machine.write("sys/fs/cgroup/user/memory.current", "2000000000\n");
  EXPECT_EQ(machine.available(), 1e9);
  machine.write("sys/fs/cgroup/user/memory.stat", "anon 1\ninactive_file 500000000\n");
  EXPECT_EQ(machine.available(), 1.5e9);  // what is cached can be given back
}

TEST(MemoryPlan, older_control_groups_count_too) {
  Machine machine;
  machine.write("proc/self/cgroup", "5:cpu:/x\n4:memory:/batch/7\n");
  machine.write("sys/fs/cgroup/memory/batch/7/memory.limit_in_bytes", "2000000000\n");
  machine.write("sys/fs/cgroup/memory/batch/7/memory.usage_in_bytes", "500000000\n");
  EXPECT_EQ(machine.available(), 1.5e9);
}

TEST(MemoryPlan, items_follow_from_counts_and_areas) {
  dem::Config dem;
  dem.bodies.resize(2);
  dem.bodies[0].pack.count = 1000;
  dem.bodies[1].shape = "element";
  EXPECT_EQ(memory_plan(dem).items, 1000.0);
  fdem::Config fdem;
  fdem.bodies.resize(1);
  fdem.bodies[0].shape = "disc";
  fdem.bodies[0].radius = 0.04;
  fdem.bodies[0].mesh_size = 0.501e-3;
  EXPECT_NEAR(memory_plan(fdem).items, 50'312.0, 0.1 * 50'312.0);  // of gmsh
}

/// Of an outline whose corners a file lists, in millimetres taken for metres, say.
TEST(MemoryPlan, items_of_an_outline_follow_from_its_file) {
  const ScratchFolder scratch;
  replace_file(scratch / "wedge.csv", "0,0\n200,0\n200,100\n");
  fdem::Config config;
  config.bodies.resize(1);
  fdem::BodyConfig& body = config.bodies[0];
  body.shape = "outline";
  body.file = "wedge.csv";
  body.mesh_size = 0.01;
  EXPECT_EQ(memory_plan(config).items, 0.0);
  EXPECT_EQ(memory_plan(config, scratch.path() + "/nowhere").items, 0.0);
  EXPECT_NEAR(memory_plan(config, scratch.path()).items, 1e4 / 0.433e-4, 1e-6 * 1e4 / 0.433e-4);
  body.holes.resize(1);
  body.holes[0].radius = 20.0;
  EXPECT_NEAR(memory_plan(config, scratch.path()).items, (1e4 - 400.0 * 3.14159265) / 0.433e-4,
              1e-6 * 1e4 / 0.433e-4);
}

TEST(MemoryPlan, frames_and_checkpoints_of_tetrahedra_count_where_they_are_written) {
  fdem3::Config config;
  config.bodies.resize(1);
  config.bodies[0].shape = "box";
  config.bodies[0].size = {1.0, 1.0, 1.0};
  config.bodies[0].mesh_size = 0.1;
  config.bodies[0].structured = true;
  const auto plan = [&] { return memory_plan(config); };
  ASSERT_NEAR(plan().items, 6000.0, 1.0);
  const MemoryPlan framed = plan();
  config.output.fields = config.output.pictures = false;
  const MemoryPlan saved = plan();
  config.checkpoint.keep = 0;
  const MemoryPlan bare = plan();
  EXPECT_GT(framed.run_bytes, saved.run_bytes);
  EXPECT_EQ(saved.run_bytes, bare.run_bytes);  // a processor writes its own arrays
  EXPECT_GT(framed.host_bytes, saved.host_bytes);
  EXPECT_GT(saved.host_bytes, bare.host_bytes);
  EXPECT_LT(framed.host_bytes, framed.run_bytes);
}

const std::string box = R"(
time.end = "1 ms"
[material.c30]
law = "concrete"
[[body]]
name = "box"
material = "c30"
size = [1.0, 1.0, 1.0]
pack = { count = 2000000 }
)";

/// Processor time of children that have ended.  [s]
double spent_by_children() {
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}
/// Time of a child which runs, or has ended and is not awaited yet.  [s]
double spent_by(pid_t child) {
  clockid_t clock = 0;
  timespec spent{};
  if (::clock_getcpuclockid(child, &clock) != 0 || ::clock_gettime(clock, &spent) != 0) return 1e9;
  return static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
}

TEST(MemoryPlan, what_cannot_fit_is_refused_before_it_is_packed) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer's shadow does not fit under a limit";
#endif
  const ScratchFolder folder;
  replace_file(folder / "box.toml", box);
  const auto refused = [&](const std::string& command, const std::string& first = "") {
    const double begin = spent_by_children();
    const int code = wait_for(
        start_program(command + " " + (folder / "box.toml"), folder / "output.txt", first));
    EXPECT_LT(spent_by_children() - begin, 20.0);  // packing takes minutes
    const std::string told = read_whole_file(folder / "output.txt");
    EXPECT_NE(told.find("needs about"), std::string::npos) << told;
    EXPECT_NE(told.find("are available"), std::string::npos) << told;
    return code;
  };
  const std::string limit = "ulimit -v 1000000;", many = " --set body.box.pack.count=2000000000";
  EXPECT_EQ(refused("check", limit), 5);
  EXPECT_EQ(refused("run -o " + (folder / "out"), limit), 5);
  EXPECT_EQ(refused("prepare -o " + (folder / "box.br"), limit), 5);
  EXPECT_EQ(refused("check" + many), 5);
  EXPECT_EQ(refused("run -o " + (folder / "out") + many), 5);
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(MemoryPlan, a_signal_ends_setting_up_at_once) {
  const ScratchFolder folder;
  replace_file(folder / "box.toml", box);
  for (const int signal : {SIGTERM, SIGINT, SIGUSR1}) {
    const pid_t child = start_program("run " + (folder / "box.toml") + " -o " + (folder / "out") +
                                      " --set body.box.pack.count=500000");
    while (spent_by(child) < 0.5) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ::kill(child, signal);
    int status = 0;
    pid_t ended = 0;
    for (int i = 0; i < 6000 && ended == 0; ++i) {
      ended = ::waitpid(child, &status, WNOHANG);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_EQ(ended, child) << "it still packs";
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 128 + signal);
    if (ended == 0) ::kill(child, SIGKILL);
    EXPECT_FALSE(fs::exists(folder / "out"));
  }
}

}  // namespace memory_plan_test
}  // namespace breccia
