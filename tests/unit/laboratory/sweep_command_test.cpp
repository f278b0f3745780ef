// The command sweep: what is computed, kept, gone on with and told.

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "io/whole_file.hpp"
#include "laboratory/side_by_side.hpp"
#include "run/machine/memory_plan.hpp"
#include "unit/run/program.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace sweep_command_test {

namespace fs = std::filesystem;

/// Two balls that collide head-on; the check holds for approach at 2 m/s and below.
const std::string two_balls = R"(
breccia = 1
method = "dem3d"
energy = { warn = 0.0, stop = 0.0 }
[time]
end = "2 ms"
[output]
frames = 0
fields = false
pictures = false
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
[[probe]]
name = "right_v"
on = "right"
quantity = "velocity_x"
[[check]]
name = "rebound"
value = "probe.right_v.last"
expected = 0.0
tolerance = 2.5
)";

class SweepCommand : public testing::Test {
 protected:
  SweepCommand() { replace_file(scratch / "balls.toml", two_balls); }
  int sweep(const std::string& arguments) {
    return wait_for(
        start_program("sweep '" + scratch / "balls.toml' -o '" + scratch / "out' " + arguments,
                      scratch / "output.txt"));
  }
  std::string output() const { return read_whole_file(scratch / "output.txt"); }
  std::string file(const std::string& name) const {
    return read_whole_file(scratch / "out/" + name);
  }
  static std::size_t count(const std::string& text, const std::string& word) {
    std::size_t found = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
      ++found;
    return found;
  }

  ScratchFolder scratch;
};

TEST_F(SweepCommand, ComputesEachCombinationOnceAndTellsOfTheCheckThatFails) {
  const std::string over = "--over 'body.left.velocity=[1, 0, 0]..[3, 0, 0]:2' --jobs 2";
  EXPECT_EQ(sweep(over), 9);
  EXPECT_EQ(count(output(), "  done "), 1U) << output();
  EXPECT_EQ(count(output(), "check failed"), 1U);
  const std::string table = file("sweep.csv");
  EXPECT_EQ(count(table, "\n"), 3U);
  EXPECT_NE(table.find("\"[3, 0, 0]\",1,check failed,9,2.9"), std::string::npos) << table;
  EXPECT_NE(file("sweep.svg").find("rebound"), std::string::npos);

  EXPECT_EQ(sweep(over + " --seeds 2"), 9);  // two are there already
  EXPECT_EQ(count(output(), "kept"), 2U) << output();
  EXPECT_EQ(count(file("sweep.csv"), "\n"), 5U);

  EXPECT_EQ(sweep(over + " --set check.rebound.tolerance=9"), 0);  // another case
  EXPECT_EQ(count(output(), "kept"), 0U) << output();
}

TEST_F(SweepCommand, ReportsARunThatFailsAndKeepsTheOthers) {
  EXPECT_EQ(sweep("--over energy.stop=0,1e-12"), 4);  // 15 steps a collision cost energy
  const std::string table = file("sweep.csv");
  EXPECT_NE(table.find("\n0,1,done,0,"), std::string::npos) << table;
  EXPECT_NE(table.find("\n1e-12,1,failed,4,"), std::string::npos) << table;
  EXPECT_NE(file("sweep.md").find("## Runs without a result"), std::string::npos);
  EXPECT_NE(output().find("failed"), std::string::npos);
  EXPECT_NE(output().find("energy"), std::string::npos) << output();
}

TEST_F(SweepCommand, NamesTheLogOfEachRunWhereAllFail) {
  EXPECT_EQ(sweep("--over energy.stop=1e-12,1e-13"), 4);
  const std::string table = file("sweep.md");
  EXPECT_NE(table.find("No run has a result."), std::string::npos) << table;
  for (std::size_t at = table.find("all it said: "); at != std::string::npos;
       at = table.find("all it said: ", at + 1)) {
    const std::string log = table.substr(at + 13, table.find('\n', at) - at - 13);
    EXPECT_NE(read_whole_file(log).find("error: "), std::string::npos) << log;
  }
  EXPECT_EQ(count(table, ": exit code 4: "), 2U) << table;
}

TEST_F(SweepCommand, GoesOnWithInterruptedRuns) {
  const std::string arguments = "--over time.end=0.001,300 --jobs 2 --set checkpoint.wall=0.02";
  const pid_t program =
      start_program("sweep '" + scratch / "balls.toml' -o '" + scratch / "out' " + arguments,
                    scratch / "output.txt");
  const auto long_run = [&] {
    for (const auto& entry : fs::directory_iterator(scratch / "out/runs"))
      if (entry.path().filename().string().starts_with("end=300") && entry.is_directory())
        return entry.path();
    return fs::path();
  };
  std::error_code none;
  const auto wait_until = [](const auto& is_so) {
    for (int k = 0; k < 6000 && !is_so(); ++k)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  };
  wait_until([&] {
    return fs::exists(scratch / "output.txt", none) &&
           output().find("1 of 2") != std::string::npos && !long_run().empty() &&
           fs::exists(long_run() / "checkpoints", none) &&
           !fs::is_empty(long_run() / "checkpoints", none);
  });
  ::kill(program, SIGTERM);
  EXPECT_EQ(wait_for(program), 128 + SIGTERM);
  EXPECT_NE(file("sweep.csv").find("300,1,interrupted"), std::string::npos) << file("sweep.csv");
  const std::string former = read_whole_file(long_run() / "history.csv");

  const pid_t again =
      start_program("sweep '" + scratch / "balls.toml' -o '" + scratch / "out' " + arguments,
                    scratch / "output.txt");
  wait_until([&] {
    return count(output(), "kept") == 1 &&
           count(read_whole_file(long_run() / "log.jsonl"), "\"setup\"") == 2;
  });
  ::kill(again, SIGTERM);
  wait_for(again);
  EXPECT_EQ(read_whole_file(long_run() / "history.csv").substr(0, former.size() / 2),
            former.substr(0, former.size() / 2));
  EXPECT_EQ(count(output(), "kept"), 1U) << output();
  // One that began anew would have taken the place of the former, with one set-up in its log.
  EXPECT_EQ(count(read_whole_file(long_run() / "log.jsonl"), "\"setup\""), 2U);
}

TEST_F(SweepCommand, RefusesWrongValuesBeforeAnythingRuns) {
  EXPECT_EQ(sweep("--over body.left.radius=0.01,-1"), 2);
  EXPECT_NE(output().find("radius = -1 is outside"), std::string::npos) << output();
  EXPECT_EQ(sweep("--over body.left.velocity=1,2"), 2);
  EXPECT_NE(output().find("--over body.left.velocity wants three numbers"), std::string::npos)
      << output();
  EXPECT_EQ(sweep("--over time.end=0.001,0.002 --over time.end=0.003"), 2);
  EXPECT_NE(output().find("the key is varied twice"), std::string::npos) << output();
  EXPECT_EQ(sweep("--device gpu"), 2);
  EXPECT_NE(output().find("--device gpu: there are cpu, cuda"), std::string::npos) << output();
  EXPECT_EQ(sweep("--over seed"), 2);
  EXPECT_EQ(sweep("--seeds 0"), 2);
  EXPECT_EQ(sweep("--over body.left.radius=0.01..0.02"), 2);
  EXPECT_NE(output().find("a range says how many values it has"), std::string::npos) << output();
  EXPECT_FALSE(fs::exists(scratch / "out"));
}

TEST_F(SweepCommand, RefusesAMeasureThatNoRunWillHaveBeforeAnyRuns) {
  EXPECT_EQ(sweep("--measure probe.rigt_v.last --measure fracture.fragmens"), 2);
  EXPECT_NE(output().find("--measure probe.rigt_v.last is not of a probe; there are: right_v"),
            std::string::npos)
      << output();
  EXPECT_NE(output().find("--measure fracture.fragmens is no number of summary.json; did you mean "
                          "fracture.fragments?"),
            std::string::npos)
      << output();
  EXPECT_EQ(sweep("--measure probe.right_v.mean"), 2);
  EXPECT_NE(output().find("must end in .last, .min, .max or .peak"), std::string::npos) << output();
  EXPECT_EQ(sweep("--over bdoy.left.radius=0.01,0.02"), 2);
  EXPECT_NE(output().find("--over bdoy is not a key; did you mean body?"), std::string::npos)
      << output();
  EXPECT_FALSE(fs::exists(scratch / "out"));
  EXPECT_EQ(sweep("--measure probe.right_v.peak --measure rebound"), 0);
}

TEST_F(SweepCommand, NamesTheLogOfARunThatEndsWithoutAnError) {
  replace_file(scratch / "mute.sh", "#!/bin/sh\necho ----\necho no ranks for root\nexit 1\n");
  fs::permissions(scratch / "mute.sh", fs::perms::owner_all);
  const int exit_code = wait_for(start_program(
      "sweep '" + scratch / "balls.toml' --ranks 2 -o '" + scratch / "out'", scratch / "output.txt",
      "BRECCIA_MPIRUN='" + scratch / "mute.sh'; export BRECCIA_MPIRUN;"));
  if (output().find("has no MPI") != std::string::npos) GTEST_SKIP() << output();
  EXPECT_EQ(exit_code, 1);
  const std::string words = "seed=1: exit code 1: no ranks for root; all it said: ";
  const std::size_t at = output().find(words);
  ASSERT_NE(at, std::string::npos) << output();
  const std::size_t begin = at + words.size();
  EXPECT_EQ(read_whole_file(output().substr(begin, output().find('\n', begin) - begin)),
            "----\nno ranks for root\n");
}

TEST(GpusForRuns, AreDealtOneEachOrAsManyAsARunHasRanks) {
  const auto dealt = [](int there, int ranks, const std::string& visible = "") {
    std::string text;
    for (const laboratory::Device& device : laboratory::gpus_for(there, ranks, visible))
      text += device.name + " " + device.visible + "; ";
    return text;
  };
  EXPECT_EQ(dealt(2, 1), "cuda:0 ; cuda:1 ; ");
  EXPECT_EQ(dealt(4, 2), "cuda 0,1; cuda 2,3; ");
  EXPECT_EQ(dealt(4, 3), "cuda 0,1,2; ");
  EXPECT_EQ(dealt(1, 2), "cuda 0; ");  // the ranks share it
  EXPECT_EQ(dealt(4, 2, "7,5,3,1"), "cuda 7,5; cuda 3,1; ");
}

TEST(GpusForRuns, EachRunTakesTheOneWithTheFewestRuns) {
  const ScratchFolder scratch;
  replace_file(scratch / "program.sh",
               "#!/bin/sh\necho \"$CUDA_VISIBLE_DEVICES $@\" > $4.said\nsleep 0.1\n");
  fs::permissions(scratch / "program.sh", fs::perms::owner_all);
  std::vector<laboratory::PlannedRun> runs;
  for (const char* name : {"a", "b", "c", "d"})
    runs.push_back({name, "case", {}, scratch / ("runs/" + std::string(name)), name});
  laboratory::Workers workers;
  workers.jobs = 2;
  workers.program = scratch / "program.sh";
  workers.devices = {{"cuda:0", ""}, {"cuda", "2,3"}};
  laboratory::run_side_by_side(runs, workers, [](std::size_t, const auto&) {});
  const auto said = [&](const char* run) {
    return read_whole_file(scratch / ("runs/" + std::string(run) + ".said"));
  };
  EXPECT_NE(said("a").find("--device cuda:0"), std::string::npos) << said("a");
  EXPECT_TRUE(said("b").starts_with("2,3 run") && said("b").find("--device cuda\n") < 1000)
      << said("b");
  const std::string both = said("c") + said("d");
  EXPECT_NE(both.find("--device cuda:0"), std::string::npos) << both;
  EXPECT_NE(both.find("2,3 run"), std::string::npos) << both;
}

/// Runs of a script that says "not enough memory", or is killed, as another one runs beside it.
class RunsWithoutMemory : public testing::TestWithParam<std::string> {
 protected:
  std::vector<laboratory::FinishedRun> made(int jobs) {
    const std::string lock = scratch / "lock";
    replace_file(scratch / "program.sh", "#!/bin/sh\nif mkdir '" + lock +
                                             "'; then sleep 0.3; rmdir '" + lock +
                                             "'; exit 0; fi\n" + GetParam() + "\n");
    fs::permissions(scratch / "program.sh", fs::perms::owner_all);
    std::vector<laboratory::PlannedRun> runs;
    for (const char* name : {"a", "b", "c", "d"})
      runs.push_back({name, "case", {}, scratch / ("runs/" + std::string(name)), name});
    laboratory::Workers workers;
    workers.jobs = jobs;
    workers.program = scratch / "program.sh";
    return laboratory::run_side_by_side(runs, workers, [&](std::size_t, const auto& run) {
      if (run.again_beside > 0)
        put_off.push_back(run.again_beside);
      else
        ++ended;
    });
  }

  ScratchFolder scratch;
  std::vector<int> put_off;
  int ended = 0;
};

TEST_P(RunsWithoutMemory, AreMadeAgainWithFewerAtATime) {
  for (const laboratory::FinishedRun& run : made(3)) EXPECT_EQ(run.exit_code, 0) << run.message;
  EXPECT_EQ(ended, 4);
  ASSERT_FALSE(put_off.empty());
  EXPECT_EQ(put_off.back(), 1);
}

TEST_P(RunsWithoutMemory, HaveFailedWhereTheyWereAlone) {
  fs::create_directory(scratch / "lock");
  for (const laboratory::FinishedRun& run : made(3)) EXPECT_NE(run.exit_code, 0);
  EXPECT_EQ(ended, 4);
}

INSTANTIATE_TEST_SUITE_P(All, RunsWithoutMemory,
                         testing::Values("echo 'error: not enough memory'; exit 5", "kill -9 $$",
                                         "exit 137"));

TEST(WorkersFor, RanksTakeAWholeModelEach) {
  const double bytes = available_memory() / 3.5;
  EXPECT_EQ(laboratory::workers_for(4, 8, bytes).jobs, 3);
  EXPECT_EQ(laboratory::workers_for(4, 8, bytes, 2).jobs, 1);
  EXPECT_EQ(laboratory::workers_for(4, 8, bytes / 4.0, 2).jobs, 4);
  EXPECT_EQ(laboratory::workers_for(100, 8, 0.0).jobs, 8);
}

TEST_F(SweepCommand, CommandsExplainThemselvesInLinesThatFillEightyColumns) {
  for (const std::string command : {"sweep", "test", "calibrate"}) {
    EXPECT_EQ(wait_for(start_program(command + " --help", scratch / "output.txt")), 0);
    std::vector<std::string> lines{""};
    for (const char c : output())
      if (c == '\n')
        lines.emplace_back();
      else
        lines.back() += c;
    bool options = true;  // then paragraphs
    for (std::size_t k = 0; k + 1 < lines.size(); ++k) {
      EXPECT_LE(lines[k].size(), 80U) << lines[k];
      if (lines[k].find("--allow-scripts") != std::string::npos) options = false;
      if (options || lines[k].empty() || lines[k].starts_with(' ') || lines[k + 1].empty())
        continue;
      const std::size_t next = std::min(lines[k + 1].find(' '), lines[k + 1].size());
      EXPECT_GT(lines[k].size() + 1 + next, 76U) << command << ": " << lines[k];
    }
  }
}

}  // namespace sweep_command_test
}  // namespace breccia
