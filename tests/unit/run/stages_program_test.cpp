// A case with stages as scripts see it: what its files tell, and runs that end or are killed in one
// stage and go on.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "io/whole_file.hpp"
#include "report/table.hpp"
#include "texts.hpp"
#include "unit/run/program.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace stages_program_test {

/// Two balls that a wall brings together, one held, then free.
const std::string staged = R"(
[time]
end = "40 ms"
safety = 0.2
[output]
frames = 0
[material.rock]
law = "grain"
young = "1 GPa"
[[body]]
name = "low"
shape = "element"
material = "rock"
center = [0.0, 0.0, 0.010]
radius = "10 mm"
[[body]]
name = "high"
shape = "element"
material = "rock"
center = [0.0, 0.0, 0.031]
radius = "10 mm"
[[wall]]
name = "floor"
[[support]]
name = "held"
on = "high"
[[probe]]
name = "place"
on = "high"
quantity = "position_z"
[[stage]]
name = "lower"
[[stage.support]]
name = "held"
velocity = [0.0, 0.0, "-0.5 m/s"]
)";
const std::string ends =
    "[[stage]]\nname = \"free\"\nuntil = \"4 ms\"\ngravity = [0.0, 0.0, -9.81]\n"
    "[[stage.support]]\nname = \"held\"\nfix = []\n";
std::string with_end(const std::string& rule) {
  std::string text = staged;
  const std::string name = "name = \"lower\"\n";
  return text.insert(text.find(name) + name.size(), rule) + ends;
}

class StagedProgram : public ::testing::Test {
 protected:
  StagedProgram() { replace_file(path("case.toml"), with_end("when = \"place < 0.0295\"\n")); }
  std::string path(const std::string& name) const { return folder_ / name; }
  int run(const std::string& arguments) const {
    const bool steps = !arguments.starts_with("check");
    return wait_for(start_program(arguments + (steps ? " --threads 1" : ""), path("output.txt")));
  }
  std::string output() const { return read_whole_file(path("output.txt")); }
  nlohmann::json summary(const std::string& out) const {
    return parsed_json(read_whole_file(path(out + "/summary.json")));
  }
  ScratchFolder folder_;
};

TEST_F(StagedProgram, EndsAStageByANumberWithAUnit) {
  ASSERT_EQ(run("run " + path("case.toml") + " -o " + path("si")), 0) << output();
  for (const char* rule : {"place < 29.5 mm", "place <= 2.95 cm"}) {
    replace_file(path("case.toml"), with_end("when = \"" + std::string(rule) + "\"\n"));
    ASSERT_EQ(run("run " + path("case.toml") + " --force -o " + path("out")), 0) << output();
    EXPECT_EQ(summary("out")["state_hash"], summary("si")["state_hash"]) << rule;
  }
  replace_file(path("case.toml"), with_end("when = \"place < 29.5 kN\"\n"));
  ASSERT_EQ(run("check " + path("case.toml")), 2);
  EXPECT_NE(output().find("stage.lower.when"), std::string::npos) << output();
  EXPECT_NE(output().find("probe place reads position_z, in m"), std::string::npos) << output();
  EXPECT_NE(output().find("line "), std::string::npos) << output();
}

TEST_F(StagedProgram, TellsItsStagesAndEndsWithTheLast) {
  ASSERT_EQ(run("run " + path("case.toml") + " -o " + path("out")), 0) << output();
  const nlohmann::json s = summary("out");
  ASSERT_EQ(s["stage"].size(), 2U);
  EXPECT_EQ(s["stage"][0]["name"], "lower");
  EXPECT_EQ(s["stage"][0]["ended_by"], "probe");
  EXPECT_NEAR(s["stage"][0]["end"], 3e-3, 2e-3);
  EXPECT_EQ(s["stage"][1]["ended_by"], "time");
  EXPECT_EQ(output().find("has not begun"), std::string::npos);
  EXPECT_NEAR(s["time"], s["stage"][1]["begin"].get<double>() + 4e-3, 1e-4);
  const std::string history = read_whole_file(path("out/history.csv"));
  EXPECT_NE(history.find(",place,stage\n"), std::string::npos);
  EXPECT_NE(history.find(",lower\n"), std::string::npos);
  EXPECT_NE(history.find(",free\n"), std::string::npos);
  EXPECT_EQ(report::read_table(path("out/history.csv")).column("stage"), nullptr);
  EXPECT_NE(report::read_table(path("out/history.csv")).column("place"), nullptr);
}

TEST_F(StagedProgram, CountsStepsToTheEndOfItsLastStage) {
  ASSERT_EQ(run("run " + path("case.toml") + " --steps 1 -o " + path("by_probe")), 0) << output();
  ASSERT_EQ(run("run " + path("case.toml") + " --until 1e-4 -o " + path("short")), 0) << output();
  EXPECT_NE(output().find(" steps to 100 us\n"), std::string::npos) << output();
  ASSERT_EQ(run("run " + path("case.toml") + " -o " + path("whole")), 0) << output();
  EXPECT_NE(output().find("   at most about "), std::string::npos) << output();
  EXPECT_NE(output().find(" steps to 40 ms\n"), std::string::npos) << output();
  replace_file(path("case.toml"), with_end("until = \"3 ms\"\n"));
  ASSERT_EQ(run("run " + path("case.toml") + " --stage lower -o " + path("timed")), 0) << output();
  EXPECT_NE(output().find("   about "), std::string::npos) << output();
  EXPECT_NE(output().find(" steps to 3 ms\n"), std::string::npos) << output();
  ASSERT_EQ(run("resume " + path("timed")), 0) << output();
  EXPECT_NE(output().find(" steps to 7"), std::string::npos) << output();
}

TEST_F(StagedProgram, DrawsTheEndOfEachStage) {
  ASSERT_EQ(run("run " + path("case.toml") + " --set output.frames=1 -o " + path("out")), 0)
      << output();
  const nlohmann::json s = summary("out");
  const std::string first = read_whole_file(path("out/pictures/stage_lower.png")),
                    last = read_whole_file(path("out/pictures/stage_free.png"));
  EXPECT_TRUE(first.starts_with("\x89PNG"));
  EXPECT_NE(first, last);
  ASSERT_EQ(run("run " + path("case.toml") + " -o " + path("bare")), 0) << output();
  EXPECT_EQ(s["state_hash"], summary("bare")["state_hash"]);
  EXPECT_FALSE(std::filesystem::exists(path("bare/pictures/stage_lower.png")));
}

TEST_F(StagedProgram, GoesOnFromAnyStageToTheSameEnd) {
  ASSERT_EQ(run("run " + path("case.toml") + " -o " + path("whole")), 0) << output();
  const nlohmann::json whole = summary("whole");
  ASSERT_EQ(run("run " + path("case.toml") + " --stage lower -o " + path("first")), 0) << output();
  EXPECT_EQ(summary("first")["stage"].size(), 1U);
  EXPECT_NE(summary("first")["state_hash"], whole["state_hash"]);
  ASSERT_EQ(run("resume " + path("first")), 0) << output();
  EXPECT_EQ(summary("first")["state_hash"], whole["state_hash"]);
  EXPECT_EQ(summary("first")["stage"], whole["stage"]);
  EXPECT_EQ(read_whole_file(path("first/history.csv")), read_whole_file(path("whole/history.csv")));
  const auto steps = whole["steps"].get<std::int64_t>();
  ASSERT_EQ(run("run " + path("case.toml") + " --steps " + std::to_string(steps - 30) + " -o " +
                path("cut")),
            0)
      << output();
  EXPECT_EQ(summary("cut")["stage"].size(), 2U);
  ASSERT_EQ(run("resume " + path("cut")), 0) << output();
  EXPECT_EQ(summary("cut")["state_hash"], whole["state_hash"]);
}

TEST_F(StagedProgram, LeavesCurvesHoweverItEnds) {
  ASSERT_EQ(run("run " + path("case.toml") + " --stage lower -o " + path("stage")), 0) << output();
  replace_file(path("wrong.toml"), with_end("until = \"1 ms\"\n") +
                                       "[[check]]\nname = \"never\"\nvalue = \"probe.place.max\"\n"
                                       "expected = 1.0\ntolerance = 0.1\n");
  ASSERT_NE(run("run " + path("wrong.toml") + " -o " + path("failed")), 0) << output();
  EXPECT_EQ(summary("failed")["message"], "a check of the case failed");
  for (const char* out : {"stage", "failed"})
    EXPECT_NE(read_whole_file(path(std::string(out) + "/curves.svg")).find("<svg"),
              std::string::npos);
}

TEST_F(StagedProgram, WarnsOfStagesThatNeverBegan) {
  replace_file(path("long.toml"), with_end("until = \"1 s\"\n"));
  ASSERT_EQ(run("run " + path("long.toml") + " -o " + path("out")), 0) << output();
  EXPECT_NE(output().find("stage free has not begun"), std::string::npos) << output();
  EXPECT_NE(summary("out")["warnings"].dump().find("has not begun"), std::string::npos);
}

TEST_F(StagedProgram, RefusesStagesThatCannotBe) {
  EXPECT_EQ(run("run " + path("case.toml") + " --stage fall -o " + path("out")), 2) << output();
  EXPECT_NE(output().find("there are: lower, free"), std::string::npos) << output();
  replace_file(path("endless.toml"), with_end(""));
  EXPECT_EQ(run("check " + path("endless.toml")), 2);
  EXPECT_NE(output().find("stage.lower never ends"), std::string::npos) << output();
}

}  // namespace stages_program_test
}  // namespace breccia
