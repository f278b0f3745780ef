#pragma once
// Problems of a case as it is in each of its stages.

#include <algorithm>
#include <string>
#include <vector>

#include "core/stages.hpp"

namespace breccia {

/// Adds the problems of each stage with its name; those that the case has from the start, and
/// keeps, without: they stand where it begins.
/// @param at       at(progress): the case in a stage
/// @param in       in(config): problems of a case as it is
/// @param between  between(now, k): adds those of the way into stage k
template <class Config, class At, class In, class Between>
void add_by_stages(const Config& config, std::vector<std::string>& problems, const At& at,
                   const In& in, const Between& between) {
  const std::vector<std::string> of_case = in(config);
  const auto among = [](const std::vector<std::string>& all, const std::string& one) {
    return std::find(all.begin(), all.end(), one) != all.end();
  };
  StageProgress progress;
  for (std::size_t k = 0; k < std::max<std::size_t>(config.stages.size(), 1); ++k) {
    progress.index = static_cast<std::int32_t>(k);
    const Config now = at(progress);
    for (const std::string& problem : in(now))
      if (!among(of_case, problem))
        problems.push_back(
            config.stages.empty() ? problem : "stage." + config.stages[k].name + ": " + problem);
      else if (!among(problems, problem))
        problems.push_back(problem);
    between(now, k);
  }
}

}  // namespace breccia
