#include "app/benchmarks.hpp"

namespace breccia::app {

const std::vector<Benchmark>& benchmarks() {
  static const std::vector<Benchmark> list{};
  return list;
}

}  // namespace breccia::app
