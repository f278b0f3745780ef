// Time of each kernel of a step on a GPU, beside the time that its bytes need.

#include <map>

#include "bench/benchmark.hpp"
#include "bench/measurements.hpp"
#include "bench/scenes.hpp"
#include "dem/world.hpp"
#include "exec/device.hpp"
#include "exec/launch_times.hpp"
#include "fdem/world.hpp"
#include "prepare/build.hpp"

namespace breccia {
namespace {

/// Bytes that a kernel must read and write at least, each array's once.
struct CountedKernel {
  const char* name;
  double bytes;
};

template <class T>
constexpr double size = sizeof(T);

/// Elements, links: as many as there are, their sizes as they are stored.
std::vector<CountedKernel> counted(const dem::World& w) {
  const bool mixed = w.exec.precision != Precision::full;
  const double elements = w.elements.size(), links = w.links();
  const double number = mixed ? size<float> : size<double>;
  const double action = size<dem::PairForce>;
  const double actions = w.concrete.size() * (mixed ? size<dem::PairForceOf<float>> : action) +
                         (w.steel.size() + w.interface.size()) * action;
  const double ends = 2 * size<Index>, state = size<dem::ElementState>;
  const double concrete = w.concrete.size() * (ends + 2 * size<double> + 2 * 7 * number);
  const double steel = w.steel.size() * (ends + size<double> + 2 * size<dem::SteelState>);
  const double interface =
      w.interface.size() * (2 * ends + 2 * size<double> + 2 * size<dem::InterfaceState>);
  const double given = 2 * size<double> + size<std::uint8_t>;  // mass, inertia, what is held
  return {{"dem.move_and_watch",
           elements * (2 * state + 2 * size<Quaternion> + given + 3 * size<Vec3> + size<double>)},
          {"dem.concrete_links", concrete + steel + interface + actions + elements * state},
          {"dem.gather_wide",
           actions + links * ends +
               elements * (4 * size<Index> + given + 2 * size<Vec3> + size<double>)}};
}

std::vector<CountedKernel> counted(const fdem::World& w) {
  const bool mixed = w.exec.precision != Precision::full;
  const double joint_force = mixed ? size<fdem::JointForceOf<float>> : size<fdem::JointForce>;
  const double couple_force = mixed ? size<fdem::CoupleForceOf<float>> : size<fdem::CoupleForce>;
  const double triangles = w.triangles.size(), joints = w.joints.size();
  const double couples = w.couples.size(), near = w.reach.element.size();
  const double nodes = size<fdem::TriangleNodes>, corners = size<fdem::Corners>;
  const double of_joints = joints * (size<fdem::JointStage> + size<fdem::JointEnds> + size<Index> +
                                     2 * size<double> + joint_force);
  const double of_couples = couples * (4 * size<Index> + couple_force);
  return {{"fdem.move_and_watch", triangles *
                                      (2 * nodes + corners + size<double> + 2 * size<Index>)+near *
                                      (corners + size<double>)},
          {"fdem.whole_joints", of_joints + triangles * nodes},
          {"fdem.couples + fdem.joints", of_couples + of_joints + triangles * nodes},
          {"fdem.couples", of_couples + triangles * nodes},
          {"fdem.triangles",
           triangles * (5 * size<Index> + 3 * size<double> + nodes + size<Mat2> + corners) +
               joints * joint_force + couples * couple_force}};
}

/// Bytes a second that this GPU copies, read and written.
double copy_bandwidth() {
  constexpr Index bytes = 1 << 30;
  constexpr int times = 20;
  Buffer<std::byte> from(Space::cuda, bytes), to(Space::cuda, bytes);
  const auto copy = [&] {
    for (int k = 0; k < times; ++k)
      copy_bytes(to.data(), Space::cuda, from.data(), Space::cuda, bytes);
    wait_for_device();
  };
  copy();
  return 2.0 * times * bytes / seconds_of(copy);
}

/// A line for each kernel: its time by itself, a step's worth; the share of the copy's bandwidth.
template <class World>
void report_kernels(const std::string& scene, World& w, double bandwidth,
                    std::vector<Measurement>& result) {
  constexpr int steps = 40;
  const auto take_steps = [&] {
    StopAt stop;
    for (stop.step = w.step + steps; w.step < stop.step;) advance(w, stop);
  };
  take_steps();
  std::map<std::string, std::vector<double>> seconds;
  std::map<std::string, double> launches;
  {
    LaunchTimes times;
    for (int window = 0; window < window_count; ++window) {
      take_steps();
      for (const auto& [kernel, entry] : times.take()) {
        seconds[kernel].resize(static_cast<std::size_t>(window), 0.0);
        seconds[kernel].push_back(entry.seconds / steps);
        launches[kernel] += static_cast<double>(entry.launches) / (window_count * steps);
      }
    }
  }
  const auto kernels = counted(w);
  for (auto& [kernel, values] : seconds) {
    values.resize(window_count, 0.0);
    const Measurement spent = over_windows(scene, kernel, "us a step", values, 1e6);
    if (spent.median < 0.05) continue;  // of searches, where windows have none or one
    result.push_back(spent);
    for (const CountedKernel& one : kernels) {
      if (kernel.find(one.name) == std::string::npos) continue;
      result.push_back(once(scene, "  bytes, floor by copying", 1e6 * one.bytes / bandwidth, "us"));
      std::vector<double> share;
      for (const double s : values) share.push_back(one.bytes / s / bandwidth);
      result.push_back(over_windows(scene, "  share of the copy's speed", "-", share, 1.0));
      break;
    }
  }
}

}  // namespace

std::vector<Measurement> measure_roofline(const Exec& exec) {
  std::vector<Measurement> result;
  if (exec.space != Space::cuda) return result;
  const double bandwidth = copy_bandwidth();
  result.push_back(once("device", "copy, read and written", 1e-12 * bandwidth, "TB/s"));
  for (const int copies : {1, 70}) {
    dem::Config config = slab_scene(1.0);
    if (copies > 1) config.supports.clear();
    dem::World w = dem::make_world(
        config, side_by_side(build_model(config, "", exec), copies, exec.threads), exec);
    report_kernels(std::to_string(copies) + " slabs", w, bandwidth, result);
  }
  for (const int count : {52'000, 1'000'000}) {
    fdem::World w = plate_world(exec, count);
    report_kernels("plate of " + std::to_string(count), w, bandwidth, result);
  }
  fdem::World heap = heap_world(exec, 32'400);
  report_kernels("32400 hexagons", heap, bandwidth, result);
  return result;
}

}  // namespace breccia
