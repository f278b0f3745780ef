#pragma once
// The built-in benchmarks: fixed work whose speed is measured on this machine.

#include <string>
#include <vector>

#include "exec/space.hpp"

namespace breccia::app {

/// A number a benchmark measured.
struct Measurement {
  std::string name;  ///< "ns_per_link_step", ...
  double value;
  std::string unit;
};

/// One benchmark. To add one: a line in benchmarks.cpp.
struct Benchmark {
  const char* name;
  const char* meaning;  ///< one line for people
  std::vector<Measurement> (*measure)(const Exec& exec);
};

const std::vector<Benchmark>& benchmarks();

}  // namespace breccia::app
