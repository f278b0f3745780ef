#pragma once
// Probes of a world whose values are asked for later.

#include <functional>
#include <vector>

#include "core/case_config.hpp"

namespace breccia {

/// Values of probes of one rank alone, in their order, when they are asked for; until then the host
/// can go on.
template <class World>
std::function<std::vector<double>()> read_later(World& w, const std::vector<ProbeConfig>& probes) {
  constexpr std::size_t most = 32;  // that are waited for at a time
  std::vector<std::function<double()>> read;
  std::vector<double> values;
  const auto take = [](auto& from, std::vector<double>& to) {
    for (const auto& value : from) to.push_back(value());
    from.clear();
  };
  for (const ProbeConfig& p : probes) {
    if (read.size() == most) take(read, values);
    read.push_back(probe_later(w, p));
  }
  return [take, read, values]() mutable {
    take(read, values);
    return values;
  };
}

}  // namespace breccia
