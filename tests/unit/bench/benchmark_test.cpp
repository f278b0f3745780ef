// Scenes and words of benchmarks; their speed is not tested.

#include "bench/benchmark.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/scenes.hpp"
#include "exec/error.hpp"
#include "paths.hpp"
#include "run/case_keys.hpp"
#include "texts.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace benchmark_test {

/// Keys that decide places, counts and links: the case without laws, speeds and output.
std::string geometry_of(const dem::Config& config) {
  dem::Config geometry;
  geometry.seed = config.seed;
  geometry.bodies = config.bodies;
  geometry.links = config.links;
  geometry.supports = config.supports;
  for (dem::BodyConfig& body : geometry.bodies) {
    body.material.clear();
    body.velocity = {};
  }
  return completed_case(geometry);
}

TEST(BenchmarkScene, OfScaleOneHasTheElementsAndLinksOfTheShippedSlab) {
  const auto shipped =
      read_case<dem::Config>(std::string(source_dir) + "/cases/rc_slab/case.toml", {});
  EXPECT_EQ(geometry_of(slab_scene(1.0)), geometry_of(shipped));
}

TEST(BenchmarkScene, GrowsElementsAndLinksAlike) {
  const dem::Config large = slab_scene(2.7);
  const int elements = large.bodies[0].pack.count +
                       4 * large.bodies[1].rebar.bars * large.bodies[1].rebar.elements +
                       large.bodies[2].pack.count;
  EXPECT_EQ(elements, 99'262);
  EXPECT_NEAR(large.links.count / static_cast<double>(elements), 79'211 / 14'274.0, 1e-4);
}

TEST(BenchmarkOutput, HoldsMedianAndSpreadOfEachPart) {
  const std::vector<Measurement> measured{{"before impact", "step", "us", 3.0, 2.0, 5.0},
                                          {"memory", "bytes", "B", 7.0, 7.0, 7.0}};
  const auto json = parsed_json(benchmark_json({{"slab", measured}}, Exec{}, "cpu"));
  const auto& step = json["benchmarks"]["slab"]["before impact"]["step"];
  EXPECT_EQ(step["value"], 3.0);
  EXPECT_EQ(step["min"], 2.0);
  EXPECT_EQ(step["max"], 5.0);
  EXPECT_EQ(json["benchmarks"]["slab"]["memory"]["bytes"]["unit"], "B");
  EXPECT_EQ(benchmark_table("slab", measured),
            "slab                                     median          min          max\n"
            " before impact\n"
            "  step                                        3            2            5 us\n"
            " memory\n"
            "  bytes                                       7                           B\n");
}

TEST(PacedSlab, AnswersEachLineAndRefusesOthers) {
  const ScratchFolder folder;
  std::istringstream commands("export " + folder.path() + "\nsteps 2\nuntil 4e-6\nfly\n");
  std::ostringstream answers;
  EXPECT_THROW(pace_slab(commands, answers, Exec{}), InputError);
  std::istringstream lines(answers.str());
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(parsed_json(line)["links"], 79'211);
  std::getline(lines, line);
  EXPECT_EQ(parsed_json(line)["steps"], 2);
  std::getline(lines, line);
  EXPECT_GE(parsed_json(line)["time"], 4e-6);
  EXPECT_FALSE(std::getline(lines, line));
}

}  // namespace benchmark_test
}  // namespace breccia
