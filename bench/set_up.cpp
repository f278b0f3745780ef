#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "bench/measurements.hpp"
#include "bench/ranks.hpp"
#include "bench/scenes.hpp"
#include "dem/observe.hpp"
#include "exec/error.hpp"
#include "exec/timers.hpp"
#include "prepare/build.hpp"
#include "run/machine/machine.hpp"

namespace breccia {
namespace {

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Processor time so far: of the program and of the system for it, by all threads, and of both by
/// this one.  [s]
struct Spent {
  double user, system, alone;

  static Spent now() {
    rusage all{}, own{};
    ::getrusage(RUSAGE_SELF, &all);
    ::getrusage(RUSAGE_THREAD, &own);
    return {seconds(all.ru_utime), seconds(all.ru_stime),
            seconds(own.ru_utime) + seconds(own.ru_stime)};
  }
};

/// Times parts of the work of a scene, in the order in which they are done.
class TimedWork {
 public:
  TimedWork(const char* scene, std::vector<Measurement>& result)
      : scene_(scene), result_(&result) {}

  /// Wall time and that of processors. What one thread does alone is, of T threads,
  /// (T first_thread - user - system) / (T - 1): the others' share of the rest is theirs alike.
  template <class Work>
  void measure(const std::string& part, const Work& work) {
    const Spent before = Spent::now();
    const double wall = seconds_of(work);
    const Spent after = Spent::now();
    tell(part, wall, "s");
    tell(part + ", user", after.user - before.user, "s");
    tell(part + ", system", after.system - before.system, "s");
    tell(part + ", first_thread", after.alone - before.alone, "s");
  }
  void tell(const std::string& name, double value, const char* unit) {
    result_->push_back(once(scene_, name, value, unit));
  }
  /// The stages that were booked since, which are then forgotten.
  void tell_stages(StageTimers& timers) {
    for (const auto& [stage, entry] : timers.stages()) tell("  " + stage, entry.seconds, "s");
    timers.clear();
  }
  void tell_hash(std::uint64_t hash) {
    result_->push_back({scene_, "hash", "-", 0.0, 0.0, 0.0, fmt::format("{:016x}", hash)});
  }

 private:
  std::string scene_;
  std::vector<Measurement>* result_;
};

void measure_world(const Exec& exec, StageTimers& timers, const dem::Config& config,
                   const dem::Model& model, TimedWork& parts) {
  dem::World w(exec);
  parts.measure("world", [&] { w = dem::make_world(config, model, exec); });
  parts.tell_stages(timers);
  parts.tell("elements", w.elements.size(), "-");
  parts.tell("peak_resident", 1e-9 * static_cast<double>(peak_memory()), "GB");
  parts.tell("links", w.links(), "-");
  parts.tell_hash(dem::state_hash(w));
}

/// Packed once, as a cell of about 8,000 elements, and repeated along x and y.
dem::Config repeated_body(std::int64_t elements) {
  dem::Config config = slab_scene(1.0);
  config.supports.clear();
  config.bodies.resize(1);
  dem::BodyConfig& slab = config.bodies[0];
  const double cells = std::max(1.0, std::round(std::sqrt(static_cast<double>(elements) / 8000.0)));
  slab.pack.count = static_cast<int>(8000.0 * cells * cells);
  slab.pack.periodic = {"x", "y"};
  slab.pack.cell = {0.8, 0.8, 0.0};
  slab.size = {0.8 * cells, 0.8 * cells, 0.1};
  config.links = {};
  return config;
}

}  // namespace

std::vector<Measurement> measure_set_up(const Exec& exec, Communicator* ranks,
                                        const RankScale& scale) {
  if (ranks != nullptr && ranks->size() > 1)
    throw InputError("set_up is a benchmark of one rank; start it without mpirun");
  const std::int64_t elements = scale.elements > 0 ? scale.elements : 1'000'000;
  StageTimers timers;
  Exec timed = exec;
  timed.timers = &timers;
  std::vector<Measurement> result;
  {
    TimedWork parts("slabs", result);
    dem::Config config = slab_scene(1.0);
    config.supports.clear();
    dem::Model slab, model;
    parts.measure("one slab", [&] { slab = build_model(config, "", timed); });
    parts.tell_stages(timers);
    const auto copies = static_cast<int>(std::max<std::int64_t>(1, elements / slab.size()));
    parts.measure("side by side", [&] { model = side_by_side(slab, copies, exec.threads); });
    measure_world(timed, timers, config, model, parts);
  }
  {
    TimedWork parts("body", result);
    const dem::Config config = repeated_body(elements);
    dem::Model model;
    parts.measure("model", [&] { model = build_model(config, "", timed); });
    parts.tell_stages(timers);
    measure_world(timed, timers, config, model, parts);
  }
  return result;
}

}  // namespace breccia
