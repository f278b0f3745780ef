// The program itself, as scripts see it: exit codes, what it writes and what it leaves alone.

#include <signal.h>

#include <sstream>

#include "paths.hpp"
#include "run/results/checkpoints.hpp"
#include "unit/run/program_fixture.hpp"

namespace breccia {
namespace program_test {

TEST_F(Program, RunsACaseAndLeavesItsResultFolder) {
  ASSERT_EQ(run("run " + path("balls.toml") + " -o " + path("out")), 0) << output();
  for (const char* name : {"case.toml", "summary.json", "history.csv", "log.jsonl", "checkpoints",
                           "fields", "elements.pvd", "pictures/0000.png", "pictures/0002.png"})
    EXPECT_TRUE(fs::exists(path("out/") + name)) << name;
  EXPECT_EQ(summary("out")["status"], "done");
  EXPECT_EQ(summary("out")["model"]["elements"], 2);
  EXPECT_EQ(summary("out")["checks"][0]["pass"], true);
  EXPECT_EQ(summary("out")["case"]["sha256"].get<std::string>().size(), 64U);
}

TEST_F(Program, TellsAtItsEndWhatTheRunShows) {
  ASSERT_EQ(run("run " + path("balls.toml") + " -o " + path("out")), 0) << output();
  EXPECT_NE(output().find("shows   Nothing can break here"), std::string::npos) << output();
  replace_file(path("held.toml"), two_balls +
                                      "[[check]]\nname = \"wrong\"\nvalue = "
                                      "\"model.elements\"\nexpected = 3\n");
  ASSERT_EQ(run("run " + path("held.toml") + " -o " + path("failed")), 9);
  EXPECT_NE(output().find("shows   Nothing can break here"), std::string::npos) << output();
}

TEST_F(Program, ACaseMayAskForItsReport) {
  ASSERT_EQ(run("run " + path("balls.toml") + " --set output.report=true -o " + path("out")), 0)
      << output();
  EXPECT_NE(output().find("report  " + path("out/report.html")), std::string::npos) << output();
  const std::string html = read_whole_file(path("out/report.html"));
  fs::remove(path("out/report.html"));
  ASSERT_EQ(run("report " + path("out")), 0) << output();
  EXPECT_EQ(read_whole_file(path("out/report.html")), html);
  EXPECT_EQ(summary("out")["status"], "done");
}

TEST_F(Program, CompletedCaseRunsToTheSameState) {
  ASSERT_EQ(run("run " + path("balls.toml") + " -o " + path("first")), 0) << output();
  ASSERT_EQ(run("run " + path("first/case.toml") + " -o " + path("again")), 0) << output();
  EXPECT_EQ(summary("first")["state_hash"], summary("again")["state_hash"]);
  EXPECT_EQ(summary("first")["case"]["sha256"], summary("again")["case"]["sha256"]);
}

TEST_F(Program, RefusesBadInputAndWritesNothing) {
  replace_file(path("bad.toml"), two_balls + "\n[tme]\nend = 1.0\n");
  EXPECT_EQ(run("run " + path("bad.toml") + " -o " + path("out")), 2);
  EXPECT_NE(output().find("tme"), std::string::npos) << output();
  EXPECT_EQ(run("run " + path("balls.toml") + " --set time.end=-1 -o " + path("out")), 2);
  EXPECT_EQ(run("run " + path("balls.toml") + " --no-such-option -o " + path("out")), 2);
  EXPECT_EQ(run("run " + path("balls.toml") + " --threads 0 -o " + path("out")), 2);
  EXPECT_EQ(run("check " + path("balls.toml") + " --set body.left.radius=1e300"), 2) << output();
  EXPECT_EQ(run("run " + path("balls.toml") + " --set output.color=damgae -o " + path("out")), 2);
  EXPECT_NE(output().find("damage, force, group"), std::string::npos) << output();
  EXPECT_EQ(run("check " + path("balls.toml") + " --set check.elements.value=model.elemnts"), 2);
  EXPECT_NE(output().find("did you mean model.elements?"), std::string::npos) << output();
  EXPECT_EQ(run("check " + path("bad.toml") + " " + path("balls.toml")), 2);
  EXPECT_EQ(run("check " + path("balls.toml")), 0) << output();
  EXPECT_EQ(run(""), 2);
  EXPECT_EQ(run("chekc " + path("balls.toml")), 2);
  EXPECT_NE(output().find("chekc is not a command; did you mean check?"), std::string::npos)
      << output();
  EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(Program, NamesAFileItCannotReadOrAFolderItCannotWrite) {
  EXPECT_EQ(run("run " + path("none.toml")), 3);
  EXPECT_NE(output().find("none.toml"), std::string::npos) << output();
  EXPECT_EQ(run("run " + path("balls.toml") + " -o " + path("balls.toml/out")), 3) << output();
  EXPECT_EQ(run("run " + path("balls.toml") + " -o /proc/out"), 3);
  EXPECT_NE(output().find("/proc/out"), std::string::npos) << output();
}

TEST_F(Program, FailsWithThreeIfNobodyTakesWhatItSays) {
  for (const std::string command : {"keys", "check balls.toml"}) {
    const std::string line = "cd " + path("") + " && '" + program + "' " + command +
                             " > /dev/full 2> " + path("said.txt");
    const int status = std::system(line.c_str());
    EXPECT_EQ(WEXITSTATUS(status), 3) << command;
    EXPECT_NE(read_whole_file(path("said.txt")).find("standard output"), std::string::npos);
  }
}

TEST_F(Program, LetsNoNameFromAFileSteerTheTerminal) {
  std::string steering = two_balls;
  steering.replace(steering.find("on = \"left\""), 11, "on = \"\\u001b[31m\"");
  replace_file(path("steering.toml"), steering);
  EXPECT_EQ(run("check " + path("steering.toml")), 2);
  EXPECT_EQ(output().find('\x1b'), std::string::npos) << output();
  replace_file(path("table.csv"), "step\x1b[2J\n-\n0\n");
  EXPECT_EQ(run("check '" + path("a\x1b[2J.toml") + "'"), 3);
  EXPECT_EQ(output().find('\x1b'), std::string::npos) << output();
  EXPECT_EQ(run("info " + path("table.csv")), 0);
  EXPECT_EQ(output().find('\x1b'), std::string::npos) << output();
}

TEST_F(Program, EndsACaseShorterThanAnyStep) {
  for (const char* key : {"time.end", "output.history"})
    EXPECT_EQ(run("run " + path("balls.toml") + " --steps 3 --set " + key + "=1e-300 --force -o " +
                  path("out")),
              0)
        << output();
}

TEST_F(Program, NamesTheBodiesThatAPlaneCaseCouldMean) {
  replace_file(path("plate.toml"), R"(
method = "fdem2d"
time.end = 1e-6
material.rock.young = 1e10
[[body]]
name = "plate"
material = "rock"
size = [1.0, 1.0]
mesh_size = 0.5
structured = true
[[support]]
name = "held"
on = "floor"
[[load]]
name = "push"
on = "top"
[[probe]]
name = "y"
on = "plat"
quantity = "position_y"
[[friction]]
between = ["rock", "rok"]
coefficient = 0.3
)");
  EXPECT_EQ(run("check " + path("plate.toml")), 2);
  for (const char* part :
       {"support.held.on = \"floor\" is not a body; there are: plate",
        "load.push.on = \"top\" is not a body; there are: plate",
        "probe.y.on = \"plat\" is neither a body (plate) nor a support (held); did you mean plate?",
        "line 22, friction[0].between = \"rok\" is no material; there are: rock; did you mean "
        "rock?",
        "4 problems in "})
    EXPECT_NE(output().find(part), std::string::npos) << output();
}

TEST_F(Program, ChecksTheFilesThatACaseNames) {
  std::string from_file = two_balls;
  const std::size_t shape = from_file.find("shape = \"element\"");
  from_file.erase(from_file.find("radius = ", shape), 17);  // the file tells it
  from_file.replace(shape, 17, "shape = \"file\"\nfile = \"gone.csv\"");
  replace_file(path("file.toml"), from_file);
  EXPECT_EQ(run("check " + path("file.toml")), 3);
  const std::string line = std::to_string(
      1 + std::count(from_file.begin(), from_file.begin() + from_file.find("file = "), '\n'));
  const std::string told =
      "line " + line + ", body.left.file: " + path("gone.csv") + ": cannot read";
  EXPECT_NE(output().find(told), std::string::npos) << output();
  EXPECT_NE(output().find("with the files of " + path("file.toml")), std::string::npos) << output();
  EXPECT_EQ(run("run " + path("file.toml") + " -o " + path("out")), 3);
  EXPECT_NE(output().find(told), std::string::npos) << output();
  EXPECT_EQ(run("prepare " + path("file.toml") + " -o " + path("file.br")), 3);
  EXPECT_NE(output().find(told), std::string::npos) << output();
  replace_file(path("gone.csv"), "0,0,0,0.01\n");
  EXPECT_EQ(run("check " + path("file.toml")), 0) << output();
}

TEST_F(Program, TellsOfArgumentsThatACommandDoesNotTakeInTheirOrder) {
  EXPECT_EQ(run("run case.toml --treads 1 --quit"), 2);
  EXPECT_NE(output().find("error: --treads is not an option of run; did you mean --threads?\n"),
            std::string::npos)
      << output();
  EXPECT_NE(output().find("--quit is not an option of run; did you mean --quiet?"),
            std::string::npos)
      << output();
  EXPECT_EQ(run("sweep case.toml --over material.rock.friction 0.3 0.9"), 2);
  EXPECT_NE(output().find("error: 0.3 0.9: not expected; sweep takes CASE and options, and what "
                          "belongs to an option is one word behind it"),
            std::string::npos)
      << output();
  EXPECT_EQ(run("run"), 2);
  EXPECT_NE(output().find("error: run: CASE is required"), std::string::npos) << output();
  EXPECT_EQ(run("run case.toml --threads x"), 2);
  EXPECT_NE(output().find("error: run: --threads"), std::string::npos) << output();
}

TEST_F(Program, EndsWithFourWhereEnergyIsMissingAndSoDoesItsResume) {
  replace_file(path("balls.toml"), two_balls);
  EXPECT_EQ(run("run " + path("balls.toml") + " -o " + path("out") +
                " --set energy.stop=0.01 --set output.history=1e-3"),
            4);
  EXPECT_NE(output().find("are missing"), std::string::npos) << output();
  EXPECT_NE(output().find(" moves fastest, at "), std::string::npos) << output();
  EXPECT_EQ(run("resume " + path("out")), 4) << output();
}

TEST_F(Program, HasNoDeviceThatItWasNotBuiltFor) {
#if !defined(BR_CUDA)
  EXPECT_EQ(run("run " + path("balls.toml") + " --device cuda -o " + path("out")), 5);
  EXPECT_FALSE(fs::exists(path("out")));
#endif
}

TEST_F(Program, RefusesAFolderThatHoldsARunUnlessForced) {
  const std::string command = "run " + path("balls.toml") + " -o " + path("out");
  ASSERT_EQ(run(command), 0) << output();
  EXPECT_EQ(run(command), 2);
  EXPECT_NE(output().find("--force"), std::string::npos) << output();
  EXPECT_EQ(run(command + " --force"), 0) << output();
}

TEST_F(Program, FailsWithNineIfACheckFails) {
  std::string wrong = two_balls;
  wrong.replace(wrong.find("expected = 2"), 12, "expected = 3");
  replace_file(path("wrong.toml"), wrong);
  EXPECT_EQ(run("run " + path("wrong.toml") + " -o " + path("out")), 9);
  EXPECT_NE(output().find("FAIL"), std::string::npos) << output();
  EXPECT_EQ(summary("out")["exit_code"], 9);
}

TEST_F(Program, SavesItsStateAtASignalAndResumesToTheSameBits) {
  ASSERT_EQ(run("run " + path("long.toml") + " --steps 400000 -o " + path("whole")), 0) << output();
  int tried = 0;
  for (const int signal : {SIGTERM, SIGINT, SIGUSR1}) {
    const std::string name = "broken" + std::to_string(++tried);
    const pid_t child = start_program("run " + path("long.toml") + " -o " + path(name));
    wait_until_running(name);
    ::kill(child, signal);
    EXPECT_EQ(wait_for(child), 128 + signal);
    EXPECT_EQ(summary(name)["status"], "interrupted");
    ASSERT_LT(summary(name)["steps"].get<int>(), 400000);
    EXPECT_EQ(run("resume " + path(name) + " --threads 1 --steps 400000"), 0) << output();
    EXPECT_EQ(summary(name)["steps"], 400000);
    EXPECT_EQ(summary(name)["state_hash"], summary("whole")["state_hash"]);
    EXPECT_EQ(read_whole_file(path(name) + "/history.csv"),
              read_whole_file(path("whole/history.csv")));
  }
}

TEST_F(Program, EndsBeforeItsWallTimeIsOverAndResumesToTheSameBits) {
  ASSERT_EQ(run("run " + path("long.toml") + " --steps 400000 -o " + path("whole")), 0) << output();
  EXPECT_EQ(run("run " + path("long.toml") + " --max-wall 0.5s -o " + path("cut")), 10) << output();
  EXPECT_NE(output().find("breccia resume"), std::string::npos) << output();
  EXPECT_EQ(summary("cut")["status"], "interrupted");
  ASSERT_LT(summary("cut")["steps"].get<int>(), 400000);
  EXPECT_EQ(run("resume " + path("cut") + " --threads 1 --steps 400000"), 0) << output();
  EXPECT_EQ(summary("cut")["state_hash"], summary("whole")["state_hash"]);
}

TEST_F(Program, EndsWhereItsModelIsNotBuiltWithinTheWallTime) {
  replace_file(path("slow.toml"),
               "breccia = 1\nmethod = \"dem3d\"\ntime.end = 1e-6\n[material.c]\n"
               "law = \"concrete\"\nfracture_energy = \"100 J/m2\"\n[[body]]\nname = \"p\"\n"
               "material = \"c\"\nsize = [0.1, 0.1, 0.2]\npack = { count = 1600 }\n");
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(run("run " + path("slow.toml") + " --max-wall 0.1s -o " + path("none")), 2);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(3));
  EXPECT_NE(output().find("error: --max-wall 0.1s: the model was not yet built"), std::string::npos)
      << output();
  EXPECT_FALSE(fs::exists(path("none/summary.json")));
}

TEST_F(Program, RestartsFromACheckpointInANewFolder) {
  ASSERT_EQ(run("run " + path("balls.toml") + " -o " + path("whole")), 0) << output();
  ASSERT_EQ(run("run " + path("balls.toml") + " --steps 50 -o " + path("part")), 0) << output();
  const std::string checkpoint = list_checkpoints(path("part/checkpoints")).at(0).path;
  ASSERT_EQ(run("run " + path("balls.toml") + " --restart " + checkpoint + " -o " + path("rest")),
            0)
      << output();
  EXPECT_EQ(summary("rest")["state_hash"], summary("whole")["state_hash"]);
  EXPECT_EQ(run("run " + path("balls.toml") + " --set material.rock.young=2e9 --restart " +
                checkpoint + " -o " + path("other")),
            7)
      << output();
}

TEST_F(Program, TellsThePrecisionAndRefusesAStateOfAnother) {
  EXPECT_EQ(run("run " + path("balls.toml") + " --set precision=half -o " + path("out")), 2);
  EXPECT_NE(output().find("double | mixed"), std::string::npos) << output();
  ASSERT_EQ(
      run("run " + path("balls.toml") + " --set precision=mixed --steps 50 -o " + path("mixed")),
      0);
  EXPECT_NE(output().find("mixed precision"), std::string::npos) << output();
  EXPECT_EQ(summary("mixed")["precision"], "mixed");
  const std::string checkpoint = list_checkpoints(path("mixed/checkpoints")).at(0).path;
  EXPECT_EQ(run("info " + checkpoint), 0);
  EXPECT_NE(output().find("mixed precision"), std::string::npos) << output();
  EXPECT_EQ(run("run " + path("balls.toml") + " --restart " + checkpoint + " -o " + path("rest")),
            7);
  EXPECT_NE(output().find("precision = \"mixed\""), std::string::npos) << output();
  EXPECT_EQ(run("resume " + path("mixed")), 0) << output();
  EXPECT_EQ(run("run " + path("balls.toml") + " --set precision=single --restart " + checkpoint +
                " -o " + path("other")),
            7);
  ASSERT_EQ(
      run("run " + path("balls.toml") + " --set precision=single --steps 9 -o " + path("single")),
      0);
  EXPECT_NE(output().find("single precision"), std::string::npos) << output();
}

TEST_F(Program, RunsAPreparedModelToTheStateOfItsCase) {
  ASSERT_EQ(run("prepare " + path("balls.toml") + " -o " + path("balls.br")), 0) << output();
  ASSERT_EQ(run("run " + path("balls.toml") + " -o " + path("case")), 0) << output();
  ASSERT_EQ(run("run " + path("balls.br") + " -o " + path("model")), 0) << output();
  EXPECT_EQ(summary("model")["state_hash"], summary("case")["state_hash"]);
  EXPECT_EQ(summary("model")["case"], summary("case")["case"]);
  EXPECT_EQ(run("run " + path("balls.br") + " --set material.rock.young=2e9 -o " + path("other")),
            2)
      << output();
  fs::resize_file(path("balls.br"), 200);
  EXPECT_EQ(run("run " + path("balls.br") + " -o " + path("other")), 7) << output();
}

TEST_F(Program, GoesOnWithThePreparedModelWithoutWhatBuiltIt) {
  std::string text = two_balls;
  const auto replace = [&text](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  replace("shape = \"element\"", "shape = \"file\"\nfile = \"spheres.csv\"");
  replace("center = [-0.011, 0.0, 0.0]\nradius = \"10 mm\"\n", "");
  replace("on = \"left\"", "on = \"right\"");
  const auto spheres = [&](const std::string& rows) {
    replace_file(scratch / "spheres.csv", "x,y,z,radius\n" + rows);
  };
  spheres("-0.011,0,0,0.01\n");
  replace_file(scratch / "file.toml", text);
  ASSERT_EQ(run("prepare " + path("file.toml") + " -o " + path("file.br")), 0) << output();
  ASSERT_EQ(run("run " + path("file.br") + " -o " + path("whole")), 0) << output();
  ASSERT_EQ(run("run " + path("file.br") + " --steps 3 -o " + path("parts")), 0) << output();
  fs::remove(path("spheres.csv"));
  ASSERT_EQ(run("resume " + path("parts") + " --steps 400000"), 0) << output();
  EXPECT_EQ(summary("parts")["state_hash"], summary("whole")["state_hash"]);

  // Without the model: built anew, if it can be. With another one: refused.
  fs::rename(path("file.br"), path("moved.br"));
  EXPECT_EQ(run("resume " + path("parts")), 3) << output();
  EXPECT_NE(output().find("file.br is no longer there"), std::string::npos) << output();
  replace("radius = \"10 mm\"", "radius = \"9 mm\"");
  replace_file(scratch / "file.toml", text);
  spheres("-0.011,0,0,0.01\n");
  ASSERT_EQ(run("prepare " + path("file.toml") + " -o " + path("file.br")), 0) << output();
  EXPECT_EQ(run("resume " + path("parts")), 2) << output();
  EXPECT_NE(output().find("file.br"), std::string::npos) << output();
}

TEST_F(Program, RefusesAFolderWhoseCheckpointsAreAllDamaged) {
  ASSERT_EQ(run("run " + path("balls.toml") + " -o " + path("out")), 0) << output();
  for (const CheckpointFile& file : list_checkpoints(path("out/checkpoints")))
    fs::resize_file(file.path, fs::file_size(file.path) / 2);
  EXPECT_EQ(run("resume " + path("out")), 7) << output();
}

TEST_F(Program, RefusesASecondRunInTheSameFolder) {
  const pid_t child = start_program("run " + path("long.toml") + " -o " + path("out"));
  wait_until_running("out");
  EXPECT_EQ(run("run " + path("long.toml") + " --force -o " + path("out")), 2);
  EXPECT_EQ(run("resume " + path("out")), 2);
  EXPECT_NE(output().find("another run"), std::string::npos) << output();
  ::kill(child, SIGKILL);
  EXPECT_EQ(wait_for(child), -SIGKILL);
}

TEST_F(Program, WritesNoCarriageReturnIntoAFile) {
  ASSERT_EQ(run("run " + path("balls.toml") + " -o " + path("out")), 0) << output();
  EXPECT_EQ(output().find('\r'), std::string::npos);
  EXPECT_NE(output().find("done"), std::string::npos);
  ASSERT_EQ(run("run " + path("balls.toml") + " -q -o " + path("quiet")), 0);
  EXPECT_EQ(output(), "");
}

TEST_F(Program, ComparesRunsSideBySide) {
  const std::string balls = "run " + path("balls.toml") + " -o ";
  ASSERT_EQ(run(balls + path("a")), 0) << output();
  ASSERT_EQ(run(balls + path("b") + " --threads 2"), 0) << output();
  ASSERT_EQ(run(balls + path("c") + " --set seed=2 --steps 3"), 0) << output();
  EXPECT_EQ(run("compare " + path("a") + " " + path("b")), 0) << output();
  EXPECT_NE(output().find("b over a\nsteps "), std::string::npos) << output();
  EXPECT_NE(output().find("alike\n"), std::string::npos) << output();
  EXPECT_NE(output().find("states alike to the bit ("), std::string::npos) << output();
  EXPECT_EQ(run("compare " + path("a") + " " + path("c") + " --measure energy.kinetic"), 0)
      << output();
  EXPECT_NE(output().find("\nenergy.kinetic "), std::string::npos) << output();
  EXPECT_NE(output().find("states differ\n"), std::string::npos) << output();
  EXPECT_EQ(run("compare " + path("a") + " " + path("c") + " --measure energy.kinetik"), 2);
  EXPECT_NE(output().find("energy.kinetic"), std::string::npos) << output();
  EXPECT_EQ(run("compare " + path("a") + " " + path("nothing")), 3);
  EXPECT_NE(output().find("there is no such folder"), std::string::npos) << output();
  std::filesystem::create_directory(path("empty"));
  EXPECT_EQ(run("compare " + path("a") + " " + path("empty")), 2);
  EXPECT_NE(output().find("holds no run"), std::string::npos) << output();
  EXPECT_NE(run("compare " + path("a")), 0);
}

TEST_F(Program, TellsRatiosOfNegativeNumbersAndUnits) {
  for (const auto& [name, force] : {std::pair{"a", "-100.0"}, std::pair{"b", "-150.0"}}) {
    fs::create_directories(path(name));
    replace_file(path(name) + "/summary.json",
                 std::string(R"({"status": "done", "exit_code": 0, "steps": 2, "time": 0.5,
      "energy": {"error_relative": 0.0}, "probe": {"F": {"last": )") +
                     force + R"(, "min": )" + force + R"(, "max": 0.0}}})");
    replace_file(path(name) + "/history.csv",
                 std::string("step,time,F\n-,s,N\n2,0.5,") + force + "\n");
  }
  EXPECT_EQ(run("compare " + path("a") + " " + path("b")), 0) << output();
  const std::size_t row = output().find("probe.F.peak [N] ");
  ASSERT_NE(row, std::string::npos) << output();
  EXPECT_NE(output().find("+50 %\n", row), std::string::npos) << output();
  EXPECT_NE(output().find("time [s] "), std::string::npos) << output();
}

TEST_F(Program, TellsThatARunWasKilledAndHowFarItGot) {
  ASSERT_EQ(run("run " + path("balls.toml") + " -o " + path("out")), 0) << output();
  nlohmann::json told = nlohmann::json::parse(read_whole_file(path("out/summary.json")));
  told["status"] = "running";
  told["steps"] = 0;
  replace_file(path("out/summary.json"), told.dump());
  ASSERT_EQ(run("info " + path("out")), 0) << output();
  EXPECT_NE(output().find("killed; nothing runs in this folder any more"), std::string::npos)
      << output();
  EXPECT_NE(output().find("these numbers are of step 0"), std::string::npos) << output();
  EXPECT_EQ(output().find("Nothing"), std::string::npos) << output();
  ASSERT_EQ(run("compare " + path("out") + " " + path("out")), 0) << output();
  EXPECT_NE(output().find("killed, not to the end of its case"), std::string::npos) << output();
}

TEST_F(Program, DescribesDrawsAndListsWithoutAProblem) {
  ASSERT_EQ(run("run " + path("balls.toml") + " -o " + path("out")), 0) << output();
  EXPECT_EQ(run("info " + path("out")), 0) << output();
  EXPECT_TRUE(output().starts_with(path("out") + ": done\ncase    balls, dem3d, seed 1\nmodel   "))
      << output();
  EXPECT_EQ(run("info " + path("out/fields/elements_0000.vtu")), 0) << output();
  EXPECT_NE(output().find("elements_0000.vtu: of the frame at 0 s, step 0\n"), std::string::npos)
      << output();
  EXPECT_NE(output().find("    velocity[3] "), std::string::npos) << output();
  EXPECT_EQ(run("info " + list_checkpoints(path("out/checkpoints")).at(0).path), 0) << output();
  EXPECT_NE(output().find("elements.orientation"), std::string::npos) << output();
  EXPECT_EQ(run("render " + path("out") + " -o " + path("picture.png") + " --color velocity"), 0)
      << output();
  EXPECT_TRUE(fs::exists(path("picture.png")));
  EXPECT_EQ(run("info " + path("picture.png")), 0) << output();
  EXPECT_NE(output().find("\ncase    balls, seed 1\nshows   "), std::string::npos) << output();
  EXPECT_EQ(run("info " + path("out/fields")), 2);
  EXPECT_NE(output().find("it is a part of one"), std::string::npos) << output();
  EXPECT_EQ(run("render " + path("out") + " --color no_such_field"), 2);
  EXPECT_NE(output().find("no field \"no_such_field\" in this frame"), std::string::npos)
      << output();
  EXPECT_EQ(run("render " + path("out") + " --color velocity --log --range -1:1"), 2);
  EXPECT_NE(output().find("--log needs values above 0"), std::string::npos) << output();
  EXPECT_EQ(run("render " + path("out") + " --camera no.toml"), 2);
  EXPECT_NE(output().find("no such camera file; nothing was drawn"), std::string::npos) << output();
  EXPECT_EQ(run("render " + path("out") + " -o " + path("picture.jpg")), 2);
  EXPECT_FALSE(fs::exists(path("picture.jpg")));
  EXPECT_EQ(run("report " + path("out")), 0) << output();
  EXPECT_TRUE(fs::exists(path("out/report.html")));
  EXPECT_EQ(run("keys time"), 0) << output();
  EXPECT_NE(output().find("simulated time at which the run is done"), std::string::npos)
      << output();
  EXPECT_EQ(run("keys no_such_prefix"), 2);
  EXPECT_EQ(run("--version"), 0);
  EXPECT_EQ(run("run --help"), 0);
}

TEST_F(Program, FoldsTheTextsOfOptionsOnce) {
  constexpr std::size_t column = 30, width = 80;  // of texts, of the terminal
  const auto text_of = [](const std::string& line) -> std::string {
    const bool begins = line.size() > column && line.substr(column - 2, 2) == "  ";
    return line.starts_with(' ') && begins ? line.substr(column) : "";
  };
  for (const char* command : {"run", "check", "render", "convert", "mesh info", "report", "test"}) {
    EXPECT_EQ(run(std::string(command) + " --help"), 0);
    std::istringstream lines(output());
    std::string last;
    for (std::string line; std::getline(lines, line); last = line) {
      const std::string text = text_of(line);
      if (text.empty() || text_of(last).empty() || line.find_first_not_of(' ') < column) continue;
      const std::size_t word = std::min(text.find(' '), text.size());
      EXPECT_GT(last.size() + 1 + word, width) << command << ": " << last << '\n' << line;
    }
  }
}

}  // namespace program_test
}  // namespace breccia
