// The program itself on ranks that mpirun starts: same bytes in the result folder, exit codes,
// ends.

#include "unit/run/program.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <thread>

#include "paths.hpp"

namespace breccia {
namespace program_test {

namespace fs = std::filesystem;

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file.good()) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Longer than any rank needs where others take the processors, far shorter than for ever.  [s]
constexpr int soon = 60;

/// Words that start `ranks` ranks, as Open MPI and MPICH understand it. Modules of Open MPI leak
/// and are gone when a sanitizer asks for their names.
std::string mpirun(int ranks) {
  return "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
         "OMPI_MCA_rmaps_base_oversubscribe=1 ASAN_OPTIONS=\"$ASAN_OPTIONS:detect_leaks=0\" "
         "timeout -k 5 400 " +
         std::string(mpirun_program) + " -n " + std::to_string(ranks) + " ";
}

/// Runs `breccia ARGUMENTS` on `ranks` ranks (1: without mpirun); returns its exit code. Its words
/// go to the file `to`, or without one to the test's own output when the code is not 0.
int run(int ranks, const std::string& arguments, const std::string& to = "") {
  const std::string kept = !to.empty()
                               ? to
                               : (fs::temp_directory_path() /
                                  ("breccia_mpi_" + std::to_string(::getpid())) / "told_last")
                                     .string();
  const std::string command =
      (ranks > 1 ? mpirun(ranks) : "") + program + " " + arguments + " > " + kept + " 2>&1";
  const int status = std::system(command.c_str());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (code != 0 && to.empty()) std::cout << command << "\n" << bytes_of(kept) << std::endl;
  return code;
}

class ProgramOnRanks : public ::testing::Test {
 protected:
  ProgramOnRanks()
      : folder_(fs::temp_directory_path() / ("breccia_mpi_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~ProgramOnRanks() override { fs::remove_all(folder_); }

  std::string out(const std::string& name) const { return (folder_ / name).string(); }
  /// The hash in a run's summary.
  static std::string hash_in(const std::string& folder) {
    const std::string text = bytes_of(folder + "/summary.json");
    const std::size_t at = text.find("\"state_hash\": \"");
    EXPECT_NE(at, std::string::npos);
    return at == std::string::npos ? "" : text.substr(at + 15, 16);
  }
  /// The bytes of all files in a folder of a run, by name.
  static std::string files_in(const std::string& folder) {
    std::map<std::string, std::string> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      files[entry.path().filename()] = bytes_of(entry.path());
    std::string all;
    for (const auto& [name, bytes] : files) all += name + ": " + bytes;
    EXPECT_FALSE(all.empty()) << folder;
    return all;
  }

  /// The model of a shipped small case, built once: ranks that wait for it keep processors busy.
  std::string prepared(const std::string& name) const {
    const std::string model = out("model.br");
    EXPECT_EQ(
        run(1, "prepare " + std::string(source_dir) + "/cases/" + name + "/small.toml -o " + model),
        0);
    return model;
  }

  /// Equal files from one process and from several, and from one that was continued on others.
  void compare(const std::string& name, int steps, const std::string& history) {
    const std::string shared = prepared(name) +
                               " --threads 1 --no-progress --set output.frames=1 --set "
                               "checkpoint.keep=1 --set output.history=" +
                               history + " ";
    const std::string end = "--steps " + std::to_string(steps) + " ";
    ASSERT_EQ(run(1, "run " + shared + end + "-o " + out("one")), 0);
    for (const int ranks : {2, 5}) {  // and 3 below
      const std::string there = out("on_" + std::to_string(ranks));
      ASSERT_EQ(run(ranks, "run " + shared + end + "-o " + there), 0) << ranks;
      EXPECT_EQ(hash_in(there), hash_in(out("one"))) << ranks << " ranks";
      for (const char* table : {"/history.csv", "/broken_links.csv", "/cracks.csv"})
        if (fs::exists(out("one") + table)) {
          EXPECT_EQ(bytes_of(there + table), bytes_of(out("one") + table)) << table;
        }
      for (const char* files : {"/fields", "/pictures", "/checkpoints"})  // no diff of binary files
        EXPECT_TRUE(files_in(there + files) == files_in(out("one") + files)) << files << ranks;
    }
    const std::string half = "--steps " + std::to_string(steps / 2) + " ";
    ASSERT_EQ(run(2, "run " + shared + half + "-o " + out("half")), 0);
    ASSERT_EQ(run(3, "resume " + out("half") + " --threads 1 --no-progress " + end), 0);
    EXPECT_EQ(hash_in(out("half")), hash_in(out("one")));
  }

  fs::path folder_;
};

TEST_F(ProgramOnRanks, slab_leaves_the_same_files) {
  compare("rc_slab", 150, "1e-5");
}
TEST_F(ProgramOnRanks, disc_leaves_the_same_files) {
  compare("brazilian_disc", 300, "1e-6");
}
TEST_F(ProgramOnRanks, box_leaves_the_same_files) {
  compare("moving_box", 120, "2e-3");
}

TEST_F(ProgramOnRanks, sweep_makes_runs_of_two_ranks_each) {
  const std::string shared = std::string(source_dir) +
                             "/cases/rc_slab/small.toml --threads 1 --set time.end=1e-5 "
                             "--set output.frames=0 ";
  const std::string sweep = "sweep " + shared + "--seeds 2 -o " + out("sweep") + " ";
  const std::string start = "BRECCIA_MPIRUN=" + std::string(mpirun_program) +
                            " OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
                            "ASAN_OPTIONS=\"$ASAN_OPTIONS:detect_leaks=0\" " +
                            program;
  ASSERT_EQ(std::system((start + " " + sweep + "--ranks 2 --jobs 2 > " + out("told")).c_str()), 0)
      << bytes_of(out("told"));
  ASSERT_EQ(run(1, "run " + shared + "--set seed=2 --no-progress -o " + out("one")), 0);
  int found = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(out("sweep") + "/runs"))
    if (entry.path().filename().string().starts_with("seed=2")) {
      ++found;
      EXPECT_EQ(hash_in(entry.path()), hash_in(out("one")));
      EXPECT_NE(bytes_of(entry.path() / "summary.json").find("\"ranks\": 2"), std::string::npos);
    }
  EXPECT_EQ(found, 1);
  ASSERT_EQ(run(1, sweep, out("told")), 0);  // the same runs, whatever their number of ranks
  EXPECT_NE(bytes_of(out("told")).find("2 of 2  kept"), std::string::npos) << bytes_of(out("told"));
}

/// SIGINT reaches the ranks by way of mpirun, which ends them before they have saved if it is told
/// to stop itself. What they saved is gone on with, by one process, to the state of one run.
TEST_F(ProgramOnRanks, sweep_that_is_interrupted_goes_on_with_the_runs_of_its_ranks) {
  const std::string shared = std::string(source_dir) +
                             "/cases/rc_slab/small.toml --threads 1 --set time.end=3e-4 "
                             "--set output.frames=0 --set checkpoint.steps=20 ";
  const std::string sweep = "sweep " + shared + "-o " + out("sweep") + " ";
  const pid_t process =
      start_program(sweep + "--ranks 2", out("told"),
                    "export BRECCIA_MPIRUN=" + std::string(mpirun_program) +
                        " OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
                        "ASAN_OPTIONS=\"$ASAN_OPTIONS:detect_leaks=0\";");
  const auto saved = [&] {
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(out("sweep") + "/runs", none))
      if (fs::exists(entry.path() / "checkpoints", none) &&
          !fs::is_empty(entry.path() / "checkpoints", none))
        return true;
    return false;
  };
  for (int k = 0; k < 100 * 400 && !saved(); ++k)  // as long as `timeout` would let it run
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const bool there = saved();
  ::kill(process, SIGINT);
  ASSERT_TRUE(there);
  EXPECT_EQ(wait_for(process), 128 + SIGINT) << bytes_of(out("told"));
  EXPECT_NE(bytes_of(out("sweep") + "/sweep.csv").find("interrupted"), std::string::npos);

  ASSERT_EQ(run(1, sweep, out("told")), 0) << bytes_of(out("told"));
  ASSERT_EQ(run(1, "run " + shared + "--no-progress -o " + out("one")), 0);
  for (const fs::directory_entry& entry : fs::directory_iterator(out("sweep") + "/runs")) {
    const std::string log = bytes_of(entry.path() / "log.jsonl");
    EXPECT_NE(log.find("\"setup\"", log.find("\"setup\"") + 1), std::string::npos) << log;
    EXPECT_EQ(hash_in(entry.path()), hash_in(out("one")));
  }
}

TEST_F(ProgramOnRanks, strong_benchmark_ends_in_the_state_of_one_process) {
  const auto hash_of = [&](int ranks, const std::string& name) {
    const std::string file = out(name + std::to_string(ranks) + ".json");
    EXPECT_EQ(run(ranks, "bench " + name +
                             " --elements 2000 --window-steps 10 --threads 1 --json " + file),
              0);
    const std::string text = bytes_of(file), key = "\"hash\": \"";
    const std::size_t at = text.find(key);
    EXPECT_NE(at, std::string::npos) << text;
    return at == std::string::npos ? std::string() : text.substr(at + key.size(), 16);
  };
  EXPECT_EQ(hash_of(2, "strong_plate"), hash_of(1, "strong_plate"));
  EXPECT_NE(hash_of(2, "weak_plate"), hash_of(1, "weak_plate"));  // twice the plate
}

TEST_F(ProgramOnRanks, a_frame_that_cannot_be_written_ends_all_with_one_message) {
  fs::create_directories(out("full") + "/pictures/0000.png");  // where a file should go
  EXPECT_EQ(
      run(3,
          "run " + std::string(source_dir) +
              "/cases/rc_slab/small.toml --threads 1 --no-progress --steps 5 -o " + out("full"),
          out("told")),
      3);
  const std::string text = bytes_of(out("told"));
  const std::size_t first = text.find("error: ");
  ASSERT_NE(first, std::string::npos) << text;
  EXPECT_NE(text.find("0000.png: cannot write"), std::string::npos) << text;
  EXPECT_EQ(text.find("error: ", first + 1), std::string::npos) << text;
}

TEST_F(ProgramOnRanks, a_benchmark_of_one_rank_is_refused) {
  EXPECT_EQ(run(2, "bench search", out("told")), 2);
  EXPECT_NE(bytes_of(out("told")).find("without mpirun"), std::string::npos);
}

TEST_F(ProgramOnRanks, a_bad_case_is_told_once_with_exit_code_2) {
  EXPECT_EQ(run(3,
                "run " + std::string(source_dir) +
                    "/cases/rc_slab/small.toml --set time.safty=1 -o " + out("bad"),
                out("told")),
            2);
  const std::string told = bytes_of(out("told"));
  const std::size_t first = told.find("error: ");
  EXPECT_NE(first, std::string::npos);
  EXPECT_EQ(told.find("error: ", first + 1), std::string::npos) << told;
  EXPECT_FALSE(fs::exists(out("bad")));
}

TEST_F(ProgramOnRanks, a_folder_that_holds_a_run_is_refused_by_all) {
  fs::create_directories(out("held"));
  std::ofstream(out("held") + "/summary.json") << "{}";
  EXPECT_EQ(run(2, "run " + std::string(source_dir) + "/cases/rc_slab/small.toml --steps 1 -o " +
                       out("held")),
            2);
}

TEST_F(ProgramOnRanks, numbers_that_go_wrong_end_all_with_exit_code_4_and_a_saved_state) {
  EXPECT_EQ(run(3,
                "run " + std::string(source_dir) +
                    "/cases/moving_box/small.toml --set time.max_step=0.02 "
                    "--set time.evaluate_every=1000 --set time.safety=1 --set "
                    "'gravity=[1e9,0]' --threads 1 --no-progress --set output.pictures=false -o " +
                    out("wrong"),
                out("told")),
            4)
      << bytes_of(out("told"));
  EXPECT_TRUE(fs::exists(out("wrong") + "/crash.br"));
}

TEST_F(ProgramOnRanks, numbers_that_go_wrong_in_a_search_are_named_as_by_one_process) {
  std::string messages[2];
  for (const int ranks : {1, 3}) {
    const std::string there = out("lost");
    EXPECT_EQ(run(ranks,
                  "run " + std::string(source_dir) +
                      "/cases/wing_crack/small.toml --set support.press.ramp=0 --set "
                      "'support.press.velocity=[0,-1e7]' --threads 1 "
                      "-q --set output.pictures=false -o " +
                      there,
                  out("told")),
              4);
    const std::string text = bytes_of(out("told"));
    const std::size_t begin = text.find("error: ");  // after warnings of set-up
    ASSERT_NE(begin, std::string::npos) << text;
    messages[ranks / 3] = text.substr(begin, text.find('\n', begin) - begin);
    fs::remove_all(there);
  }
  EXPECT_NE(messages[0].find("triangle "), std::string::npos) << messages[0];
  EXPECT_EQ(messages[1], messages[0]);
}

/// Time from an event on a rank to the end of the job, and what the job said.
struct Ending {
  int exit_code = 0;
  int took = 0;  ///<  [s]
  std::string told;
  int errors() const {
    int count = 0;
    for (std::size_t at = 0; (at = told.find("error: ", at)) != std::string::npos; ++at) ++count;
    return count;
  }
};

/// Runs the slab on three ranks, until one of them suffers `fate`, a command of the shell that
/// knows its process as $pid, once there is a state to go on from.
class FateOfRank : public ProgramOnRanks {
 protected:
  const std::string slab =
      prepared("rc_slab") +
      " --threads 1 --no-progress --set output.frames=0 "
      "--set checkpoint.steps=100 --set output.history=1 --set domain.patience=3 ";

  Ending suffer(int rank, const std::string& fate, const std::string& more = "",
                const std::string& environment = "") {
    std::ofstream(out("rank.sh"))
        << "#!/bin/sh\n"
        << environment << "\npid=$$\necho $pid >> " << out("pids")
        << "\nif [ \"${OMPI_COMM_WORLD_RANK:-$PMI_RANK}\" = " << rank << " ]; then\n  (while ! ls "
        << out("run")
        << "/checkpoints/step_*.br; do kill -0 $pid || exit; sleep 0.02; done\n   date +%s > "
        << out("when") << "; " << fate << ") > /dev/null 2>&1 &\nfi\nexec " << program
        << " \"$@\"\n";
    fs::permissions(out("rank.sh"), fs::perms::owner_all);
    const std::string command = mpirun(3) + out("rank.sh") + " run " + slab + more + "-o " +
                                out("run") + " > " + out("told") +
                                " 2>&1; code=$?; echo $(($(date +%s) - $(cat " + out("when") +
                                "))) > " + out("took") + "; exit $code";
    const int status = std::system(command.c_str());
    return {WEXITSTATUS(status), std::stoi(bytes_of(out("took"))), bytes_of(out("told"))};
  }
  /// Processes of the job that are still there, after a moment.
  int left_over() const {
    int count = 1;
    for (int i = 0; i < 50 && count > 0; ++i) {
      count = 0;
      std::ifstream file(out("pids"));
      for (int pid = 0; file >> pid;) count += ::kill(pid, 0) == 0 ? 1 : 0;
      if (count > 0) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return count;
  }
};

TEST_F(FateOfRank, killed_ends_the_job_within_seconds_and_resume_goes_on) {
  const Ending ending = suffer(1, "kill -9 $pid");
  EXPECT_NE(ending.exit_code, 0) << ending.told;
  EXPECT_NE(ending.exit_code, 124) << "timed out";
  EXPECT_LE(ending.took, soon);
  const std::string end = "--steps 800 ";
  ASSERT_EQ(run(2, "resume " + out("run") + " --threads 1 --no-progress " + end, out("told")), 0)
      << bytes_of(out("told"));
  ASSERT_EQ(run(1, "run " + slab + end + "-o " + out("whole")), 0);
  EXPECT_EQ(hash_in(out("run")), hash_in(out("whole")));
}

TEST_F(FateOfRank, stopped_ends_all_with_exit_code_8_soon_after_the_others_lose_patience) {
  for (const int rank : {0, 1}) {
    const Ending ending = suffer(rank, "kill -STOP $pid");
    EXPECT_EQ(ending.exit_code, 8) << ending.told;
    EXPECT_LE(ending.took, 3 + soon);
    EXPECT_EQ(ending.errors(), 1) << ending.told;
    EXPECT_NE(ending.told.find("error: rank " + std::to_string(rank) + " has not answered"),
              std::string::npos)
        << ending.told;
    EXPECT_EQ(left_over(), 0);
    fs::remove_all(out("run"));
  }
}

TEST_F(FateOfRank, stopped_for_less_than_the_others_patience_changes_nothing) {
  const Ending ending = suffer(1, "kill -STOP $pid; sleep 0.7; kill -CONT $pid", "--steps 400 ");
  EXPECT_EQ(ending.exit_code, 0) << ending.told;
  ASSERT_EQ(run(1, "run " + slab + "--steps 400 -o " + out("whole")), 0);
  EXPECT_EQ(hash_in(out("run")), hash_in(out("whole")));
}

TEST_F(FateOfRank, without_memory_ends_all_with_exit_code_5_and_one_message) {
  for (const int rank : {0, 1}) {
    const std::string number = std::to_string(rank);
    const std::string when = "export NO_MEMORY_WHEN=" + out("empty") + " LD_PRELOAD=" + no_memory;
    const Ending ending = suffer(
        rank, "touch " + out("empty"), "",
        "if [ \"${OMPI_COMM_WORLD_RANK:-$PMI_RANK}\" = " + number + " ]; then " + when + "; fi");
    EXPECT_EQ(ending.exit_code, 5) << ending.told;
    EXPECT_LE(ending.took, soon);
    EXPECT_EQ(ending.errors(), 1) << ending.told;
    EXPECT_NE(ending.told.find("not enough memory"), std::string::npos) << ending.told;
    EXPECT_NE(ending.told.find("rank " + number), std::string::npos) << ending.told;
    EXPECT_EQ(left_over(), 0);
    fs::remove_all(out("run"));
    fs::remove(out("empty"));
  }
}

}  // namespace program_test
}  // namespace breccia
