#pragma once
// The message of all problems at once.

#include <fmt/format.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "exec/error.hpp"

namespace breccia::prepare {

/// Problems that were found together.
struct Refusal : InputError {
  Refusal(const std::string& text, std::vector<std::string> all)
      : InputError(text), problems(std::move(all)) {}
  std::vector<std::string> problems;
};

/// Files that cannot be read, found together.
struct Unreadable : IoError {
  Unreadable(const std::string& text, std::vector<std::string> all)
      : IoError(text), problems(std::move(all)) {}
  std::vector<std::string> problems;
};

/// Nothing if there are no problems. @param of  where they are: "in the case", "with the model"
/// @throws Refusal (or Unreadable) with one line for each problem
template <class Found = Refusal>
void refuse(const std::vector<std::string>& problems, const char* of) {
  if (problems.empty()) return;
  throw Found(fmt::format("{} problem{} {}; nothing was run.\n  {}", problems.size(),
                          problems.size() == 1 ? "" : "s", of, fmt::join(problems, "\n  ")),
              problems);
}

/// Makes all checks, and refuses what any of them finds at once, each problem once.
template <class... Checks>
void refuse_all(const char* of, const Checks&... checks) {
  std::vector<std::string> problems;
  std::set<std::string> told;  // two parts of a case may find the same
  bool wrong = false;          // more than files that cannot be read
  const auto add = [&](const std::vector<std::string>& found) {
    for (const std::string& problem : found)
      if (told.insert(problem).second) problems.push_back(problem);
  };
  const auto collect = [&](const auto& check) {
    try {
      check();
    } catch (const Refusal& found) {
      add(found.problems);
      wrong = true;
    } catch (const Unreadable& found) {
      add(found.problems);
    }
  };
  (collect(checks), ...);
  wrong ? refuse(problems, of) : refuse<Unreadable>(problems, of);
}

}  // namespace breccia::prepare
