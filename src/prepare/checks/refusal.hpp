#pragma once
// The message of all problems at once.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "exec/error.hpp"

namespace breccia::prepare {

/// Nothing if there are no problems. @param of  where they are: "in the case", "with the model"
/// @throws InputError with one line for each problem
inline void refuse(const std::vector<std::string>& problems, const char* of) {
  if (problems.empty()) return;
  throw InputError(fmt::format("{} problem{} {}; nothing was run.\n  {}", problems.size(),
                               problems.size() == 1 ? "" : "s", of, fmt::join(problems, "\n  ")));
}

}  // namespace breccia::prepare
