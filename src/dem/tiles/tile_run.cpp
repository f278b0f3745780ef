// A launch of tiles, one a multiprocessor; in Space::shadow the processor takes tile after tile,
// phase by phase.

#include "dem/tiles/tile_run.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "core/device_run.hpp"
#include "dem/stepping/step.hpp"
#include "dem/tiles/tile_search.hpp"
#include "exec/error.hpp"
#include "exec/multiprocessors.hpp"

namespace breccia::dem {
namespace {

/// Ends the step that a clock holds open, if there is one, by what all tiles have told.
/// @returns whether tiles leave
BR_HD bool end_step(const EndOfStep<StepRule>& end, const TileReport& report, StepClock& clock) {
  if (clock.open != 0) clock.least = ordered_bits(min(largest_least, critical_of(report.slowest)));
  end(clock);
  return clock.halted != 0;
}

/// Models with rates have no tiles.
constexpr ConcreteParts concrete_with_tiles = concrete_all & ~concrete_rated;
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
/// Findings of several warps together.
template <int warps>
__device__ TileReport news_of(const TileReport* of_warp) {
  TileReport report = of_warp[0];
  for (int warp = 1; warp < warps; ++warp) {
    report.slowest = fmax(report.slowest, of_warp[warp].slowest);
    report.near = report.near || of_warp[warp].near;
  }
  return report;
}
/// Tells what a thread has found in a step, for the report of its tile.
__device__ void tell(TileReport report, TileReport* told, Index thread) {
  report = report_of_warp(report);
  if (thread % 32 == 0) told[thread / 32] = report;
}

/// Loads of others' elements, by `threads` threads: several words are asked for before the first
/// has come.
template <int threads, class Number>
__device__ void receive(const TileStep<Number>& tile, std::uint32_t tag, Index thread) {
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
template <int threads, ConcreteParts parts, class Number>
__device__ void pair_forces(const TileStep<Number>& tile, const StepTime& now, Index thread) {
  constexpr Index portion = TileStep<Number>::portion;
  const Index lane = thread % portion, portions = tile.portions();
  Index number = thread / portion;
  while (number < portions) {
    tile.template pair_force<parts>(now, number, lane);
    __syncwarp();
    if (lane == 0) number = tile.take_number(tile.memory.counters);
    number = __shfl_sync(~0U, number, 0);
  }
}

/// @tparam evaluates  whether stiffnesses are added up, too
template <int threads, bool evaluates, class Number>
__device__ void sums(const TileStep<Number>& tile, std::uint32_t tag, double dt, Index thread,
                     TileReport& report) {
  for (Index i = thread; i < tile.sum_items(); i += threads)
    tile.template sum<evaluates>(i, tag, span_after(dt), longest_after(dt), report);
}

/// Tells all tiles by `threads` threads what this one has found, and hears of all.
/// @returns what this thread's warp has heard
template <int threads, class Number>
__device__ TileReport exchange(const TileStep<Number>& tile, const TileReport& found,
                               std::uint32_t tag, Index thread) {
  const Index tiles = tile.all.tiles.count;
  const std::uint64_t own = packed(found);
  for (Index to = thread; to < tiles; to += threads)
    put(tile.news_word(tag, tile.number, to), own, tag);
  TileReport report;
  for (Index from = thread; from < tiles; from += threads) {
    std::uint64_t bits = 0;
    while (!get(tile.news_word(tag, from, tile.number), bits, tag)) {
    }
    hear(report, bits);
  }
  return report_of_warp(report);
}

/// Waits until all tiles are here, and sees what they have written. @returns whether `flag` is true
/// for any thread of any
template <class Number>
__device__ bool meet(const TileCase<Number>& all, Index number, std::uint32_t tag, bool flag) {
  __threadfence();
  const bool here = __syncthreads_or(flag ? 1 : 0) != 0;
  const auto thread = static_cast<Index>(threadIdx.x), threads = static_cast<Index>(blockDim.x);
  for (Index to = thread; to < all.tiles.count; to += threads)
    put(TileStep<Number>::news_word(all, tag, number, to), here ? 1 : 0, tag);
  bool any = false;
  for (Index from = thread; from < all.tiles.count; from += threads) {
    std::uint64_t bits = 0;
    while (!get(TileStep<Number>::news_word(all, tag, from, number), bits, tag)) {
    }
    any = any || bits != 0;
  }
  __threadfence();
  return __syncthreads_or(any ? 1 : 0) != 0;
}

/// How a search in the middle of a step has ended.
struct SearchEnd {
  std::uint32_t tag;
  bool found;  ///< otherwise the host searches in its place
};
/// A function of its own: what few steps need costs the others no registers.
template <class Number>
__device__ __noinline__ SearchEnd search(const TileCase<Number>* all, Index number,
                                         std::byte* memory, std::uint32_t tag, double next_dt,
                                         Index searches) {
  stay_in_place(all);
  const auto thread = static_cast<Index>(threadIdx.x), threads = static_cast<Index>(blockDim.x);
  const TileLists lists = all->lists(searches);
  const Index contacts = searches == 0 ? all->search.contacts : all->news->contacts;
  if (searches == 0 && number == 0 && thread == 0) all->news->dropped = 0;
  {
    const TileStep<Number> step(*all, number, memory);
    const bool lost = TileSearch<Number>::publish(step, next_dt, contacts, thread, threads);
    if (meet(*all, number, ++tag, lost)) return {tag, false};
  }
  const TileSearch<Number> tile(*all, lists, number, memory);
  if (meet(*all, number, ++tag, tile.find(thread, threads))) return {tag, false};
  if (tile.number_all(contacts, all->news->dropped, thread, threads)) return {tag, false};
  meet(*all, number, ++tag, false);
  tile.name(contacts, thread, threads);
  __syncthreads();
  return {tag, true};
}

template <int threads, class Number, ConcreteParts parts>
__global__ void __launch_bounds__(threads, 1)
    launch_tiles(const __grid_constant__ TileCase<Number> all) {
  constexpr Index first_number = threads / TileStep<Number>::portion;
  extern __shared__ __align__(16) std::byte memory[];
  constexpr int hearers = 160;  // the others receive loads meanwhile
  __shared__ TileReport told[threads / 32], heard[hearers / 32];
  const auto thread = static_cast<Index>(threadIdx.x), number = static_cast<Index>(blockIdx.x);
  std::uint32_t tag = all.tag;
  int current = 0;
  Index searches = 0;
  bool first = true, goes_on = true;
  while (goes_on) {
    const TileLists lists = all.lists(searches);
    if (thread == 0) TileStep<Number>::lay_out(all, lists, number, memory);
    __syncthreads();
    const TileStep<Number> tile(all, number, memory);
    tile.enter(lists, thread, threads);
    if (first && thread == 0) tile.memory.clocks[0] = all.start;
    bool moved = !first;  // by a step that is in its middle
    if (moved)
      meet(all, number, ++tag, false);
    else
      __syncthreads();
    for (;;) {
      if (!moved) {
        // Tiles tell each other what they have found, and hear of all.
        ++tag;
        if (first) {
          TileReport report;
          report.near = tile.near_at_entry(thread, threads);
          tell(report, told, thread);
          __syncthreads();
        }
        if (thread < hearers) {
          const TileReport report =
              exchange<hearers>(tile, news_of<threads / 32>(told), tag, thread);
          if (thread % 32 == 0) heard[thread / 32] = report;
        } else if (!first) {
          receive<threads - hearers>(tile, tag, thread - hearers);
        }
        first = false;
        __syncthreads();
        const TileReport news = news_of<hearers / 32>(heard);
        StepClock clock = tile.memory.clocks[current];
        if (end_step(all.end, news, clock)) {
          tile.leave(thread, threads);
          if (tile.memory.clocks[current].open != 0) tile.leave_actions(thread, threads);
          if (number == 0 && thread == 0) all.news->clock = clock;
          goes_on = false;
          break;
        }
        if (thread == threads - 1) {  // it has fewest elements to move
          clock.open = step_open;
          tile.memory.clocks[1 - current] = clock;
          tile.count_from(first_number);
        }
        current = 1 - current;
        tile.move(clock.now, thread, threads);
        __syncthreads();
        const StepClock& moves = tile.memory.clocks[current];
        if (news.near && meet(all, number, ++tag, tile.used_margin(moves.now, thread, threads))) {
          const StepClock kept = moves;  // a search takes its memory
          const SearchEnd end = search(&all, number, memory, tag, kept.now.next_dt, searches);
          tag = end.tag;
          if (end.found) {
            ++searches;
          } else {
            if (number == 0 && thread == 0) {
              all.news->clock = kept;
              all.news->clock.host_request = 1;
            }
            goes_on = false;
          }
          break;
        }
      } else if (thread == 0) {
        tile.count_from(first_number);
      }
      if (moved) __syncthreads();
      moved = false;
      pair_forces<threads, parts>(tile, tile.memory.clocks[current].after_move(), thread);
      __syncthreads();
      const double dt = tile.memory.clocks[current].now.next_dt;
      TileReport report;
      if (tile.memory.clocks[current].to_evaluation == 0)
        sums<threads, true>(tile, tag + 1, dt, thread, report);
      else
        sums<threads, false>(tile, tag + 1, dt, thread, report);
      tell(report, told, thread);
      __syncthreads();
    }
  }
  if (number == 0 && thread == 0) {
    all.news->tag = tag;
    all.news->searches = searches;
  }
}

#endif

/// All tiles on this processor.
template <class Number>
class TilesInTurn {
  using Step = TileStep<Number>;
  using Search = TileSearch<Number>;

 public:
  explicit TilesInTurn(const TileCase<Number>& all) : all_(all), tag_(all.tag) {
    const std::size_t count = at(all.tiles.count);
    lines_ = all.search.bytes / sizeof(Line) + 1;
    memory_.assign(count * lines_, Line{});
    bring_tiles();
  }

  void run() {
    const KernelScope scope;
    std::vector<TileReport> told(tiles_.size());
    for (std::size_t t = 0; t < tiles_.size(); ++t) told[t].near = tiles_[t].near_at_entry(0, 1);
    StepClock clock = all_.start;
    for (bool first = true;; first = false) {
      const TileReport report = exchange(told, ++tag_, first);
      if (end_step(all_.end, report, clock)) break;
      for (const Step& tile : tiles_) tile.move(clock.now, 0, 1);
      clock.open = step_open;
      if (report.near && !search_if_due(clock.now)) {
        clock.host_request = 1;
        break;
      }
      const StepTime now = clock.after_move();
      for (std::size_t t = 0; t < tiles_.size(); ++t) {
        pair_forces(tiles_[t], now);
        told[t] = sums(tiles_[t], tag_ + 1, now);
      }
      evaluated_ = true;
    }
    TileNews& news = *all_.news;
    news.clock = clock;
    news.tag = tag_;
    news.searches = searches_;
    if (clock.host_request != 0) return;
    for (const Step& tile : tiles_) {
      tile.leave(0, 1);
      if (evaluated_) tile.leave_actions(0, 1);
    }
  }

 private:
  struct alignas(64) Line {
    std::byte bytes[64];
  };
  std::byte* memory_of(Index tile) { return memory_[at(tile) * lines_].bytes; }
  void bring_tiles() {
    tiles_.clear();
    for (Index t = 0; t < all_.tiles.count; ++t) {
      Step::lay_out(all_, all_.lists(searches_), t, memory_of(t));
      tiles_.emplace_back(all_, t, memory_of(t));
    }
    const KernelScope scope;
    for (const Step& tile : tiles_) tile.enter(all_.lists(searches_), 0, 1);
  }
  /// @returns whether steps go on
  bool search_if_due(const StepTime& now) {
    bool due = false;
    for (const Step& tile : tiles_) due = tile.used_margin(now, 0, 1) || due;
    ++tag_;
    if (!due) return true;
    const TileLists lists = all_.lists(searches_);
    const Index contacts = searches_ == 0 ? all_.search.contacts : all_.news->contacts;
    if (searches_ == 0) all_.news->dropped = 0;
    bool lost = false;
    for (const Step& tile : tiles_)
      lost = Search::publish(tile, now.next_dt, contacts, 0, 1) || lost;
    if (lost) return false;
    std::vector<Search> all;
    for (Index t = 0; t < all_.tiles.count; ++t) all.emplace_back(all_, lists, t, memory_of(t));
    for (const Search& one : all) lost = one.find(0, 1) || lost;
    if (lost) return false;
    for (const Search& one : all) lost = one.number_all(contacts, all_.news->dropped, 0, 1) || lost;
    if (lost) return false;
    for (const Search& one : all) one.name(contacts, 0, 1);
    ++searches_;
    bring_tiles();
    return true;
  }
  static void pair_forces(const Step& tile, const StepTime& now) {
    tile.count_from(0);
    for (Index at = 0; at < tile.portions(); ++at)
      for (Index lane = 0; lane < Step::portion; ++lane)
        tile.template pair_force<concrete_with_tiles>(now, at, lane);
  }
  /// The sums of a few elements, by lanes that meet.
  struct Sums {
    const Step* tile;
    std::uint32_t tag;
    StepTime now;
    Index first;
    TileReport report;

    void add(int lane) {
      const float span = span_after(now.last_dt), longest = longest_after(now.last_dt);
      if (now.evaluates)
        tile->template sum<true>(first + lane, tag, span, longest, report);
      else
        tile->template sum<false>(first + lane, tag, span, longest, report);
    }
  };
  static TileReport sums(const Step& tile, std::uint32_t tag, const StepTime& now) {
    Sums sums{&tile, tag, now, 0, {}};
    for (; sums.first < tile.sum_items(); sums.first += lockstep::lanes)
      lockstep::run([](void* context, int lane) { static_cast<Sums*>(context)->add(lane); }, &sums);
    return sums.report;
  }
  /// Every tile hears the same.
  TileReport exchange(const std::vector<TileReport>& told, std::uint32_t tag, bool first) const {
    const auto count = static_cast<Index>(tiles_.size());
    for (const Step& tile : tiles_)
      for (Index to = 0; to < count; ++to)
        put(tile.news_word(tag, tile.number, to), packed(told[at(tile.number)]), tag);
    TileReport all;
    for (const Step& tile : tiles_) {
      TileReport report;
      for (Index from = 0; from < count; ++from) {
        std::uint64_t bits = 0;
        const bool came = get(tile.news_word(tag, from, tile.number), bits, tag);
        BR_ASSERT(came);
        if (came) hear(report, bits);
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

  const TileCase<Number>& all_;
  std::uint32_t tag_;
  std::size_t lines_;  ///< of each tile
  std::vector<Line> memory_;
  std::vector<Step> tiles_;  ///< over `memory_`
  Index searches_ = 0;
  bool evaluated_ = false;
};

template <class Number>
void launch([[maybe_unused]] const World& w, const TileCase<Number>& all) {
#if defined(__CUDACC__)
  if (w.exec.space == Space::cuda) {
    constexpr int threads = 512;
    const auto go = [&](auto kernel) {
      launch_resident(kernel, all.tiles.count, threads, all.search.bytes, all);
    };
    if ((all.concrete_parts & ~concrete_bounded) == 0)
      return go(launch_tiles<threads, Number, concrete_bounded>);
    if ((all.concrete_parts & concrete_damps) == 0)
      return go(launch_tiles<threads, Number, concrete_with_tiles & ~concrete_damps>);
    return go(launch_tiles<threads, Number, concrete_with_tiles>);
  }
#endif
  BR_ASSERT(w.exec.space == Space::shadow);
  TilesInTurn<Number>(all).run();
}

}  // namespace

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
  do {
    TilePlan& plan = *w.tiles.plan;
    const StopAt until{stop.time, std::min(stop.step, w.step + most_steps)};
    with_arithmetic(w.exec.precision,
                    [&](auto number) { launch(w, case_of<decltype(number)>(w, plan, until)); });
    const TileNews news = take_over(w, plan);
    count_steps(news.clock, end, host, taken);
    if (news.clock.host_request == 0) continue;
    // The host searches in the middle of a step.
    find_contacts(w);
    take_forces_on_device(w);
    w.step += 1;
    taken.dt_min = taken.steps > 0 ? min(taken.dt_min, w.last_dt) : w.last_dt;
    taken.dt_max = max(taken.dt_max, w.last_dt);
    ++taken.steps;
  } while (!is_over() && runs_by_tiles(w));
  return taken;
}

}  // namespace breccia::dem
