#include "laboratory/specimen_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "io/whole_file.hpp"
#include "laboratory/sweep.hpp"
#include "prepare/checks/check_case.hpp"
#include "run/case_keys.hpp"
#include "run/machine/memory_plan.hpp"
#include "run/results/result_folder.hpp"

namespace breccia::laboratory {
namespace {

template <class Material>
std::vector<TestResults> run_all(const std::vector<SpecimenTest>& tests, const Material& sample,
                                 const Bench& bench, int& exit_code) {
  std::vector<TestResults> results;
  std::vector<PlannedRun> runs;
  double bytes = 0.0;
  const std::string cases = bench.folder + "/cases";
  make_folder(cases);
  for (const SpecimenTest& test : tests) {
    results.push_back({test, {}, {}});
    for (int k = 0; k < bench.seeds; ++k) {
      const std::int64_t seed = bench.first_seed + k;
      const auto config = case_of(test, sample, seed, cases);
      check_case(config);
      const std::string text = completed_case(config);
      PlannedRun run;
      run.digest = case_digest(text);
      const std::string name = run_folder_name(fmt::format("{}-{}", test.name, seed), run.digest);
      run.name = fmt::format("{} {}", test.name, seed);
      run.case_path = cases + "/" + name + ".toml";
      run.folder = bench.folder + "/runs/" + name;
      replace_file(run.case_path, text);
      bytes = std::max(bytes, memory_plan(config).run_bytes);
      runs.push_back(run);
    }
  }
  const auto ended = run_side_by_side(runs, bench.workers(runs.size(), bytes), bench.tell(runs));
  for (std::size_t k = 0; k < runs.size(); ++k) {
    TestResults& result = results[k / static_cast<std::size_t>(bench.seeds)];
    if (ended[k].complete()) {
      result.specimens.push_back(specimen_result(result.test, runs[k].folder));
    } else {
      result.failures.push_back(ended[k].message);
      if (exit_code == 0) exit_code = std::abs(ended[k].exit_code);
    }
  }
  return results;
}

}  // namespace

std::vector<TestResults> run_specimens(const std::vector<SpecimenTest>& tests, const Sample& sample,
                                       const Bench& bench, int& exit_code) {
  return run_all(tests, sample, bench, exit_code);
}
std::vector<TestResults> run_specimens(const std::vector<SpecimenTest>& tests,
                                       const RockSample& sample, const Bench& bench,
                                       int& exit_code) {
  return run_all(tests, sample, bench, exit_code);
}

}  // namespace breccia::laboratory
