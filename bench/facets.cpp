#include <fmt/format.h>

#include <cmath>
#include <ctime>

#include "bench/benchmark.hpp"
#include "bench/measurements.hpp"
#include "dem/observe.hpp"
#include "prepare/build.hpp"

namespace breccia {
namespace {

dem::SupportConfig end_plate(const char* name, double low, double high, double speed) {
  dem::SupportConfig plate;
  plate.name = name;
  plate.min = {-1.0, -1.0, low};
  plate.max = {1.0, 1.0, high};
  plate.fix = {"z", "spin_x", "spin_y"};
  plate.velocity = {0.0, 0.0, speed};
  plate.ramp = 2e-5;
  return plate;
}

/// The cube of cases/ldpm_cube between plates, `speed` upwards at its head: 16,440 facets.
dem::Config cube_scene(double speed) {
  dem::Config config;
  config.time.end = 1.0;
  dem::MaterialConfig concrete;
  concrete.name = "concrete";
  concrete.law = "ldpm";
  concrete.density = 2338.0;
  concrete.young = 39e9;
  concrete.poisson = 0.1764706;
  concrete.tensile_strength = 3.44e6;
  concrete.cohesion = 8.944e6;
  config.materials = {concrete};
  dem::BodyConfig cube;
  cube.name = "cube";
  cube.material = "concrete";
  cube.size = {0.05, 0.05, 0.05};
  config.bodies = {cube};
  config.supports = {end_plate("foot", -1.0, -0.02499, 0.0),
                     end_plate("head", 0.02499, 1.0, speed)};
  return config;
}

/// @param from  path of the head at which windows begin  [m]
void report_cube(const char* part, double speed, double from, const Exec& exec,
                 std::vector<Measurement>& result) {
  constexpr int steps = 40;
  const dem::Config config = cube_scene(speed);
  dem::World w = dem::make_world(config, build_model(config, ""), exec);
  StopAt stop;
  for (stop.time = from / std::abs(speed); w.time < stop.time;) dem::advance(w, stop);
  std::vector<double> wall, processor;
  for (int window = 0; window < window_count; ++window) {
    stop = {};
    stop.step = w.step + steps;
    const std::clock_t start = std::clock();
    wall.push_back(seconds_of([&] {
                     while (w.step < stop.step) dem::advance(w, stop);
                   }) /
                   steps);
    processor.push_back(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / steps);
  }
  const double facets = w.ldpm.size();
  result.push_back(over_windows(part, "ns_per_facet_step", "ns", wall, 1e9 / facets));
  result.push_back(
      over_windows(part, "processor_ns_per_facet_step", "ns", processor, 1e9 / facets));
  result.push_back(once(part, "facets_broken", dem::count(w).broken_links(), "-"));
  result.push_back(
      {part, "state_hash", "-", 0.0, 0.0, 0.0, fmt::format("{:016x}", dem::state_hash(w))});
}

}  // namespace

std::vector<Measurement> measure_facets(const Exec& exec) {
  std::vector<Measurement> result;
  report_cube("elastic", 0.1, 0.0, exec, result);
  report_cube("cracking", 0.5, 40e-6, exec, result);
  report_cube("crushing", -1.0, 150e-6, exec, result);
  return result;
}

}  // namespace breccia
