#pragma once
// The built-in benchmarks by name.

#include <vector>

#include "run/benchmark.hpp"

namespace breccia::app {

/// One benchmark. To add one: a line in benchmarks.cpp.
struct Benchmark {
  const char* name;
  const char* meaning;  ///< one line for people
  std::vector<Measurement> (*measure)(const Exec& exec);
};

const std::vector<Benchmark>& benchmarks();

}  // namespace breccia::app
