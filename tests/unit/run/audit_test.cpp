// Steps that are done twice: what a machine that fails once in a while does to them.

#include <gtest/gtest.h>

#include "run/method/audited_method.hpp"
#include "unit/run/fake_run.hpp"
#include "unit/run/program.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace audit_test {

/// Runs the fake method with audit, to the end of its case.
int run_audited(std::int64_t every, const std::string& path, const Trouble& trouble = {}) {
  const RunPlan plan = fake_plan();
  const std::unique_ptr<Method> method =
      audited(std::make_unique<FakeMethod>(trouble), AuditConfig{every}, 1, nullptr);
  const ResultFolder folder = ResultFolder::create(path, Existing::refuse);
  return Run(*method, plan, &folder).execute();
}

Trouble flipped_at(std::int64_t step) {
  Trouble trouble;
  trouble.flip_at = step;
  return trouble;
}

TEST(Audit, FindsASingleBitThatWasWrongOnce) {
  const ScratchFolder scratch;
  try {
    run_audited(1, scratch / "out", flipped_at(57));
    FAIL() << "the wrong bit was not found";
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find("step 57 was done twice"), std::string::npos)
        << error.what();
  }
  EXPECT_EQ(summary_of(scratch / "out")["exit_code"], 5);
}

/// The hash tells of places and velocities; a wrong force moves them in the next step only.
TEST(Audit, FindsAWrongForceInTheStepThatMadeIt) {
  const ScratchFolder scratch;
  Trouble trouble;
  trouble.flip_force_at = 57;
  try {
    run_audited(1, scratch / "out", trouble);
    FAIL() << "the wrong force was not found";
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find("fake.force, item 0 of 1"), std::string::npos)
        << error.what();
  }
}

/// Both results of a step would have it.
TEST(Audit, FindsAConstantThatHasChanged) {
  const ScratchFolder scratch;
  Trouble trouble;
  trouble.flip_constant_at = 57;
  try {
    run_audited(10, scratch / "out", trouble);
    FAIL() << "the changed constant was not found";
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what()).find("array fake.mass has changed"), std::string::npos)
        << error.what();
  }
}

/// Both results of the next step begin with it.
TEST(Audit, FindsABitThatFlippedBetweenTwoSteps) {
  auto fake = std::make_unique<FakeMethod>();
  FakeMethod& memory = *fake;
  const std::unique_ptr<Method> method = audited(std::move(fake), AuditConfig{1}, 1, nullptr);
  while (method->steps() < 57) method->advance({1e300, 57});
  memory.flip_at_rest();
  try {
    method->advance({1e300, 58});
    FAIL() << "the flipped bit was not found";
  } catch (const DeviceError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("after step 57: the state has changed between two steps (fake.velocity, "
                        "item 0 of 1)"),
              std::string::npos)
        << error.what();
  }
}

TEST(Audit, FindsAsManyWrongStepsAsItRepeats) {
  int found = 0;
  for (int step = 1; step <= 400; ++step) {
    const std::unique_ptr<Method> method =
        audited(std::make_unique<FakeMethod>(flipped_at(step)), AuditConfig{4}, step, nullptr);
    try {
      while (method->steps() < step) method->advance({1e300, step});
    } catch (const DeviceError&) {
      ++found;
    }
  }
  EXPECT_GT(found, 100 - 26);  // three deviations of 400 draws with a chance of 1 in 4
  EXPECT_LT(found, 100 + 26);
}

TEST(Audit, LeavesASoundRunAsItIs) {
  const ScratchFolder scratch;
  EXPECT_EQ(run_fake(fake_plan(), scratch / "plain"), 0);
  EXPECT_EQ(run_audited(3, scratch / "audited"), 0);
  EXPECT_EQ(read_whole_file(scratch / "audited/history.csv"),
            read_whole_file(scratch / "plain/history.csv"));
  const nlohmann::json summary = summary_of(scratch / "audited");
  EXPECT_EQ(summary["state_hash"], summary_of(scratch / "plain")["state_hash"]);
  EXPECT_GT(summary["audit"]["repeated_steps"], 40);
}

TEST(Audit, OfEachMethodChangesNoBit) {
  const ScratchFolder scratch;
  for (const char* name : {"rc_slab", "brazilian_disc", "colliding_cubes_3d"}) {
    const auto run = [&](const std::string& to, int every) {
      EXPECT_EQ(wait_for(start_program(
                    "run " + std::string(source_dir) + "/cases/" + name + "/small.toml -o " +
                    (scratch / to) +
                    " -q --threads 1 --steps 300 --set output.frames=0 --set audit.every=" +
                    std::to_string(every))),
                0);
      return summary_of(scratch / to);
    };
    const nlohmann::json plain = run(std::string(name) + "_plain", 0),
                         audited = run(std::string(name) + "_audited", 7);
    EXPECT_EQ(audited["state_hash"], plain["state_hash"]) << name;
    EXPECT_GT(audited["audit"]["repeated_steps"], 20) << name;
    EXPECT_EQ(read_whole_file(scratch / (std::string(name) + "_audited/history.csv")),
              read_whole_file(scratch / (std::string(name) + "_plain/history.csv")));
  }
}

}  // namespace audit_test
}  // namespace breccia
