// Benchmarks of the FDEM: cost against the number of triangles, and against the density of
// contacts.

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/benchmark.hpp"
#include "bench/measurements.hpp"
#include "bench/scenes.hpp"
#include "core/state_hash.hpp"
#include "exec/memory.hpp"
#include "fdem/world.hpp"
#include "prepare/build_fdem.hpp"

namespace breccia {
namespace {

/// A plate of about `count` triangles, all joined, that rings: it starts at 1 m/s between supports.
fdem::Config ringing_plate(int count) {
  fdem::Config config = granite();
  fdem::BodyConfig plate;
  plate.name = "plate";
  plate.material = "rock";
  plate.shape = "plate";
  plate.structured = true;
  plate.mesh_size = 1e-3;
  const double edge = std::sqrt(0.433 * count) * plate.mesh_size;
  plate.size = {edge, edge};
  plate.velocity = {0.3, 1.0};
  config.bodies.push_back(plate);
  fdem::SupportConfig floor;
  floor.name = "floor";
  floor.region.max = {no_limit, -0.5 * edge + 0.1 * plate.mesh_size};
  config.supports.push_back(floor);
  return config;
}

constexpr double hexagon_side = 1e-3;  ///<  [m]
constexpr double built_gap = 1e-5;     ///< between hexagons as they are built  [m]

/// Hexagons of six free triangles that fly together.
fdem::Config flying_hexagons(int count) {
  fdem::Config config = granite();
  config.materials[0].joints = "none";
  fdem::BodyConfig blocks;
  blocks.name = "blocks";
  blocks.material = "rock";
  blocks.shape = "hexagons";
  blocks.hexagons.count = count;
  blocks.hexagons.side = hexagon_side;
  blocks.hexagons.gap = built_gap;
  blocks.velocity = {0.0, -5.0};
  config.bodies.push_back(blocks);
  return config;
}

fdem::Model model_of(const fdem::Config& config) {
  return build_fdem_model(config.bodies, config.discontinuities, {{"rock"}, {}}, config.seed, "");
}

/// How hexagons lie: the flat sides of a row face each other.
struct Spacing {
  const char* name;
  double gap;   ///< between two of a row; below 0 they overlap  [m]
  double rows;  ///< from one row to the next, over what the gap asks  [-]
};

/// The centre of the hexagon that each triangle is of: all six share it.
std::vector<Index> centres(const fdem::Model& model) {
  std::vector<int> triangles(model.point.size());
  for (const auto& corners : model.triangle)
    for (const Index v : corners) ++triangles[static_cast<std::size_t>(v)];
  std::vector<Index> centre;
  for (const auto& corners : model.triangle)
    centre.push_back(*std::find_if(corners.begin(), corners.end(), [&](Index v) {
      return triangles[static_cast<std::size_t>(v)] == 6;
    }));
  return centre;
}

/// Moves each hexagon as a whole, by a function of its centre.
template <class ShiftOf>
void move_hexagons(fdem::Model& model, const ShiftOf& shift_of) {
  const std::vector<Index> centre = centres(model);
  std::vector<Vec2> moved = model.point;
  for (std::size_t t = 0; t < model.triangle.size(); ++t) {
    const Vec2 shift = shift_of(centre[t]);
    for (const Index v : model.triangle[t])
      moved[static_cast<std::size_t>(v)] = model.point[static_cast<std::size_t>(v)] + shift;
  }
  model.point = moved;
}

/// From the built gap to the spacing's.
void spread(fdem::Model& model, const Spacing& spacing) {
  const double built = std::sqrt(3.0) * hexagon_side + built_gap;
  const double x = (std::sqrt(3.0) * hexagon_side + spacing.gap) / built;
  move_hexagons(model, [&](Index centre) {
    const Vec2 from = model.point[static_cast<std::size_t>(centre)];
    return Vec2{(x - 1.0) * from.x, (x * spacing.rows - 1.0) * from.y};
  });
}

/// Hexagons change places, so that those beside each other in space lie anywhere in memory.
void mingle(fdem::Model& model) {
  std::vector<Index> from = centres(model);
  std::sort(from.begin(), from.end());
  from.erase(std::unique(from.begin(), from.end()), from.end());
  std::vector<Index> to = from;
  std::sort(to.begin(), to.end(), [](Index a, Index b) {
    return mixed(static_cast<std::uint64_t>(a)) < mixed(static_cast<std::uint64_t>(b));
  });
  std::map<Index, Index> place;
  for (std::size_t i = 0; i < from.size(); ++i) place[from[i]] = to[i];
  move_hexagons(model, [&](Index centre) {
    return model.point[static_cast<std::size_t>(place.at(centre))] -
           model.point[static_cast<std::size_t>(centre)];
  });
}

/// Couples that push each other now.
Index touching(const fdem::World& w) {
  return with_number(w.exec.precision, [&](auto number) {
    using Force = fdem::CoupleForceOf<decltype(number)>;
    std::vector<Force> forces;
    copy_to(forces, w.couples.history.force.as<decltype(number)>());
    return static_cast<Index>(std::count_if(forces.begin(), forces.end(), [](const Force& stored) {
      const auto f = fdem::converted<double>(stored);
      return norm(f.on_a.at[0]) + norm(f.on_a.at[1]) + norm(f.on_a.at[2]) > 0.0;
    }));
  });
}

void take_steps(fdem::World& w, int steps) {
  StopAt stop;
  for (stop.step = w.step + steps; w.step < stop.step;) fdem::advance(w, stop);
}

void report_steps(fdem::World& w, StageTimers& timers, const std::string& part, int steps,
                  std::vector<Measurement>& result) {
  std::vector<double> wall;
  std::map<std::string, std::vector<double>> stages;
  const std::int64_t searched = w.searches;
  for (int window = 0; window < window_count; ++window) {
    timers.clear();
    wall.push_back(seconds_of([&] { take_steps(w, steps); }) / steps);
    for (const auto& [stage, entry] : timers.stages()) {
      stages[stage].resize(wall.size() - 1, 0.0);
      stages[stage].push_back(entry.seconds / steps);
    }
  }
  const double triangles = w.triangles.size(), joints = w.joints.size();
  result.push_back(once(part, "triangles", triangles, "-"));
  result.push_back(once(part, "joints", joints, "-"));
  result.push_back(once(part, "couples", w.couples.size(), "-"));
  if (w.couples.size() > 0) result.push_back(once(part, "touching", touching(w), "-"));
  result.push_back(over_windows(part, "step", "us", wall, 1e6));
  result.push_back(over_windows(part, "ns_per_triangle_step", "ns", wall, 1e9 / triangles));
  if (joints > 0 && stages.contains("joint_forces"))
    result.push_back(
        over_windows(part, "ns_per_joint_step", "ns", stages["joint_forces"], 1e9 / joints));
  if (w.couples.size() > 0 && stages.contains("contact_forces"))
    result.push_back(over_windows(part, "ns_per_couple_step", "ns", stages["contact_forces"],
                                  1e9 / w.couples.size()));
  for (auto [stage, values] : stages) {
    values.resize(wall.size(), 0.0);
    result.push_back(over_windows(part, "stage " + stage, "us a step", values, 1e6));
  }
  result.push_back(once(part, "searches", static_cast<double>(w.searches - searched), "-"));
}

void report_plate(const Exec& exec, int count, int steps, std::vector<Measurement>& result) {
  forget_peak_of_arrays(exec.space);  // of plates before
  StageTimers timers;
  Exec timed = exec;
  timed.timers = &timers;
  fdem::World w(timed);
  const double setup = seconds_of([&] { w = plate_world(timed, count); });
  const std::string part = "plate of " + std::to_string(count);
  report_steps(w, timers, part, steps, result);
  result.push_back(once(part, "setup", setup, "s"));
  result.push_back(arrays_at_most(part, exec.space, "triangle", w.triangles.size()));
}

}  // namespace

fdem::World plate_world(const Exec& exec, int count) {
  const fdem::Config config = ringing_plate(count);
  return fdem::make_world(config, model_of(config), exec);
}

fdem::World heap_world(const Exec& exec, int count, bool mingled) {
  const fdem::Config config = flying_hexagons(count);
  fdem::Model model = model_of(config);
  spread(model, {"near, gap 50 um", 5e-5, 1.0});
  if (mingled) mingle(model);
  return fdem::make_world(config, model, exec);
}

std::vector<Measurement> measure_triangles(const Exec& exec) {
  std::vector<Measurement> result;
  for (const int count : {10'000, 52'000, 100'000, 1'000'000, 10'000'000}) {
    if (count > 1'000'000 && exec.space != Space::cuda) continue;  // minutes
    const int on_host = count > 200'000 ? 5 : 2'000'000 / count;
    report_plate(exec, count, exec.space == Space::cuda && count > 200'000 ? 200 : on_host, result);
  }
  return result;
}

std::vector<Measurement> measure_largest_plate(const Exec& exec) {
  std::vector<Measurement> result;
  if (exec.space == Space::cuda) report_plate(exec, 50'000'000, 30, result);
  return result;
}

std::vector<Measurement> measure_heap(const Exec& exec) {
  std::vector<Measurement> result;
  for (const int count : {32'400, 324'000, 3'240'000})
    for (const bool mingled : {false, true}) {
      if (count > 100'000 && exec.space != Space::cuda) continue;  // minutes
      if (count > 1'000'000 && mingled) continue;
      StageTimers timers;
      Exec timed = exec;
      timed.timers = &timers;
      fdem::World w = heap_world(timed, count, mingled);
      const std::string part =
          std::to_string(count) + (mingled ? " hexagons in any order" : " hexagons");
      report_steps(w, timers, part, 40, result);
    }
  return result;
}

std::vector<Measurement> measure_contact(const Exec& exec) {
  std::vector<Measurement> result;
  const fdem::Config config = flying_hexagons(8'000);
  for (const Spacing& spacing :
       {Spacing{"apart, gap 0.5 mm", 5e-4, 1.0},
        Spacing{"rows, gap 50 um in a row, 0.35 mm between", 5e-5, 1.2},
        Spacing{"near, gap 50 um", 5e-5, 1.0}, Spacing{"close, gap 10 um", 1e-5, 1.0},
        Spacing{"touching, overlap 1 um", -1e-6, 1.0},
        Spacing{"pressed, overlap 20 um", -2e-5, 1.0},
        Spacing{"crushed, overlap 0.1 mm", -1e-4, 1.0}}) {
    StageTimers timers;
    Exec timed = exec;
    timed.timers = &timers;
    fdem::Model model = model_of(config);
    spread(model, spacing);
    fdem::World w = fdem::make_world(config, model, timed);
    report_steps(w, timers, spacing.name, 40, result);
  }
  return result;
}

}  // namespace breccia
