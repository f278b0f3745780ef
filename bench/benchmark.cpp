#include "bench/benchmark.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <functional>
#include <map>

#include "bench/measurements.hpp"
#include "bench/scenes.hpp"
#include "core/travel.hpp"
#include "dem/observe.hpp"
#include "exec/device.hpp"
#include "exec/memory.hpp"
#include "prepare/build.hpp"
#include "prepare/packing/packing.hpp"

namespace breccia {
namespace {

constexpr int steps_before_impact = 100;  // the rock meets the slab after 0.1 ms

void take_steps(dem::World& w, int steps) {
  StopAt stop;
  for (stop.step = w.step + steps; w.step < stop.step;) dem::advance(w, stop);
}

void reach_impact(dem::World& w) {
  StopAt stop;
  for (stop.time = slab_impact_at; w.time < stop.time;) dem::advance(w, stop);
}

/// Times of windows of whole steps.
struct Windows {
  explicit Windows(const char* name) : part(name) {}

  /// Takes `steps` steps as one window.
  void measure(dem::World& w, StageTimers& timers, int steps) {
    timers.clear();
    const std::int64_t searched = w.searches;
    const std::clock_t start = std::clock();
    wall.push_back(seconds_of([&] { take_steps(w, steps); }) / steps);
    processor.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / steps);
    for (const auto& [stage, entry] : timers.stages()) {
      stages[stage].resize(wall.size() - 1, 0.0);
      stages[stage].push_back(entry.seconds / steps);
    }
    searches += w.searches - searched;
    taken += steps;
  }

  void report(const dem::World& w, std::vector<Measurement>& result) const {
    const double links = w.links(), elements = w.elements.size();
    result.push_back(once(part, "steps", taken, "-"));
    result.push_back(over_windows(part, "step", "us", wall, 1e6));
    result.push_back(over_windows(part, "ns_per_link_step", "ns", wall, 1e9 / links));
    result.push_back(over_windows(part, "ns_per_element_step", "ns", wall, 1e9 / elements));
    result.push_back(
        over_windows(part, "processor_ns_per_link_step", "ns", processor, 1e9 / links));
    for (auto [stage, values] : stages) {
      values.resize(wall.size(), 0.0);
      result.push_back(over_windows(part, "stage " + stage, "us a step", values, 1e6));
    }
    const dem::Counts n = dem::count(w);
    result.push_back(once(part, "searches", static_cast<double>(searches), "-"));
    result.push_back(once(part, "contacts_touching", n.touching, "-"));
    result.push_back(once(part, "links_broken", n.broken_links(), "-"));
  }

  std::string part;
  std::vector<double> wall, processor;                ///< of each window  [s a step]
  std::map<std::string, std::vector<double>> stages;  ///< likewise
  std::int64_t searches = 0;
  int taken = 0;  ///< steps in all windows  [-]
};

std::vector<Measurement> measure_scene(const Exec& exec, double scale) {
  forget_peak_of_arrays(exec.space);  // of scenes before
  StageTimers timers;
  Exec timed = exec;
  timed.timers = &timers;
  const dem::Config config = slab_scene(scale);
  dem::Model model;
  dem::World w(timed);
  const double build = seconds_of([&] { model = build_model(config, ""); });
  const double setup = seconds_of([&] { w = dem::make_world(config, model, timed); });
  std::vector<Measurement> result{once("scene", "elements", w.elements.size(), "-"),
                                  once("scene", "links", w.links(), "-"),
                                  once("scene", "links_concrete", w.concrete.size(), "-"),
                                  once("scene", "links_steel", w.steel.size(), "-"),
                                  once("scene", "links_interface", w.interface.size(), "-"),
                                  once("scene", "build_model", build, "s"),
                                  once("scene", "make_world", setup, "s")};
  result.push_back(arrays_at_most("memory", exec.space, "element", w.elements.size()));
  Windows before("before impact"), during("during impact");
  for (int window = 0; window < window_count; ++window) {
    if (window > 0) w = dem::make_world(config, model, timed);
    before.measure(w, timers, steps_before_impact);
  }
  before.report(w, result);
  reach_impact(w);
  for (int window = 0; window < window_count; ++window) during.measure(w, timers, 40);
  during.report(w, result);
  return result;
}

/// Slabs side by side during the impact.
void report_slabs(const Exec& exec, int copies, int steps, std::vector<Measurement>& result) {
  dem::Config config = slab_scene(1.0);
  config.supports.clear();
  forget_peak_of_arrays(exec.space);                    // of scenes before
  if (exec.space == Space::cuda) return_free_memory();  // likewise
  dem::World w(exec);
  const double setup = seconds_of([&] {
    w = dem::make_world(config, side_by_side(build_model(config, "", exec), copies, exec.threads),
                        exec);
  });
  reach_impact(w);
  std::vector<double> wall;
  for (int window = 0; window < window_count; ++window)
    wall.push_back(seconds_of([&] { take_steps(w, steps); }) / steps);
  const std::string part = std::to_string(copies) + " slabs";
  const double elements = w.elements.size();
  result.push_back(once(part, "elements", elements, "-"));
  result.push_back(once(part, "links", w.links(), "-"));
  result.push_back(once(part, "setup", setup, "s"));
  result.push_back(over_windows(part, "step", "us", wall, 1e6));
  result.push_back(over_windows(part, "ns_per_link_step", "ns", wall, 1e9 / w.links()));
  result.push_back(arrays_at_most(part, exec.space, "element", elements));
}

/// Spheres of radii 0.8 to 1.2 m filling 60 % of a cube.
struct RandomSpheres {
  explicit RandomSpheres(Index count) : boxes(Space::host) {
    const Random random{42, 0};
    const double edge = std::cbrt(count * 4.0 / 3.0 * 3.14159 * 1.04 / 0.6);
    std::vector<Vec3> centres;
    std::vector<double> radii, margins;
    std::vector<GlobalId> numbers;
    for (Index i = 0; i < count; ++i) {
      const auto at = static_cast<std::uint64_t>(i);
      centres.push_back(edge *
                        Vec3{random.uniform(at, 0), random.uniform(at, 1), random.uniform(at, 2)});
      radii.push_back(0.8 + 0.4 * random.uniform(at, 3));
      margins.push_back(0.05);
      numbers.push_back(i);
    }
    Buffer<Vec3> centre;
    Buffer<double> radius, margin;
    copy_to(centre, centres);
    copy_to(radius, radii);
    copy_to(margin, margins);
    copy_to(ids, numbers);
    sphere_boxes({}, centre, radius, margin, boxes);
  }
  Buffer<Box> boxes;
  Buffer<GlobalId> ids;
};

}  // namespace

std::vector<Measurement> measure_slab(const Exec& exec) {
  return measure_scene(exec, 1.0);
}

std::vector<Measurement> measure_large_slab(const Exec& exec) {
  return measure_scene(exec, 2.7);
}

std::vector<Measurement> measure_slabs(const Exec& exec) {
  std::vector<Measurement> result;
  for (const int copies : {7, 70, 700}) {
    if (copies > 70 && exec.space != Space::cuda) continue;  // minutes and 30 GB
    report_slabs(exec, copies, copies > 70 ? 20 : 50, result);
  }
  return result;
}

std::vector<Measurement> measure_most_slabs(const Exec& exec) {
  std::vector<Measurement> result;
  if (exec.space == Space::cuda) report_slabs(exec, 4400, 15, result);
  return result;
}

std::vector<Measurement> measure_threads(const Exec& exec) {
  const dem::Config config = slab_scene(1.0);
  const dem::Model model = build_model(config, "");
  Exec alone = exec;
  alone.threads = 1;
  dem::World one = dem::make_world(config, model, alone);
  dem::World all = dem::make_world(config, model, exec);
  std::vector<Measurement> result{once("scene", "threads", exec.threads, "-")};
  const auto measure = [&](const char* part, int steps) {
    std::vector<double> one_step, all_step, ratio;
    for (int window = 0; window < window_count; ++window) {
      one_step.push_back(seconds_of([&] { take_steps(one, steps); }) / steps);
      all_step.push_back(seconds_of([&] { take_steps(all, steps); }) / steps);
      ratio.push_back(one_step.back() / all_step.back());
    }
    result.push_back(over_windows(part, "step_on_one_thread", "us", one_step, 1e6));
    result.push_back(over_windows(part, "step_on_all_threads", "us", all_step, 1e6));
    result.push_back(over_windows(part, "times_faster", "-", ratio, 1.0));
  };
  measure("before impact", steps_before_impact / window_count);
  reach_impact(one);
  reach_impact(all);
  measure("during impact", 40);
  return result;
}

std::vector<Measurement> measure_search(const Exec& exec) {
  std::vector<Measurement> result;
  for (const Index count : {14'274, 100'000, 1'000'000}) {
    const RandomSpheres spheres(count);
    BroadPhase broad_phase;
    Pairs pairs;
    std::vector<double> spent;
    for (int window = 0; window <= window_count; ++window) {
      const double seconds =
          seconds_of([&] { broad_phase.search(exec, spheres.boxes, spheres.ids, pairs); });
      if (window > 0) spent.push_back(seconds);  // the first one also takes memory
    }
    const std::string part = std::to_string(count) + " spheres";
    result.push_back(over_windows(part, "search", "ms", spent, 1e3));
    result.push_back(over_windows(part, "ns_per_element", "ns", spent, 1e9 / count));
    result.push_back(once(part, "pairs", pairs.size(), "-"));
    result.push_back(once(part, "comparisons_per_element",
                          static_cast<double>(broad_phase.tested(exec)) / count, "-"));
  }
  return result;
}

std::vector<Measurement> measure_packing(const Exec&) {
  std::vector<Measurement> result;
  for (const int count : {2'000, 12'718}) {
    prepare::PackingTask task;
    const double edge = std::sqrt(count / 12718.0);
    task.container.size = {edge, edge, 0.1};
    task.count = count;
    task.solid_volume = 0.56 * task.container.volume();
    prepare::Packing packing;
    std::vector<double> spent;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      task.random = {seed, 0};
      spent.push_back(seconds_of([&] { packing = prepare::pack(task); }));
    }
    const std::string part = std::to_string(count) + " spheres";
    result.push_back(over_windows(part, "packing", "s", spent, 1.0));
    result.push_back(over_windows(part, "us_per_element", "us", spent, 1e6 / count));
    result.push_back(once(part, "overlap", packing.overlap, "radii"));
  }
  return result;
}

}  // namespace breccia
