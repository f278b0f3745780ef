#include "bench/ranks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/measurements.hpp"
#include "bench/scenes.hpp"
#include "bench/tiles.hpp"
#include "dem/observe.hpp"
#include "dem/ranks.hpp"
#include "exec/device.hpp"
#include "exec/error.hpp"
#include "exec/memory.hpp"
#include "fdem/observe.hpp"
#include "fdem/ranks.hpp"
#include "run/machine/machine.hpp"

namespace breccia {
namespace {

constexpr std::int64_t slab_size = 14'274;  // elements of one slab

/// Data that several ranks share; a rank alone has it all by itself.
struct All {
  Communicator* ranks;

  int count() const { return ranks == nullptr ? 1 : ranks->size(); }
  double least(double value) const { return ranks == nullptr ? value : ranks->least(value); }
  double most(double value) const { return -least(-value); }
  std::int64_t sum(std::int64_t number) const {
    if (ranks != nullptr) ranks->add_up({&number, 1});
    return number;
  }
  double waited() const { return ranks == nullptr ? 0.0 : ranks->waited(); }
  /// A failure of one rank while all step is not known to the others.
  void begin_steps() const {
    if (ranks != nullptr) ranks->set_in_step(false);
  }
  void end_steps() const {
    if (ranks != nullptr) ranks->set_in_step(true);
  }
};

Index size_of(const dem::World& w) {
  return w.elements.size();
}
Index size_of(const fdem::World& w) {
  return w.triangles.size();
}

/// Ends with all work of a device done.
template <class World>
void take_steps(World& w, int steps) {
  if (!w.domain.single_rank()) w.domain.pace.resume(*w.domain.ranks);
  StopAt stop;
  for (stop.step = w.step + steps; w.step < stop.step;) advance(w, stop);
  if (!w.domain.single_rank()) w.domain.pace.pause(*w.domain.ranks);
  rebalance(w);
  if (w.exec.space == Space::cuda) wait_for_device();
}

/// Of scenes before.
void forget_peaks(Space space) {
  forget_peak_of_arrays(Space::host);
  if (space == Space::cuda) forget_peak_of_arrays(space);
}

/// Memory that a rank has at most held, with building its part of the model.  [B]
void report_memory(const All& all, Space space, std::vector<Measurement>& result) {
  const char* const part = "memory of a rank";
  const auto of_ranks = [&](const char* name, double bytes) {
    const double mean =
        static_cast<double>(all.sum(static_cast<std::int64_t>(bytes))) / all.count();
    result.push_back(
        {part, name, "GB", 1e-9 * mean, 1e-9 * all.least(bytes), 1e-9 * all.most(bytes)});
  };
  of_ranks("peak_resident", static_cast<double>(peak_memory()));
  of_ranks("peak_arrays", static_cast<double>(peak_array_bytes(Space::host)));
  if (space == Space::cuda)
    of_ranks("peak_arrays_of_device", static_cast<double>(peak_array_bytes(space)));
}

/// How ranks fared in the windows.
/// @param waited  by this rank for others  [s]
/// @param spent   in the windows  [s]
void report_ranks(const All& all, const DomainCounts& before, const DomainCounts& now,
                  double waited, double spent, std::vector<Measurement>& result) {
  if (all.ranks == nullptr) return;
  const char* const part = "ranks";
  const DomainFacts facts = domain_facts(*all.ranks, now, waited);
  result.push_back({part, "waited", "of the time", facts.waited_mean / spent,
                    facts.waited_least / spent, facts.waited_most / spent});
  result.push_back(once(part, "copies", facts.ghosts, "-"));
  const PeerLink* const link = all.ranks->link();
  result.push_back(once(part, "copies_read_directly", link && link->in_use() ? 1.0 : 0.0, "-"));
  result.push_back(once(part, "imbalance", facts.imbalance, "-"));
  result.push_back(
      once(part, "sharings", static_cast<double>(now.migrations - before.migrations), "-"));
  result.push_back(
      once(part, "moved", static_cast<double>(facts.moved - all.sum(before.moved)), "-"));
}

/// Windows of whole steps, and the state that they lead to.
template <class World>
std::vector<Measurement> measure_windows(World& w, const All& all, int steps, double setup) {
  StageTimers timers;
  w.exec.timers = &timers;
  const Index own = w.domain.single_rank() ? size_of(w) : static_cast<Index>(w.domain.counts.owned);
  const auto elements = static_cast<double>(all.sum(own));
  const DomainCounts counts = w.domain.counts;
  const std::int64_t searched = w.searches;
  double waited = 0.0, spent = 0.0;  // in the windows  [s]
  std::vector<double> wall;
  std::map<std::string, std::vector<double>> stages;
  for (int window = 0; window < window_count; ++window) {
    timers.clear();
    all.least(0.0);  // they begin together
    const double waited_before = all.waited();
    const double own_time = seconds_of([&] { take_steps(w, steps); });
    waited += all.waited() - waited_before;
    wall.push_back(all.most(own_time) / steps);
    spent += wall.back() * steps;
    for (const auto& [stage, entry] : timers.stages()) {
      stages[stage].resize(wall.size() - 1, 0.0);
      stages[stage].push_back(entry.seconds / steps);
    }
  }
  all.end_steps();
  w.exec.timers = nullptr;

  const char* const part = "steps";
  std::vector<Measurement> result{once("scene", "ranks", all.count(), "-"),
                                  once("scene", "elements", elements, "-"),
                                  once("scene", "setup", setup, "s")};
  result.push_back(over_windows(part, "step", "us", wall, 1e6));
  result.push_back(
      over_windows(part, "rank_ns_per_element_step", "ns", wall, 1e9 * all.count() / elements));
  for (auto [stage, values] : stages) {
    values.resize(wall.size(), 0.0);
    result.push_back(over_windows(part, "stage " + stage, "us a step", values, 1e6));
  }
  result.push_back(once(part, "searches", static_cast<double>(w.searches - searched), "-"));
  report_ranks(all, counts, w.domain.counts, waited, spent, result);
  report_memory(all, w.exec.space, result);
  const auto hash = static_cast<std::uint64_t>(all.sum(static_cast<std::int64_t>(state_hash(w))));
  result.push_back({"state", "step", "-", static_cast<double>(w.step), static_cast<double>(w.step),
                    static_cast<double>(w.step)});
  result.push_back({"state", "hash", "-", 0.0, 0.0, 0.0, fmt::format("{:016x}", hash)});
  return result;
}

/// @param parts  each with so many elements  [-]
std::int64_t asked(const RankScale& scale, const Exec& exec, int parts, std::int64_t on_host,
                   std::int64_t on_device) {
  constexpr std::int64_t most = 350'000'000;  // links and sides of edges are numbered by 31 bits
  const std::int64_t standard = exec.space == Space::cuda ? on_device : on_host;
  const std::int64_t elements = scale.elements > 0 ? scale.elements : standard;
  if (elements > most / parts)
    throw InputError(fmt::format("--elements {}: {} elements in all are more than {}", elements,
                                 elements * parts, most));
  return elements;
}

/// @param parts  each with so many elements  [-]
std::vector<Measurement> measure_slabs(const Exec& exec, Communicator* ranks,
                                       const RankScale& scale, int parts) {
  const All all{ranks};
  forget_peaks(exec.space);
  const std::int64_t elements = asked(scale, exec, parts, 100'000, 10'000'000);
  const std::int64_t slabs = std::max<std::int64_t>(1, (elements + slab_size / 2) / slab_size);
  dem::World w(exec);
  const double setup = seconds_of(
      [&] { w = tiled_slabs(slab_scene(1.0), static_cast<int>(slabs) * parts, ranks, exec); });
  all.begin_steps();
  StopAt stop;
  for (stop.time = slab_impact_at; w.time < stop.time;) advance(w, stop);
  return measure_windows(w, all, scale.steps, setup);
}

std::vector<Measurement> measure_plate(const Exec& exec, Communicator* ranks,
                                       const RankScale& scale, int parts) {
  const All all{ranks};
  forget_peaks(exec.space);
  const std::int64_t elements = asked(scale, exec, parts, 50'000, 10'000'000);
  fdem::World w(exec);
  const double setup =
      seconds_of([&] { w = tiled_plate(plate_tiles(elements, parts), ranks, exec); });
  all.begin_steps();
  take_steps(w, scale.steps);
  return measure_windows(w, all, scale.steps, setup);
}

}  // namespace

std::vector<Measurement> measure_weak_slabs(const Exec& exec, Communicator* ranks,
                                            const RankScale& scale) {
  return measure_slabs(exec, ranks, scale, All{ranks}.count());
}
std::vector<Measurement> measure_strong_slabs(const Exec& exec, Communicator* ranks,
                                              const RankScale& scale) {
  return measure_slabs(exec, ranks, scale, 1);
}
std::vector<Measurement> measure_weak_plate(const Exec& exec, Communicator* ranks,
                                            const RankScale& scale) {
  return measure_plate(exec, ranks, scale, All{ranks}.count());
}
std::vector<Measurement> measure_strong_plate(const Exec& exec, Communicator* ranks,
                                              const RankScale& scale) {
  return measure_plate(exec, ranks, scale, 1);
}

}  // namespace breccia
