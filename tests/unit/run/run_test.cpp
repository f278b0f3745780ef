#include "run/run.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <thread>

#include "exec/error.hpp"
#include "run/method/doubts.hpp"
#include "unit/run/fake_run.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace run_test {

namespace fs = std::filesystem;

/// Starts the function in a process of its own; its exit code is what the function returns or the
/// code of the error it throws.
pid_t start_process(const std::function<int()>& function) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  int code = 99;
  try {
    code = function();
  } catch (const Error& error) {
    code = error.exit_code();
  }
  ::_exit(code);
}

/// The exit code, or minus the number of the signal that killed it.
int wait_for(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

std::vector<std::string> temporary_files(const std::string& path) {
  std::vector<std::string> found;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path))
    if (entry.path().extension() == ".tmp") found.push_back(entry.path());
  return found;
}

TEST(Run, TellsWhatSetUpFindsDoubtful) {
  const ScratchFolder scratch;
  Trouble trouble;
  trouble.doubts = {"one triangle rules the step", "edges are long"};
  EXPECT_EQ(run_fake(fake_plan(), scratch / "out", trouble), 0);
  const nlohmann::json summary = summary_of(scratch / "out");
  EXPECT_EQ(summary["warnings"], nlohmann::json(trouble.doubts));
  const std::string log = read_whole_file(scratch / "out/log.jsonl");
  for (const std::string& doubt : trouble.doubts)
    EXPECT_NE(
        log.find("\"level\":\"warning\",\"stage\":\"setup\",\"step\":0,\"message\":\"" + doubt),
        std::string::npos)
        << log;
  EXPECT_EQ(run_fake(fake_plan(), scratch / "quiet"), 0);
  EXPECT_FALSE(summary_of(scratch / "quiet").contains("warnings"));
}

/// Whoever goes on was told at the start.
TEST(Run, ThatGoesOnTellsNoDoubtTwice) {
  const ScratchFolder scratch;
  RunPlan plan = fake_plan();
  plan.warnings = {"edges are long"};
  RunPlan half = plan;
  half.limits.steps = 50;
  EXPECT_EQ(run_fake(half, scratch / "out"), 0);
  plan.warnings.emplace_back("frames are far apart");
  EXPECT_EQ(resume_fake(plan, scratch / "out"), 0);
  EXPECT_EQ(summary_of(scratch / "out")["warnings"], nlohmann::json(plan.warnings));
  const std::string log = read_whole_file(scratch / "out/log.jsonl");
  for (const std::string& doubt : plan.warnings) {
    const auto first = log.find(doubt);
    EXPECT_NE(first, std::string::npos) << log;
    EXPECT_EQ(log.find(doubt, first + 1), std::string::npos) << log;
  }
}

/// Steps are not cut, so a run of a few goes well beyond its end.
TEST(Run, TellsThatItsStepsAreLong) {
  EXPECT_EQ(long_step_text(1.99e-3, 0.1), "");
  EXPECT_EQ(long_step_text(0.25e-3, 5e-3),
            "time.end: a step of 250 us is 5 % of 5 ms, and the last one may pass the end by as "
            "much; time.max_step = \"50 us\" makes a hundred of the run");
  const ScratchFolder scratch;
  RunPlan plan = fake_plan();
  plan.config.time.end = 0.4;
  EXPECT_EQ(run_fake(plan, scratch / "out"), 0);
  EXPECT_EQ(summary_of(scratch / "out")["warnings"].size(), 1U);
  plan.limits.steps = 10;  // it does not go to its end
  EXPECT_EQ(run_fake(plan, scratch / "part"), 0);
  EXPECT_FALSE(summary_of(scratch / "part").contains("warnings"));
}

TEST(Run, EndsAtTheFirstStepAtOrPastItsEnd) {
  const ScratchFolder scratch;
  EXPECT_EQ(run_fake(fake_plan(), scratch / "out"), 0);
  const nlohmann::json summary = summary_of(scratch / "out");
  EXPECT_EQ(summary["status"], "done");
  EXPECT_EQ(summary["exit_code"], 0);
  EXPECT_GE(summary["time"].get<double>(), 2.0);
  EXPECT_LT(summary["time"].get<double>() - summary["dt"]["last"].get<double>(), 2.0);
  EXPECT_EQ(summary["model"]["elements_by_group"]["bars"], 4);
  EXPECT_EQ(summary["searches"], 2);
  EXPECT_GT(summary["step_us"]["median"].get<double>(), 0.0);
  EXPECT_EQ(read_whole_file(scratch / "out/case.toml"), fake_plan().case_text);
}

TEST(Run, StateDoesNotDependOnWhatIsWritten) {
  const ScratchFolder scratch;
  RunPlan busy = fake_plan();
  busy.config.output.frames = 37;
  busy.config.output.history = 0.013;
  busy.config.checkpoint.steps = 7;
  run_fake(fake_plan(), scratch / "calm");
  run_fake(busy, scratch / "busy");
  EXPECT_EQ(summary_of(scratch / "calm")["state_hash"], summary_of(scratch / "busy")["state_hash"]);
  EXPECT_EQ(summary_of(scratch / "calm")["steps"], summary_of(scratch / "busy")["steps"]);
}

TEST(Run, InterruptedAndResumedLeavesWhatAnUnbrokenRunLeaves) {
  const ScratchFolder scratch;
  run_fake(fake_plan(), scratch / "whole");
  const std::string history = read_whole_file(scratch / "whole/history.csv");
  const nlohmann::json whole = summary_of(scratch / "whole");
  for (const std::int64_t step : {1, 50, 51, 137}) {
    const std::string path = scratch / std::to_string(step);
    Trouble trouble;
    trouble.signal_at = step;
    EXPECT_EQ(run_fake(fake_plan(), path, trouble), 128 + SIGTERM);
    EXPECT_EQ(summary_of(path)["status"], "interrupted");
    EXPECT_EQ(summary_of(path)["steps"], step);
    EXPECT_EQ(resume_fake(fake_plan(), path), 0);
    const nlohmann::json resumed = summary_of(path);
    for (const char* key : {"status", "steps", "time", "dt", "state_hash", "energy", "probe"})
      EXPECT_EQ(resumed[key], whole[key]) << key << " after step " << step;
    EXPECT_EQ(read_whole_file(path + "/history.csv"), history);
  }
}

TEST(Run, ThatWasCutShortEndsWhereItIsTold) {
  const ScratchFolder scratch;
  Trouble trouble;
  trouble.signal_at = 77;
  run_fake(fake_plan(), scratch / "cut", trouble);
  RunPlan longer = fake_plan();
  longer.config.time.end *= 1.5;
  longer.ends_anew = true;
  EXPECT_EQ(resume_fake(longer, scratch / "cut"), 0);
  EXPECT_GE(summary_of(scratch / "cut")["time"], longer.config.time.end);
}

TEST(Run, WritesARowAStepAndPicturesOfSteps) {
  const ScratchFolder scratch;
  RunPlan plan = fake_plan();
  plan.config.output.step_times = true;
  plan.config.output.picture_steps = {0.0, 31.0, 31.5, 150.0, 1e9};
  plan.config.output.width = plan.config.output.height = 64;
  run_fake(plan, scratch / "whole");
  Trouble trouble;
  trouble.signal_at = 77;
  run_fake(plan, scratch / "cut", trouble);
  resume_fake(plan, scratch / "cut");
  run_fake(fake_plan(), scratch / "calm");
  EXPECT_FALSE(fs::exists(scratch / "calm/steps.csv"));
  for (const char* name : {"whole", "cut"}) {
    const std::string path = scratch / name;
    EXPECT_EQ(summary_of(path)["state_hash"], summary_of(scratch / "calm")["state_hash"]);
    std::ifstream rows(path + "/steps.csv");
    std::string line;
    std::getline(rows, line);
    EXPECT_EQ(line, "step,time,wall,searches");
    std::getline(rows, line);
    EXPECT_EQ(line, "-,s,s,-");
    std::int64_t step = 0;
    for (; std::getline(rows, line); ++step)
      EXPECT_TRUE(line.starts_with(std::to_string(step + 1) + ",")) << line;
    EXPECT_EQ(summary_of(path)["steps"], step);
    std::set<std::string> pictures;
    for (const auto& entry : fs::directory_iterator(path + "/pictures"))
      pictures.insert(entry.path().filename());
    EXPECT_EQ(pictures,
              (std::set<std::string>{"step_0.png", "step_150.png", "step_31.png", "step_32.png"}));
    EXPECT_EQ(read_whole_file(path + "/pictures/step_150.png"),
              read_whole_file(scratch / "whole/pictures/step_150.png"));
  }
}

TEST(Run, KilledBetweenCheckpointsResumesWithoutDoubledRows) {
  const ScratchFolder scratch;
  RunPlan plan = fake_plan();
  plan.config.checkpoint.steps = 40;
  run_fake(plan, scratch / "whole");
  Trouble trouble;
  trouble.signal_at = 113;
  trouble.signal = SIGKILL;
  EXPECT_EQ(wait_for(start_process([&] { return run_fake(plan, scratch / "killed", trouble); })),
            -SIGKILL);
  std::ofstream(scratch / "killed/history.csv", std::ios::app) << "113,1.2";  // half a row
  EXPECT_EQ(resume_fake(plan, scratch / "killed"), 0);
  EXPECT_EQ(read_whole_file(scratch / "killed/history.csv"),
            read_whole_file(scratch / "whole/history.csv"));
  EXPECT_EQ(summary_of(scratch / "killed")["state_hash"],
            summary_of(scratch / "whole")["state_hash"]);
}

TEST(Run, SentOnlyPartOfTheWayGoesOnToTheEndOfItsCase) {
  const ScratchFolder scratch;
  run_fake(fake_plan(), scratch / "whole");
  RunPlan part = fake_plan();
  part.limits.steps = 77;
  EXPECT_EQ(run_fake(part, scratch / "part"), 0);
  EXPECT_EQ(summary_of(scratch / "part")["steps"], 77);
  EXPECT_EQ(resume_fake(fake_plan(), scratch / "part"), 0);
  EXPECT_EQ(summary_of(scratch / "part")["state_hash"],
            summary_of(scratch / "whole")["state_hash"]);
  EXPECT_EQ(read_whole_file(scratch / "part/history.csv"),
            read_whole_file(scratch / "whole/history.csv"));
}

TEST(Run, CutShortGoesOnToWhereItWasSent) {
  const ScratchFolder scratch;
  RunPlan part = fake_plan();
  part.limits.steps = 77;
  Trouble trouble;
  trouble.signal_at = 30;
  run_fake(part, scratch / "part", trouble);
  EXPECT_EQ(resume_fake(fake_plan(), scratch / "part"), 0);
  EXPECT_EQ(summary_of(scratch / "part")["steps"], 77);
}

TEST(Run, KeepsTheNewestCheckpoints) {
  const ScratchFolder scratch;
  RunPlan plan = fake_plan();
  plan.config.checkpoint.steps = 25;
  plan.config.checkpoint.keep = 3;
  plan.limits.steps = 110;
  run_fake(plan, scratch / "out");
  const auto files = list_checkpoints(scratch / "out/checkpoints");
  ASSERT_EQ(files.size(), 3U);
  EXPECT_EQ(files[0].step, 110);
  EXPECT_EQ(files[1].step, 100);
  EXPECT_EQ(files[2].step, 75);
}

TEST(Run, KeepsNoCheckpointIfNoneIsAskedFor) {
  const ScratchFolder scratch;
  RunPlan plan = fake_plan();
  plan.config.checkpoint.steps = 25;
  plan.config.checkpoint.keep = 0;
  run_fake(plan, scratch / "whole");
  EXPECT_TRUE(list_checkpoints(scratch / "whole/checkpoints").empty());
  EXPECT_EQ(summary_of(scratch / "whole")["status"], "done");
  Trouble trouble;
  trouble.signal_at = 60;
  run_fake(plan, scratch / "cut", trouble);
  EXPECT_TRUE(list_checkpoints(scratch / "cut/checkpoints").empty());
  const std::string message = summary_of(scratch / "cut")["message"];
  EXPECT_NE(message.find("no state saved"), std::string::npos) << message;
  EXPECT_THROW(resume_fake(plan, scratch / "cut"), CheckpointError);
}

TEST(Run, GoesBackToAnOlderCheckpointIfTheNewestIsDamaged) {
  const ScratchFolder scratch;
  RunPlan plan = fake_plan();
  plan.config.checkpoint.steps = 40;
  run_fake(plan, scratch / "whole");
  Trouble trouble;
  trouble.signal_at = 90;
  run_fake(plan, scratch / "out", trouble);
  const std::string newest = list_checkpoints(scratch / "out/checkpoints")[0].path;
  fs::resize_file(newest, fs::file_size(newest) - 5);
  std::string warnings;
  EXPECT_EQ(resume_fake(plan, scratch / "out", &warnings), 0);
  EXPECT_NE(warnings.find(newest), std::string::npos) << warnings;
  EXPECT_EQ(read_whole_file(scratch / "out/history.csv"),
            read_whole_file(scratch / "whole/history.csv"));
  EXPECT_EQ(summary_of(scratch / "out")["state_hash"], summary_of(scratch / "whole")["state_hash"]);
}

TEST(Run, IsRefusedWithoutAnyGoodCheckpoint) {
  const ScratchFolder scratch;
  run_fake(fake_plan(), scratch / "out");
  for (const CheckpointFile& file : list_checkpoints(scratch / "out/checkpoints"))
    fs::resize_file(file.path, 10);
  EXPECT_THROW(resume_fake(fake_plan(), scratch / "out"), CheckpointError);
}

TEST(Run, RefusesACheckpointOfAnotherCase) {
  const ScratchFolder scratch;
  run_fake(fake_plan(), scratch / "out");
  RunPlan other = fake_plan();
  other.model_digest = "digest of another";
  EXPECT_THROW(resume_fake(other, scratch / "out"), CheckpointError);
}

TEST(Run, StopsAtWrongNumbersAndSavesTheState) {
  const ScratchFolder scratch;
  Trouble trouble;
  trouble.spoil_at = 60;
  EXPECT_THROW(run_fake(fake_plan(), scratch / "out", trouble), NumericsError);
  const nlohmann::json summary = summary_of(scratch / "out");
  EXPECT_EQ(summary["status"], "failed");
  EXPECT_EQ(summary["exit_code"], 4);
  EXPECT_NE(summary["message"].get<std::string>().find("element 3"), std::string::npos);
  EXPECT_TRUE(CheckpointReader(scratch / "out/crash.br").has("fake.position"));
}

TEST(Run, AsksNothingOfAStateThatMemoryWasMissingFor) {
  const ScratchFolder scratch;
  Trouble trouble;
  trouble.no_memory_at = 60;
  EXPECT_THROW(run_fake(fake_plan(), scratch / "out", trouble), DeviceError);
  const nlohmann::json summary = summary_of(scratch / "out");
  EXPECT_EQ(summary["status"], "failed");
  EXPECT_EQ(summary["exit_code"], 5);
  EXPECT_FALSE(summary.contains("state_hash"));
  EXPECT_FALSE(summary.contains("energy"));
}

TEST(Run, NamesStepAndElementOfAFailureThatKnowsNeither) {
  const ScratchFolder scratch;
  Trouble trouble;
  trouble.lose_at = trouble.spoil_at = 60;
  EXPECT_THROW(run_fake(fake_plan(), scratch / "found", trouble), NumericsError);
  const auto message = [&](const std::string& name) {
    return summary_of(scratch / name)["message"].get<std::string>();
  };
  EXPECT_TRUE(message("found").starts_with("step 60: element 3 is not a number\n"))
      << message("found");
  trouble.spoil_at = -1;
  EXPECT_THROW(run_fake(fake_plan(), scratch / "unfound", trouble), NumericsError);
  EXPECT_TRUE(message("unfound").starts_with("step 60, t = ")) << message("unfound");
  EXPECT_NE(message("unfound").find(" s: the element at place 3 is lost\n"), std::string::npos);
}

TEST(Run, NeverSavesWrongNumbersAsACheckpoint) {
  const ScratchFolder scratch;
  RunPlan plan = fake_plan();
  plan.config.output.frames = 0;
  plan.config.output.history = 10.0;
  plan.config.checkpoint.steps = 40;
  Trouble trouble;
  trouble.spoil_at = 60;
  EXPECT_THROW(run_fake(plan, scratch / "out", trouble), NumericsError);
  EXPECT_EQ(list_checkpoints(scratch / "out/checkpoints").at(0).step, 40);
}

TEST(Run, FailsIfACheckOfTheCaseFails) {
  const ScratchFolder scratch;
  RunPlan plan = fake_plan();
  plan.config.checks = {CheckConfig{"elements", "model.elements", -1.0, 4.0, 0.0, "-"},
                        CheckConfig{"peak", "probe.first.max", -1.0, 1.0, 1e-12, "m"}};
  EXPECT_EQ(run_fake(plan, scratch / "good"), 0);
  EXPECT_EQ(summary_of(scratch / "good")["checks"].size(), 2U);
  plan.config.checks[1].expected = 1.1;
  EXPECT_THROW(run_fake(plan, scratch / "bad"), CheckFailed);
  const nlohmann::json summary = summary_of(scratch / "bad");
  EXPECT_EQ(summary["exit_code"], 9);
  EXPECT_EQ(summary["checks"][0]["pass"], true);
  EXPECT_EQ(summary["checks"][1]["pass"], false);
  plan.limits.steps = 5;
  EXPECT_EQ(run_fake(plan, scratch / "short"), 0) << "a run cut short makes no checks";
}

TEST(Run, AnswersASignalFromOutsideWithACheckpoint) {
  const ScratchFolder scratch;
  for (const int signal : {SIGTERM, SIGINT, SIGUSR1}) {
    const std::string path = scratch / std::to_string(signal);
    Trouble trouble;
    trouble.pause = 0.05;
    RunPlan plan = fake_plan();
    const pid_t child = start_process([&] { return run_fake(plan, path, trouble); });
    while (!fs::exists(path + "/summary.json") || !fs::exists(path + "/case.toml"))
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ::kill(child, signal);
    EXPECT_EQ(wait_for(child), 128 + signal);
    EXPECT_EQ(summary_of(path)["status"], "interrupted");
    EXPECT_EQ(list_checkpoints(path + "/checkpoints").size(), 1U);
  }
}

TEST(Run, StopsAtOnceAtASecondSignal) {
  const ScratchFolder scratch;
  Trouble trouble;
  trouble.pause = 30.0;
  const pid_t child =
      start_process([&] { return run_fake(fake_plan(), scratch / "out", trouble); });
  while (!fs::exists(scratch / "out/case.toml"))
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ::kill(child, SIGTERM);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  ::kill(child, SIGTERM);
  EXPECT_EQ(wait_for(child), 128 + SIGTERM);
}

TEST(Run, OnAFullDiskKeepsOlderCheckpointsAndNoHalfFiles) {
  const ScratchFolder scratch;
  RunPlan plan = fake_plan();
  plan.config.checkpoint.steps = 10;
  plan.config.output.fields = false;
  plan.config.output.history = 0.005;
  // The history outgrows the limit; files of the size of a checkpoint do not.
  const pid_t child = start_process([&] {
    const struct rlimit limit { 8192, 8192 };
    ignore_quota_signal();
    ::setrlimit(RLIMIT_FSIZE, &limit);
    return run_fake(plan, scratch / "out");
  });
  EXPECT_EQ(wait_for(child), 3);
  EXPECT_EQ(summary_of(scratch / "out")["exit_code"], 3);
  const std::string history = read_whole_file(scratch / "out/history.csv");
  EXPECT_EQ(history.back(), '\n');
  EXPECT_LE(history.size(), 8192U);
  EXPECT_TRUE(temporary_files(scratch / "out").empty());
  const auto files = list_checkpoints(scratch / "out/checkpoints");
  ASSERT_EQ(files.size(), 2U);
  for (const CheckpointFile& file : files) EXPECT_NO_THROW(CheckpointReader{file.path});
}

TEST(Run, TellsOfItsFailureOnADiskThatIsFull) {
  const ScratchFolder scratch;
  RunPlan plan = fake_plan();
  plan.config.output.frames = 0;
  plan.config.output.history = 0.005;
  plan.config.checkpoint.wall = 1e9;
  // A disk of 128 KiB in a name space of the child's own; where mounting is not allowed there is
  // none.
  const pid_t child = start_process([&] {
    if (::unshare(CLONE_NEWNS) != 0 ||
        ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        ::mount("tmpfs", scratch.path().c_str(), "tmpfs", 0, "size=128k") != 0)
      return 0;
    {
      std::ofstream filler(scratch / "filler");
      filler << std::string(96 << 10, 'x');
    }
    int code = 0;
    try {
      code = run_fake(plan, scratch / "out");
    } catch (const Error& error) {
      code = error.exit_code();
    }
    const nlohmann::json summary = summary_of(scratch / "out");
    return code == 3 && summary["status"] == "failed" && summary["exit_code"] == 3 ? 0 : 1;
  });
  EXPECT_EQ(wait_for(child), 0);
}

TEST(Run, EndsWithAnErrorIfItsHistoryIsRemoved) {
  const ScratchFolder scratch;
  Trouble trouble;
  trouble.pause = 0.02;
  const pid_t child =
      start_process([&] { return run_fake(fake_plan(), scratch / "out", trouble); });
  while (!fs::exists(scratch / "out/history.csv"))
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  fs::remove(scratch / "out/history.csv");
  EXPECT_EQ(wait_for(child), 3);
  EXPECT_NE(summary_of(scratch / "out")["message"].get<std::string>().find("history.csv"),
            std::string::npos);
}

TEST(Run, ThatCannotWriteACheckpointKeepsTheOlderOnes) {
  const ScratchFolder scratch;
  RunPlan plan = fake_plan();
  plan.limits.steps = 20;
  run_fake(plan, scratch / "out");
  plan.limits.steps = 40;
  const pid_t child = start_process([&] {
    const struct rlimit limit { 1100, 1100 };  // case.toml fits, a checkpoint does not
    ignore_quota_signal();
    ::setrlimit(RLIMIT_FSIZE, &limit);
    return resume_fake(plan, scratch / "out");
  });
  EXPECT_EQ(wait_for(child), 3);
  EXPECT_TRUE(temporary_files(scratch / "out").empty());
  EXPECT_EQ(resume_fake(plan, scratch / "out"), 0);
}

}  // namespace run_test
}  // namespace breccia
