#pragma once
// Fluid that spreads through a network of cracks: which of them are filled at a time.

#include <algorithm>
#include <functional>
#include <map>
#include <queue>
#include <utility>
#include <vector>

#include "fdem_shared/fluid/cracks.hpp"

namespace breccia::fdem_shared {

/// The earliest time at which fluid is at each port that it has reached.
template <class Crack>
std::map<Port, double> arrivals(const std::vector<Crack>& cracks, const std::vector<Port>& sources,
                                double speed, double now) {
  constexpr double never = 1e300;
  std::vector<std::pair<Port, std::size_t>> at_port;
  at_port.reserve(Crack::ports * cracks.size());
  for (std::size_t i = 0; i < cracks.size(); ++i)
    for (const Port port : cracks[i].port) at_port.emplace_back(port, i);
  std::sort(at_port.begin(), at_port.end());
  using Front = std::pair<double, Port>;
  std::priority_queue<Front, std::vector<Front>, std::greater<>> fronts;
  std::map<Port, double> reached;
  for (const Port port : sources)
    if (reached.emplace(port, 0.0).second) fronts.emplace(0.0, port);
  while (!fronts.empty()) {
    const auto [time, port] = fronts.top();
    fronts.pop();
    if (time > reached.at(port)) continue;
    for (auto next =
             std::lower_bound(at_port.begin(), at_port.end(), std::make_pair(port, std::size_t{0}));
         next != at_port.end() && next->first == port; ++next) {
      const Crack& crack = cracks[next->second];
      const auto from =
          static_cast<int>(std::find(crack.port, crack.port + Crack::ports, port) - crack.port);
      for (int to = 0; to < Crack::ports; ++to) {
        if (to == from) continue;
        const double way = speed > 0.0 ? crack.way(from, to) / speed : 0.0;
        const double there = std::max(time, crack.since) + way;
        if (there > now) continue;
        const auto found = reached.emplace(crack.port[to], never).first;
        if (there >= found->second) continue;
        found->second = there;
        fronts.emplace(there, crack.port[to]);
      }
    }
  }
  return reached;
}

/// A crack, and how much of it is filled.
template <class Crack>
struct FilledCrack {
  Crack crack;
  double share = 0.0;  ///< in (0, 1]  [-]
};

/// Which cracks are filled. Fluid is at the sources from the start of the case on, enters a crack
/// when it has come to one of its ports and the crack is broken, and fills it with a given speed
/// from each; where cracks share a port they are connected. Times of arrival are those of shortest
/// ways, in space from middle to middle of edges, so that they depend neither on the order of
/// cracks nor on how often this is asked.
/// @param sources  ports, in any order
/// @param speed    of the front; 0: cracks fill at once  [m/s]
/// @param now      [s]
template <class Crack>
std::vector<FilledCrack<Crack>> filled_cracks(const std::vector<Crack>& cracks,
                                              const std::vector<Port>& sources, double speed,
                                              double now) {
  const std::map<Port, double> reached = arrivals(cracks, sources, speed, now);
  std::vector<FilledCrack<Crack>> filled;
  for (const Crack& crack : cracks) {
    double share = 0.0;
    for (int k = 0; k < Crack::ports; ++k) {
      const auto found = reached.find(crack.port[k]);
      if (found == reached.end()) continue;
      const double spent = now - std::max(found->second, crack.since);
      if (spent < 0.0) continue;
      share += speed > 0.0 ? spent * speed / crack.depth(k) : 1.0;
    }
    if (share > 0.0) filled.push_back({crack, std::min(share, 1.0)});
  }
  return filled;
}

}  // namespace breccia::fdem_shared
