// A launch of tiles, one a multiprocessor; in Space::shadow the processor takes tile after tile,
// phase by phase.

#include "dem/tiles/tile_run.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "core/device_run.hpp"
#include "dem/stepping/launches.hpp"
#include "dem/stepping/step.hpp"
#include "dem/tiles/tile_step.hpp"
#include "exec/error.hpp"
#include "exec/multiprocessors.hpp"

namespace breccia::dem {
namespace {

/// Ends the step that a clock holds open, if there is one, by what all tiles have told.
/// @returns whether tiles leave: at the end, or when a search is near
BR_HD bool end_step(const EndOfStep<StepRule>& end, const TileReport& report, StepClock& clock) {
  if (clock.open != 0)
    clock.least = ordered_bits(min(largest_least, TileStep::critical_of(report.slowest)));
  end(clock);
  clock.host_request = report.near ? 1 : 0;
  return clock.halted != 0 || report.near;
}

/// Time as the forces of a step see it, after its move.
BR_HD StepTime moved(const StepTime& now) {
  return {now.time + now.next_dt, now.next_dt, now.next_dt, now.step};
}
/// The longest step that may follow one: StepRule lets it grow by a twentieth.
BR_HD float longest_after(double dt) {
  return 1.0501F * static_cast<float>(dt);
}
BR_HD float span_after(double dt) {
  return 0.5F * (static_cast<float>(dt) + longest_after(dt));
}

#if defined(__CUDACC__)

/// Findings of a warp's threads together, for its first one.
__device__ TileReport report_of_warp(TileReport own) {
  for (int half = 16; half > 0; half /= 2)
    own.slowest = fmax(own.slowest, __shfl_down_sync(~0U, own.slowest, half));
  own.near = __any_sync(~0U, own.near ? 1 : 0) != 0;
  return own;
}
template <int warps>
__device__ TileReport news_of(const TileReport* of_warp) {
  TileReport report = of_warp[0];
  for (int warp = 1; warp < warps; ++warp) {
    report.slowest = fmax(report.slowest, of_warp[warp].slowest);
    report.near = report.near || of_warp[warp].near;
  }
  return report;
}

/// Loads of others' elements, by `threads` threads: several words are asked for before the first
/// has come.
template <int threads>
__device__ void receive(const TileStep& tile, std::uint32_t tag, Index thread) {
  constexpr int at_once = 6;
  const Index numbers = tile.received();
  for (Index k = thread; k < numbers; k += at_once * threads) {
    std::uint64_t bits[at_once];
    bool came[at_once];
#pragma unroll
    for (int j = 0; j < at_once; ++j) {
      const Index at = k + j * threads;
      came[j] = get(tile.received_word(at < numbers ? at : k, tag), bits[j], tag);
    }
#pragma unroll
    for (int j = 0; j < at_once; ++j) {
      const Index at = k + j * threads;
      if (at >= numbers) break;
      while (!came[j]) came[j] = get(tile.received_word(at, tag), bits[j], tag);
      tile.receive(at, bits[j]);
    }
  }
}

/// Links and contacts: each warp begins with the portion of its number and then asks for more.
template <int threads>
__device__ void pair_forces(const TileStep& tile, double dt, Index thread) {
  const Index lane = thread % TileStep::portion, portions = tile.portions();
  Index number = thread / TileStep::portion;
  while (number < portions) {
    tile.pair_force(dt, number, lane);
    __syncwarp();
    if (lane == 0) number = TileStep::take_number(tile.memory.counters);
    number = __shfl_sync(~0U, number, 0);
  }
}

/// Tells all tiles by `threads` threads what this one has found, and hears of all.
/// @param room  for the findings of each of their warps
/// @returns what this thread has heard
template <int threads>
__device__ TileReport exchange(const TileStep& tile, TileReport report, std::uint32_t tag,
                               Index thread, TileReport* room) {
  const Index tiles = tile.all.tiles.tiles.size;
  report = report_of_warp(report);
  if (thread % 32 == 0) room[thread / 32] = report;
  __barrier_sync_count(1, threads);
  const std::uint64_t own = TileStep::packed(news_of<threads / 32>(room));
  for (Index to = thread; to < tiles; to += threads)
    put(tile.news_word(tag, tile.number, to), own, tag);
  report = TileReport{};
  for (Index from = thread; from < tiles; from += threads) {
    std::uint64_t bits = 0;
    while (!get(tile.news_word(tag, from, tile.number), bits, tag)) {
    }
    TileStep::hear(report, bits);
  }
  return report_of_warp(report);
}

template <int threads>
__global__ void __launch_bounds__(threads, 1) launch_tiles(const __grid_constant__ TileCase all) {
  extern __shared__ __align__(16) std::byte memory[];
  constexpr int judges = 160, warps = judges / 32;  // the others receive loads meanwhile
  __shared__ TileReport told[warps], heard[warps];
  const auto thread = static_cast<Index>(threadIdx.x), number = static_cast<Index>(blockIdx.x);
  const TileStep tile(all, number, memory);
  tile.enter(thread, threads);
  __syncthreads();
  std::uint32_t tag = all.tag;
  int current = 0;
  bool first = true;
  double dt = 0.0;
  for (;;) {
    // Tiles tell each other what they have found, and hear of all.
    ++tag;
    if (thread < judges) {
      TileReport report;
      if (first)
        report.near = tile.near_at_entry(thread, judges);
      else
        for (Index e = thread; e < tile.tile.own; e += judges)
          tile.judge(e, span_after(dt), longest_after(dt), report);
      report = exchange<judges>(tile, report, tag, thread, told);
      if (thread % 32 == 0) heard[thread / 32] = report;
    } else if (!first) {
      receive<threads - judges>(tile, tag, thread - judges);
    }
    first = false;
    __syncthreads();
    StepClock clock = tile.memory.clocks[current];
    if (end_step(all.end, news_of<warps>(heard), clock)) {
      if (number == 0 && thread == 0) *all.clock = clock;
      break;
    }
    tile.move(clock.now, thread, threads);
    clock.open = step_open;
    current = 1 - current;
    if (thread == 0) {
      tile.memory.clocks[current] = clock;
      tile.count_from(threads / TileStep::portion);
    }
    dt = clock.now.next_dt;
    __syncthreads();
    pair_forces<threads>(tile, dt, thread);
    __syncthreads();
    for (Index i = thread; i < tile.sum_items(); i += threads) tile.sum(i, tag + 1);
    __syncthreads();
  }
  tile.leave(thread, threads);
  if (tile.memory.clocks[current].open != 0) tile.leave_actions(thread, threads);
}

#endif

/// All tiles on this processor.
class TilesInTurn {
 public:
  TilesInTurn(const TileCase& all, std::size_t bytes) : all_(all) {
    const std::size_t count = static_cast<std::size_t>(all.tiles.tiles.size);
    const std::size_t lines = bytes / sizeof(Line) + 1;
    memory_.assign(count * lines, Line{});
    for (std::size_t t = 0; t < count; ++t)
      tiles_.emplace_back(all_, static_cast<Index>(t), memory_[t * lines].bytes);
  }

  void run() {
    const KernelScope scope;
    std::vector<TileReport> told(tiles_.size());
    for (const TileStep& tile : tiles_) tile.enter(0, 1);
    for (std::size_t t = 0; t < tiles_.size(); ++t) told[t].near = tiles_[t].near_at_entry(0, 1);
    std::uint32_t tag = all_.tag;
    StepClock clock = all_.start;
    for (bool first = true;; first = false) {
      const TileReport report = exchange(told, ++tag, first);
      if (end_step(all_.end, report, clock)) {
        *all_.clock = clock;
        break;
      }
      for (const TileStep& tile : tiles_) tile.move(clock.now, 0, 1);
      clock.open = step_open;
      const StepTime now = moved(clock.now);
      for (std::size_t t = 0; t < tiles_.size(); ++t) {
        pair_forces(tiles_[t], now.last_dt);
        told[t] = sums(tiles_[t], tag + 1, now.last_dt);
      }
      evaluated_ = true;
    }
    for (const TileStep& tile : tiles_) {
      tile.leave(0, 1);
      if (evaluated_) tile.leave_actions(0, 1);
    }
  }

 private:
  struct alignas(64) Line {
    std::byte bytes[64];
  };
  static void pair_forces(const TileStep& tile, double dt) {
    tile.count_from(0);
    for (Index at = 0; at < tile.portions(); ++at)
      for (Index lane = 0; lane < TileStep::portion; ++lane) tile.pair_force(dt, at, lane);
  }
  /// The sums of one element, by lanes that meet.
  struct Sums {
    const TileStep* tile;
    std::uint32_t tag;
    Index element;
  };
  static TileReport sums(const TileStep& tile, std::uint32_t tag, double dt) {
    Sums sums{&tile, tag, 0};
    for (; sums.element < tile.tile.own; ++sums.element)
      lockstep::run(
          TileStep::width,
          [](void* context, int lane) {
            const auto* const of = static_cast<Sums*>(context);
            of->tile->sum(of->element * TileStep::width + lane, of->tag);
          },
          &sums);
    TileReport report;
    for (Index e = 0; e < tile.tile.own; ++e)
      tile.judge(e, span_after(dt), longest_after(dt), report);
    return report;
  }
  /// Every tile hears the same.
  TileReport exchange(const std::vector<TileReport>& told, std::uint32_t tag, bool first) const {
    const auto count = static_cast<Index>(tiles_.size());
    for (const TileStep& tile : tiles_)
      for (Index to = 0; to < count; ++to)
        put(tile.news_word(tag, tile.number, to), TileStep::packed(told[at(tile.number)]), tag);
    TileReport all;
    for (const TileStep& tile : tiles_) {
      TileReport report;
      for (Index from = 0; from < count; ++from) {
        std::uint64_t bits = 0;
        const bool came = get(tile.news_word(tag, from, tile.number), bits, tag);
        BR_ASSERT(came);
        if (came) TileStep::hear(report, bits);
      }
      for (Index k = 0; !first && k < tile.received(); ++k) {
        std::uint64_t bits = 0;
        [[maybe_unused]] const bool came = get(tile.received_word(k, tag), bits, tag);
        BR_ASSERT(came);
        tile.receive(k, bits);
      }
      all = report;
    }
    return all;
  }

  const TileCase& all_;
  std::vector<Line> memory_;
  std::vector<TileStep> tiles_;  ///< over `memory_`
  bool evaluated_ = false;
};

/// Contacts of tiles whose elements are their ends b.
ContactForces twins_of(const ContactForces& contacts, TilePlan& plan) {
  ContactForces twins = contacts;
  twins.state = plan.twin_state.view();
  twins.slid = plan.twin_slid.view();
  twins.damped = plan.twin_damped.view();
  twins.actions = plan.twin_actions.view();
  return twins;
}

TileCase case_of(World& w, TilePlan& plan, const StopAt& stop) {
  const ContactForces contacts = contact_kernel(w);
  auto interface = link_kernel<double>(w, w.interface, {}, w.steel.size());
  StepClock start;
  const EndOfStep<StepRule> end{step_rule(w), w.given->time.evaluate_every};
  start.to_evaluation = end.to_evaluation(w.step);
  start.now = {w.time, w.last_dt, w.next_dt, w.step};
  start.stop = stop;
  start.least = ordered_bits(largest_least);
  return {link_kernel<double>(w, w.concrete, {}, 0),
          link_kernel<double>(w, w.steel, {}, 0),
          interface,
          contacts,
          twins_of(contacts, plan),
          move_kernel(w),
          w.elements.force.view(),
          w.elements.torque.view(),
          w.critical.view(),
          std::as_const(w.concrete.on_device.laws).view(),
          std::as_const(w.steel.on_device.laws).view(),
          std::as_const(w.interface.on_device.laws).view(),
          end,
          plan.view(),
          plan.forces.data(),
          plan.least.data(),
          plan.tag,
          start,
          w.clock.data()};
}

void launch([[maybe_unused]] const World& w, const TileCase& all, std::size_t bytes) {
#if defined(__CUDACC__)
  if (w.exec.space == Space::cuda) {
    constexpr int threads = 384;
    return launch_resident(launch_tiles<threads>, all.tiles.tiles.size, threads, bytes, all);
  }
#endif
  BR_ASSERT(w.exec.space == Space::shadow);
  TilesInTurn(all, bytes).run();
}

/// Something that a world has and tiles do not know; null: nothing.
const char* unknown_to_tiles(const World& w) {
  if (w.exec.precision != Precision::full) return "mixed precision";
  if (!w.walls.empty()) return "walls";
  if (!w.prescribed.motions.empty()) return "prescribed motions";
  if (w.given->search.every != 0) return "search.every";
  if (w.parallel.size() != 0) return "parallel bonds";
  if (w.ldpm.size() != 0) return "facets of LDPM";
  if (w.concrete.rated) return "strengths that depend on the rate";
  return w.links() > 0 ? nullptr : "no links";
}

/// Multiprocessors that may have a tile, and the memory of each.
Multiprocessors multiprocessors_for(const World& w) {
  if (w.exec.tiles == 0) return {};
  if (w.exec.space != Space::cuda) {
    constexpr Index most = 132;  // as if it were a GPU
    return {w.exec.tiles < 0 ? most : w.exec.tiles, std::size_t{1} << 30};
  }
  const Multiprocessors all = multiprocessors();
  return {w.exec.tiles < 0 ? all.count : std::min(all.count, w.exec.tiles), all.memory};
}

/// Tiles for a world; null where launches are to take its steps.
std::unique_ptr<TilePlan> tiles_for(const World& w) {
  const auto [most, memory] = multiprocessors_for(w);
  constexpr Index least_elements = 8;      // of a tile
  constexpr std::size_t link_bytes = 190;  // about; here for a quick answer
  // With 75 links a tile (the small slab) launches take 4 % less, with 600 (the slab) 15 % more.
  constexpr Index links_that_pay = 300;
  if (most <= 0 || !w.domain.single_rank() || w.exec.space == Space::host) return nullptr;
  const char* reason = unknown_to_tiles(w);
  if (reason == nullptr && at(w.links()) * link_bytes >= at(most) * memory)
    reason = "more links than the memory of its multiprocessors holds";
  if (w.exec.tiles < 0 && w.links() < links_that_pay * most) return nullptr;
  std::unique_ptr<TilePlan> plan;
  if (reason == nullptr) {
    plan = share_out_to_tiles(w, std::clamp(w.elements.size() / least_elements, Index{1}, most));
    if (plan == nullptr) reason = "more in a tile, or more laws, than tiles can number";
  }
  if (plan == nullptr && w.exec.tiles == tiles_in_any_case)
    throw InputError(std::string("device +tiles: the model has ") + reason +
                     "; leave +tiles out, and launches take the steps");
  return plan;
}

/// Whether the last search has left tiles a list that fits them.
bool has_contacts(World& w) {
  TilePlan& plan = *w.tiles.plan;
  if (!w.tiles.contacts_known) {
    tell_contacts(w, plan, multiprocessors_for(w).memory);
    w.tiles.contacts_known = true;
  }
  const Vec3& drift = w.travel.drift.velocity;
  return plan.bytes <= multiprocessors_for(w).memory && !(dot(drift, drift) > 0.0);
}

}  // namespace

bool runs_by_tiles(World& w) {
  if (!w.tiles.known) {
    w.tiles.forget();
    w.tiles.plan = tiles_for(w);
    w.tiles.known = true;
  }
  return w.tiles.plan != nullptr && !LaunchTimes::wanted() && has_contacts(w);
}

Advanced advance_by_tiles(World& w, const StopAt& stop) {
  constexpr std::chrono::milliseconds slice{50};
  constexpr std::int64_t most_steps = 2000;  // of a launch
  const auto begin = std::chrono::steady_clock::now();
  const HostTimes host{w.time, w.last_dt, w.next_dt, w.step};
  const EndOfStep<StepRule> end{step_rule(w), w.given->time.evaluate_every};
  const auto is_over = [&] {
    return w.time >= stop.time || w.step >= stop.step ||
           std::chrono::steady_clock::now() - begin > slice;
  };
  Advanced taken;
  w.clock.resize(2);
  do {
    TilePlan& plan = *w.tiles.plan;
    launch(w, case_of(w, plan, {stop.time, std::min(stop.step, w.step + most_steps)}), plan.bytes);
    const std::int64_t before = w.step;
    const StepClock clock = read_clock(w.clock, end, host, taken);
    plan.tag += static_cast<std::uint32_t>(w.step - before) + 1;
    if (clock.host_request == 0) continue;
    // A search is near: single steps until it has come.
    const std::int64_t searches = w.searches;
    for (int k = 0; k < 4 && w.searches == searches && !is_over(); ++k) {
      take_step_on_device(w);
      taken.dt_min = taken.steps > 0 ? min(taken.dt_min, w.last_dt) : w.last_dt;
      taken.dt_max = max(taken.dt_max, w.last_dt);
      ++taken.steps;
    }
    w.clock.resize(2);
  } while (!is_over() && runs_by_tiles(w));
  return taken;
}

}  // namespace breccia::dem
