#include <gtest/gtest.h>

#include "core/quantity.hpp"
#include "io/whole_file.hpp"
#include "paths.hpp"
#include "physics/dem/scene.hpp"
#include "physics/fdem/scene.hpp"
#include "physics/fdem3/scene.hpp"
#include "run/method/checks.hpp"
#include "run/method/dem_method.hpp"
#include "run/method/fdem3_method.hpp"
#include "run/method/fdem_method.hpp"
#include "run/results/recorder.hpp"
#include "run/results/step_times.hpp"
#include "texts.hpp"
#include "unit/run/fake_run.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace record_test {

TEST(StepTimes, MedianAndPercentileAreExactToHalfAPercent) {
  StepTimes times;
  for (int i = 1; i <= 1000; ++i) times.add(1e-6 * i);
  EXPECT_NEAR(times.quantile(0.5), 500e-6, 0.006 * 500e-6);
  EXPECT_NEAR(times.quantile(0.95), 950e-6, 0.006 * 950e-6);
  EXPECT_EQ(StepTimes().quantile(0.5), 0.0);
}

TEST(Schedule, NextMomentFollowsFromTheTimeAlone) {
  const double end = 0.3;
  Schedule walked(end, 7.0);
  for (int step = 0; step <= 400; ++step) {
    const double time = 1e-3 * step;
    walked.pass(time);
    Schedule fresh(end, 7.0);
    fresh.pass(time);
    EXPECT_EQ(walked.next(), fresh.next());
    EXPECT_GT(walked.next(), time);
  }
}

TEST(Schedule, MeetsTheEndItself) {
  Schedule schedule(0.3, 7.0);
  schedule.pass(0.29);
  EXPECT_EQ(schedule.next(), 0.3);
}

TEST(Schedule, GoesOnWhenItsMomentsLieCloserThanNumbersDo) {
  for (const double end : {1e-300, 1e-15}) {
    Schedule schedule(end, 1000.0);
    for (const double time : {0.0, 2e-5, 4e-5}) {
      schedule.pass(time);
      EXPECT_GT(schedule.next(), time);
      EXPECT_LT(schedule.next(), time + 1e-9);
    }
  }
}

TEST(History, NamesAreInItsFirstLineAndUnitsInItsSecond) {
  const ScratchFolder scratch;
  {
    History history(scratch / "history.csv", {ProbeConfig{"rock", "", "velocity_z", "mean"},
                                              ProbeConfig{"a,b", "", "damage", "max"}});
    Sample sample;
    sample.step = 3;
    sample.time = 0.1;
    sample.probes = {1.0 / 3.0, 0.5};
    history.write(sample);
  }
  EXPECT_EQ(read_whole_file(scratch / "history.csv"),
            "step,time,dt,kinetic,elastic,fracture,plastic,friction,damping,contact,work,"
            "error_relative,rock,\"a,b\"\n"
            "-,s,s,J,J,J,J,J,J,J,J,-,m/s,-\n"
            "3,0.10000000000000001,0,0,0,0,0,0,0,0,0,0,0.33333333333333331,0.5\n");
}

TEST(History, SaysForcesAndEnergiesOfEachMetreInThePlane) {
  const ScratchFolder scratch;
  History(scratch / "history.csv",
          {ProbeConfig{"press", "", "force_y", "sum"}, ProbeConfig{"p", "", "momentum_x", "sum"},
           ProbeConfig{"v", "", "velocity_y", "mean"}},
          true);
  const std::string text = read_whole_file(scratch / "history.csv");
  EXPECT_EQ(text.substr(text.find('\n') + 1),
            "-,s,s,J/m,J/m,J/m,J/m,J/m,J/m,J/m,J/m,-,N/m,kg/s,m/s\n");
}

/// Fields of a frame that the table does not list with this unit and size.
std::string not_in_the_table(const Frame& frame, bool in_plane) {
  std::string unknown;
  for (const auto* fields :
       {&frame.point_fields, &frame.line_fields, &frame.triangle_fields, &frame.tetrahedron_fields})
    for (const FrameField& field : *fields) {
      bool known = false;
      for (const NamedQuantity& named : quantities)
        for (const int axis : {named.quantity.axis, -1}) {
          if ((named.of & (in_frames | is_name)) == 0) continue;
          const Quantity whole{named.quantity.kind, axis, axis < 0 ? -1 : named.quantity.other};
          const FieldWord word = field_word(whole, in_plane);
          const bool line_force = field.name == "force" && fields == &frame.line_fields;
          known |= word.name == field.name && word.unit == field.unit &&
                   (line_force || word.components == field.components);
        }
      if (!known) unknown += field.name + " [" + field.unit + "] ";
    }
  return unknown;
}

TEST(Quantities, AreOneTableForProbesFramesAndTheManual) {
  dem::testing::Scene grains;
  grains.material("m", "concrete", 30e9, 0.2, 2500.0);
  grains.sphere({}, 0.01);
  grains.sphere({0.02, 0.0, 0.0}, 0.01);
  grains.config.output.more = {"displacement", "force", "stress"};
  EXPECT_EQ(not_in_the_table(make_method(grains.config, grains.model, {}, nullptr)->frame(), false),
            "");
  fdem::testing::Scene plate;
  plate.material().joints = "intrinsic";
  plate.body("p", prepare::crossed_rectangle({{0.0, 0.0}, {0.02, 0.02}}, 0.02));
  plate.config.output.more = {"displacement", "force"};
  EXPECT_EQ(not_in_the_table(make_method(plate.config, plate.model, {}, nullptr)->frame(), true),
            "");
  fdem3::testing::Scene block;
  block.material().joints = "intrinsic";
  block.body("b", prepare::kuhn_box({}, {0.02, 0.02, 0.02}, 0.02));
  block.config.output.more = {"displacement", "force"};
  EXPECT_EQ(not_in_the_table(make_method(block.config, block.model, {}, nullptr)->frame(), false),
            "");

  const std::string manual = read_whole_file(std::string(source_dir) + "/docs/measures.md");
  for (const NamedQuantity& named : quantities) {
    std::string stem = named.word;
    if (named.quantity.axis >= 0) stem.resize(stem.rfind('_'));
    EXPECT_NE(manual.find('`' + stem + '`'), std::string::npos) << named.word;
  }
}

TEST(Record, FramesComeAtTheFirstStepAtOrPastTheirTime) {
  const ScratchFolder scratch;
  run_fake(fake_plan(), scratch / "out");
  const std::string log = read_whole_file(scratch / "out/log.jsonl");
  int frames = 0;
  for (std::size_t at = log.find("\"stage\":\"frame\""); at != std::string::npos;
       at = log.find("\"stage\":\"frame\"", at + 1))
    ++frames;
  EXPECT_EQ(frames, 5) << "four over the run and the one at the start";
  EXPECT_NE(log.find("\"frame\":4,\"time_s\":"), std::string::npos) << log;
}

TEST(Summary, NumbersReadBackToTheSameBits) {
  Summary summary;
  summary.time = 0.1 + 0.2;
  summary.dt_last = 1.0 / 3.0 * 1e-7;
  const nlohmann::json read = parsed_json(to_json(summary));
  EXPECT_EQ(read["time"].get<double>(), summary.time);
  EXPECT_EQ(read["dt"]["last"].get<double>(), summary.dt_last);
}

TEST(Summary, NumbersAreFoundByTheirPath) {
  Summary summary;
  summary.facts = {{"fracture.broken_links", 12.0}};
  summary.energy = EnergyBalance{};
  summary.energy->error_relative = 2e-4;
  summary.probes = {{"rock.left", 1.0, -2.0, 3.0}};
  EXPECT_EQ(number_at(summary, "fracture.broken_links"), 12.0);
  EXPECT_EQ(number_at(summary, "energy.error_relative"), 2e-4);
  EXPECT_EQ(number_at(summary, "probe.rock.left.min"), -2.0);
  EXPECT_EQ(number_at(summary, "energy.no_such"), std::nullopt);
  EXPECT_EQ(number_at(summary, "status"), std::nullopt);
}

TEST(Checks, FailForANumberTheRunDoesNotHaveOrThatIsNone) {
  Summary summary;
  summary.energy = EnergyBalance{};
  summary.energy->kinetic = std::numeric_limits<double>::quiet_NaN();
  const auto results = evaluate_checks({CheckConfig{"missing", "no.such", -1.0, 0.0, 1e9, "-"},
                                        CheckConfig{"nan", "energy.kinetic", -1.0, 0.0, 1e9, "J"}},
                                       summary, "");
  EXPECT_FALSE(results[0].pass);
  EXPECT_FALSE(results[1].pass);
}

TEST(Checks, OfAProbeAtATimeAreMadeBetweenTheRowsAroundIt) {
  const ScratchFolder scratch;
  const std::string path = scratch / "history.csv";
  History history(
      path, {ProbeConfig{"a,b", "", "damage", "max"}, ProbeConfig{"wall", "", "damage", "max"}},
      false, true);
  for (const double t : {0.0, 1.0, 3.0}) {
    Sample row;
    row.time = t;
    row.probes = {-1.0, 10.0 * t * t};
    row.stage = "one, two";
    history.write(row);
  }
  history.sync();
  Summary summary;
  summary.probes = {{"a,b", 0.0, 0.0, 0.0}, {"wall", 0.0, 0.0, 0.0}};
  const auto value_at = [&](double time) {
    return evaluate_checks({CheckConfig{"c", "probe.wall.at", time, 0.0, 0.0, "-"}}, summary, path)
        .front()
        .value;
  };
  EXPECT_EQ(value_at(0.0), 0.0);
  EXPECT_EQ(value_at(1.0), 10.0);
  EXPECT_EQ(value_at(2.0), 50.0);
  EXPECT_EQ(value_at(3.0), 90.0);
  EXPECT_EQ(value_at(3.1), std::nullopt);
}

}  // namespace record_test
}  // namespace breccia
