#pragma once
// Keys of a support that lead to nothing: velocities along directions that it does not fix, ramps
// that lead nothing.

#include <algorithm>
#include <string>
#include <vector>

#include "core/table_over_time.hpp"

namespace breccia {

/// Whether the number along axis k is another than 0 at some time.
template <class Value>
bool is_given(const OverTime<Value>& quantity, int axis) {
  if (!quantity.is_table()) return component(quantity.value, axis) != 0.0;
  for (const Value& row : quantity.values)
    if (component(row, axis) != 0.0) return true;
  return false;
}
/// Whether a quantity is given at all.
template <class Value>
bool is_given(const OverTime<Value>& quantity) {
  constexpr int parts = static_cast<int>(sizeof(Value) / sizeof(double));
  bool any = quantity.is_table();
  for (int axis = 0; axis < parts; ++axis) any = any || component(quantity.value, axis) != 0.0;
  return any;
}

/// "[\"x\", \"y\"]"
inline std::string quoted_list(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "\"" : ", \"") + word + "\"";
  return "[" + text + "]";
}

/// Adds a sentence for each direction along which a velocity leads and `fix` leaves free.
/// @param where  the support: "support.press"
template <class Value>
void add_unfixed(const std::string& where, const std::vector<std::string>& fix,
                 const OverTime<Value>& velocity, std::vector<std::string>& problems) {
  const char* const words[] = {"x", "y", "z"};
  constexpr int axes = static_cast<int>(sizeof(Value) / sizeof(double));
  const auto holds = [&](const std::string& word) {
    return std::find(fix.begin(), fix.end(), word) != fix.end();
  };
  for (int axis = 0; axis < axes; ++axis) {
    const std::string word = words[axis];
    if (!is_given(velocity, axis) || holds(word) || holds("all")) continue;
    problems.push_back(where + ".velocity leads along " + word +
                       ", which fix = " + quoted_list(fix) + " leaves free; fix must hold \"" +
                       word + "\", or the velocity along it be 0");
  }
}

/// Problems of the motion of supports in a stage that gives it, or at the start of the case.
/// @param now    the case as it is in that stage
/// @param stage  its number
/// @param look   look(support, where): problems of a support of `now`
template <class Config, class Look>
void each_given_motion(const Config& config, const Config& now, std::size_t stage,
                       const Look& look) {
  for (const auto& support : now.supports) {
    bool changed = false;
    if (stage < config.stages.size())
      for (const auto& change : config.stages[stage].supports)
        changed = changed || change.name == support.name;
    if (stage > 0 && !changed) continue;
    look(support,
         (changed ? "stage." + config.stages[stage].name + "." : "") + "support." + support.name);
  }
}

}  // namespace breccia
