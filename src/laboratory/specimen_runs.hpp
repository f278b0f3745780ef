#pragma once
// The runs behind a material's tests: cases are written, computed side by side and reduced.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "laboratory/passport.hpp"
#include "laboratory/rock_tests.hpp"
#include "laboratory/side_by_side.hpp"

namespace breccia::laboratory {

/// Where and how specimens are computed.
struct Bench {
  std::string folder;
  std::int64_t first_seed = 1;
  int seeds = 3;
  /// For so many runs, the largest of which takes so many bytes.
  std::function<Workers(std::size_t, double)> workers;
  /// Callback at the end of each of these runs.
  std::function<std::function<void(std::size_t, const FinishedRun&)>(
      const std::vector<PlannedRun>&)>
      tell;
};

/// The specimens of all tests. Cases lie in FOLDER/cases, results in FOLDER/runs, both named by
/// test, seed and the first digits of the digest, so that the same specimen is never computed
/// twice.
/// @param exit_code  gets that of the first run without a result, if it was 0
std::vector<TestResults> run_specimens(const std::vector<SpecimenTest>& tests, const Sample& sample,
                                       const Bench& bench, int& exit_code);
std::vector<TestResults> run_specimens(const std::vector<SpecimenTest>& tests,
                                       const RockSample& sample, const Bench& bench,
                                       int& exit_code);

}  // namespace breccia::laboratory
