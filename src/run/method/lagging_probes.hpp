#pragma once
// Probes that follow what they read with a lag, as load cells and their amplifiers do.

#include <vector>

#include "core/case_config.hpp"

namespace breccia {

/// dy/dt = (x - y)/lag of what is read, x, and what is told, y: a part of a run's state.
struct LaggingReading {
  double told = 0.0;
  double time = -1.0;  ///< of the last look; below 0: there was none  [s]

  void look(double read, double now, double lag) {
    const double span = now - time;  // by implicit Euler, which holds for any step
    told = time < 0.0 ? read : told + (read - told) * (span / (lag + span));
    time = now;
  }
};

/// The lagging probes of a case look every servo_every steps, so that threads, devices, resumed
/// runs tell alike. Of several ranks the first one has the readings.
class LaggingProbes {
 public:
  explicit LaggingProbes(const std::vector<ProbeConfig>& probes) {
    for (std::size_t k = 0; k < probes.size(); ++k)
      if (probes[k].lag > 0.0) {
        configs_.push_back(probes[k]);
        places_.push_back(k);
      }
    readings_.resize(configs_.size());
  }

  bool empty() const { return configs_.empty(); }
  const std::vector<ProbeConfig>& configs() const { return configs_; }
  /// @param read  of each of configs()
  void look(const std::vector<double>& read, double now) {
    for (std::size_t k = 0; k < readings_.size(); ++k)
      readings_[k].look(read[k], now, configs_[k].lag);
  }
  /// Puts what they tell in place of what is read. @param values  of all probes of the case
  void tell(std::vector<double>& values) const {
    for (std::size_t k = 0; k < readings_.size(); ++k)
      if (readings_[k].time >= 0.0) values[places_[k]] = readings_[k].told;
  }
  template <class Visit>
  void each_stored(const Visit& visit) {
    for (std::size_t k = 0; k < readings_.size(); ++k)
      visit.where_kept("probe." + configs_[k].name, readings_[k]);
  }

 private:
  std::vector<ProbeConfig> configs_;
  std::vector<std::size_t> places_;  ///< among all probes
  std::vector<LaggingReading> readings_;
};

}  // namespace breccia
