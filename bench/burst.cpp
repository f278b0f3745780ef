// The search when fragments fly far apart: a grid of cells over the bounding box would grow without
// bound, and with it the search.

#include <fmt/format.h>

#include "bench/benchmark.hpp"
#include "bench/measurements.hpp"
#include "bench/scenes.hpp"
#include "core/travel.hpp"
#include "exec/device.hpp"
#include "prepare/build.hpp"

namespace breccia {
namespace {

/// The slab with every `stride`-th element moved away from its centre to `factor` times as far.
Buffer<Box> burst_slab(const Exec& exec, const dem::Model& slab, std::size_t stride,
                       double factor) {
  constexpr double margin = 5e-4;  // of a slab's elements at rest  [m]
  std::vector<Vec3> centres(slab.position.begin(), slab.position.end());
  for (std::size_t e = 0; e < centres.size(); e += stride) centres[e] = factor * centres[e];
  Buffer<Vec3> centre(exec.space);
  Buffer<double> radius(exec.space), margins(exec.space);
  copy_to(centre, centres);
  copy_to(radius, slab.radius);
  copy_to(margins, std::vector<double>(centres.size(), margin));
  Buffer<Box> boxes(exec.space);
  sphere_boxes(exec, centre, radius, margins, boxes);
  return boxes;
}

}  // namespace

std::vector<Measurement> measure_burst(const Exec& exec) {
  const dem::Model slab = build_model(slab_scene(1.0), "");
  std::vector<GlobalId> numbers(slab.position.size());
  for (std::size_t e = 0; e < numbers.size(); ++e) numbers[e] = static_cast<GlobalId>(e);
  Buffer<GlobalId> ids(exec.space);
  copy_to(ids, numbers);
  std::vector<Measurement> result;
  for (const std::size_t stride : {10, 1})
    for (const double factor : {1.0, 10.0, 100.0, 1000.0}) {
      const Buffer<Box> boxes = burst_slab(exec, slab, stride, factor);
      BroadPhase broad_phase(exec.space);
      Pairs pairs(exec.space);
      std::vector<double> spent;
      for (int window = 0; window <= window_count; ++window) {
        const double seconds = seconds_of([&] {
          broad_phase.search(exec, boxes, ids, pairs);
          if (exec.space == Space::cuda) wait_for_device();
        });
        if (window > 0) spent.push_back(seconds);  // the first one takes memory
      }
      const std::string part = fmt::format(
          "{} {:.0f} times as far", stride == 1 ? "all elements" : "every tenth element", factor);
      result.push_back(over_windows(part, "search", "ms", spent, 1e3));
      result.push_back(once(part, "pairs", pairs.size(), "-"));
      result.push_back(
          once(part, "comparisons", static_cast<double>(broad_phase.tested(exec)), "-"));
    }
  return result;
}

}  // namespace breccia
