// The launches of a step's loops over elements, links and contacts.

#include <algorithm>

#include "dem/launches.hpp"
#include "exec/for_each.hpp"

namespace breccia::dem {
namespace {

template <class Number>
BR_HD void add_to_b(LinkSums& sums, const ActionOf<Number>& action) {
  sums.as_b.add(action.numbers + 3);
  sums.stiffness_b.add(action.stiffness + 3);
}

/// Calls visit(begin, end) for what this rank owns of the elements [begin, end) in some runs.
template <class Visit>
void each_owned(const Domain& domain, const std::vector<ElementRun>& runs, Index begin, Index end,
                const Visit& visit) {
  if (domain.alone()) return visit(begin, end);
  const OwnedView owned = domain.owned_view();
  Domain::each_run_of(runs, begin, end, [&](Index from, Index to) {
    while (from < to) {
      Index last = from;
      while (last < to && owned(last)) ++last;
      if (last > from) visit(from, last);
      from = last + 1;
    }
  });
}

/// Moves elements of this rank. @returns whether one of them has used its margin up
bool move_here(const World& w, const std::vector<ElementRun>& runs, const MoveWithin& move) {
  constexpr Index grain = 512;
  const Index count = w.elements.size();
  std::vector<std::uint8_t> beyond(static_cast<std::size_t>((count + grain - 1) / grain), 0);
  for_each_run(w.exec, count, grain, [&](Index begin, Index end) {
    each_owned(w.domain, runs, begin, end, [&](Index from, Index to) {
      if (run_packs(w.lanes, move, from, to)) beyond[static_cast<std::size_t>(begin / grain)] = 1;
    });
  });
  return std::find(beyond.begin(), beyond.end(), 1) != beyond.end();
}

/// A kernel for all links of a group, on the host.
template <class Law, class Kernel>
void run_group(const World& w, const LinkGroup<Law>& group, const Kernel& kernel) {
  const Index count = group.end - group.begin;
  constexpr Index grain = 512;
  for_each_run(w.exec, count, grain, [&](Index begin, Index end) {
    run_packs(w.lanes, kernel, group.begin + begin, group.begin + end);
  });
}

struct LeastCritical {
  View<const double> critical;
  OwnedView owned;
  BR_HD double operator()(Index e) const { return owned(e) ? critical[e] : largest_least; }
};
/// Of the elements of this rank, on a device.
double least_there(const World& w) {
  if (sums_note_least(w)) {
    std::uint64_t bits = 0;
    peek_marked_bytes(&bits, &w.clock.data()->least, w.exec.space, sizeof bits);
    return number_of(bits);
  }
  return fold(w.exec, w.elements.size(), largest_least,
              LeastCritical{w.critical.view(), w.domain.owned_view()}, Least{});
}
/// The same on the host.
double least_here(const World& w) {
  constexpr Index grain = 4096;
  const Index count = w.elements.size();
  std::vector<double> least_of(static_cast<std::size_t>((count + grain - 1) / grain + 1),
                               largest_least);
  for_each_run(w.exec, count, grain, [&](Index begin, Index end) {
    double& own = least_of[static_cast<std::size_t>(begin / grain)];
    each_owned(w.domain, w.domain.runs, begin, end, [&](Index from, Index to) {
      own = std::min(own, least(w.lanes, w.critical.view(), from, to));
    });
  });
  return *std::min_element(least_of.begin(), least_of.end());
}

/// Sums the actions of links as they come. A force on an element outside this thread's private
/// range is stored in `passed`; its owner thread adds it later, in the order of all links, so that
/// the sum does not depend on the number of threads.
struct AddLinks {
  View<LinkSums> sums;
  Index settled, end;  ///< elements that get sums at once
  Index reach;         ///< no link leads further
  std::vector<PassedAction>& passed;

  /// Links [from, to); action 0 is of link `from`.
  template <class Number>
  void operator()(const ConcreteLinkForces<Number>& links, Index from, Index to,
                  const ActionOf<Number>* actions) const {
    for (Index i = from; i < to;) {
      const Index a = links.a[i];
      SixSums as_a = sums[a].as_a;
      SixFloatSums stiffness_a = sums[a].stiffness_a;
      fetch(std::min(a + reach, sums.size - 1), links.elements.state);
      for (; i < to && links.a[i] == a; ++i) {
        const ActionOf<Number>& action = actions[i - from];
        as_a.add(action.numbers);
        stiffness_a.add(action.stiffness);
        const Index b = links.b[i], soon = links.b[std::min(i + 8, to - 1)];
        __builtin_prefetch(&sums[soon].as_b, 1);
        __builtin_prefetch(&sums[soon].stiffness_b, 1);
        if (b >= settled && b < end)
          add_to_b(sums[b], action);
        else
          passed.push_back({in_double(action), b});
      }
      sums[a].as_a = as_a;
      sums[a].stiffness_a = stiffness_a;
    }
  }
  static const Action& in_double(const Action& action) { return action; }
  static Action in_double(const ActionOf<float>& action) {
    Action same{};
    std::copy_n(action.numbers, 9, same.numbers);
    std::copy_n(action.stiffness, 9, same.stiffness);
    return same;
  }
  /// Asks the memory for an element before the first link comes to it.
  void fetch(Index element, const View<const ElementState>& state) const {
    const auto* sum = reinterpret_cast<const char*>(sums.data + element);
    const auto* record = reinterpret_cast<const char*>(state.data + element);
    for (int line = 0; line < 3; ++line) __builtin_prefetch(sum + 64 * line, 1);
    for (int line = 0; line < 2; ++line) __builtin_prefetch(record + 64 * line);
  }
};

/// Asks the memory for what the links [from, to) keep: too many arrays for the processor to
/// foresee.
template <class Number>
void fetch(const ConcreteLinkForces<Number>& links, Index from, Index to) {
  const View<Number>&shear = links.shear.items, &moment = links.moment.items;
  const Index plane = links.shear.stride;
  for (Index i = from; i < to; i += 8) {
    __builtin_prefetch(links.length.data + i);
    __builtin_prefetch(links.stiffness.data + i);
    if (sizeof(Number) < sizeof(double) && i % 16 != 0) continue;  // of a cache line that is asked
    __builtin_prefetch(links.opening.data + i, 1);
    for (int c = 0; c < 3; ++c) {
      __builtin_prefetch(shear.data + c * plane + i, 1);
      __builtin_prefetch(moment.data + c * plane + i, 1);
    }
  }
}

/// Forces of links [begin, end) and their sums, in portions whose actions stay in the nearest
/// cache.
template <class Number>
void add_links(Lanes lanes, ConcreteLinkForces<Number> links, Index begin, Index end,
               const AddLinks& add) {
  constexpr Index portion = 64;
  alignas(64) ActionOf<Number> actions[portion];
  links.actions.data = actions;
  links.actions.size = portion;
  for (Index from = begin; from < end;) {
    const Index to = std::min(from / portion * portion + portion, end);  // whole packs, aligned
    links.first_action = -from;
    fetch(links, to, std::min(to + portion, end));
    run_packs(lanes, links, from, to);
    add(links, from, to, actions);
    from = to;
  }
}

template <class Number>
void link_forces_and_sums(World& w) {
  std::vector<ConcreteLinkForces<Number>> kernels;
  for (const auto& group : w.concrete_groups) kernels.push_back(concrete_kernel<Number>(w, group));
  const GatherForces gather = gather_kernel(w);
  Sweep& sweep = w.sweep;
  const auto threads = static_cast<int>(sweep.settled.size());
#pragma omp parallel num_threads(threads) if (threads > 1)
  {
    const KernelScope scope;
#pragma omp for schedule(static, 1)
    for (int t = 0; t < threads; ++t) {
      const auto run = static_cast<std::size_t>(t);
      AddLinks add{gather.sums, sweep.settled[run], sweep.begin[run + 1], sweep.reach,
                   sweep.passed[run]};
      add.passed.clear();
      auto tile = std::lower_bound(sweep.tiles.begin(), sweep.tiles.end(), sweep.begin[run]);
      for (; *tile < sweep.begin[run + 1]; ++tile) {
        const Index from = *tile, to = *(tile + 1);
        for (std::size_t g = 0; g < kernels.size(); ++g) {
          const std::vector<Index>& starts = w.concrete_groups[g].starts;
          add_links(w.lanes, kernels[g], starts[static_cast<std::size_t>(from)],
                    starts[static_cast<std::size_t>(to)], add);
        }
        run_packs(w.lanes, gather, std::max(from, sweep.settled[run]), to);
      }
    }
    // The end of the loop above is a barrier: every link is done.
#pragma omp for schedule(static, 1)
    for (int t = 0; t < threads; ++t) {
      const auto run = static_cast<std::size_t>(t);
      const Index begin = sweep.begin[run];
      const Index end = std::min(sweep.settled[run], sweep.begin[run + 1]);
      if (begin == end) continue;
      for (std::size_t before = 0; before <= run; ++before)
        for (const PassedAction& p : sweep.passed[before])
          if (p.b >= begin && p.b < end) add_to_b(gather.sums[p.b], p.action);
      run_packs(w.lanes, gather, begin, end);
    }
  }
}

}  // namespace

ElementsView elements_view(const World& w) {
  return {w.elements.state.view(), w.elements.mass.view(), w.elements.inertia.view()};
}

Kick kick(const World& w) {
  return {w.time,
          w.last_dt,
          w.next_dt,
          w.parameters.gravity,
          w.parameters.local_damping,
          w.motions.view(),
          w.elements.mass.view(),
          w.elements.inertia.view(),
          w.elements.state.view(),
          w.elements.force.view(),
          w.elements.torque.view(),
          w.elements.fixed.view(),
          w.elements.motion.view()};
}

StepRule step_rule(const World& w) {
  return {w.parameters.time.safety, w.parameters.time.max_step, w.parameters.contact_step};
}

View<const Wall> walls_view(const World& w) {
  if (w.exec.space != Space::host) return w.device_walls.view();
  View<const Wall> view;
  view.data = w.walls.data();
  view.size = static_cast<Index>(w.walls.size());
  return view;
}

namespace {

MoveWithin move_within(World& w) {
  return {move_kernel(w),
          {w.elements.state.view(), w.travel.reference.view(), w.travel.margin.view()}};
}

}  // namespace

void move_awaited(World& w) {
  const StageTime timed(w.exec, "integration");
  if (w.exec.space != Space::host)
    move_on_device(w);
  else
    w.margin_used = move_here(w, w.domain.awaited_runs, move_within(w));
}

void move_others(World& w) {
  const StageTime timed(w.exec, "integration");
  if (w.exec.space == Space::host && !w.domain.alone())
    w.margin_used |= move_here(w, w.domain.other_runs, move_within(w));
  for (Wall& wall : w.walls) {
    wall.point += w.next_dt * wall.velocity;
    wall.travelled += w.next_dt * norm(wall.velocity);
  }
  w.time += w.next_dt;
  w.last_dt = w.next_dt;
}

void bar_forces(World& w) {
  const StageTime timed(w.exec, "bar_forces");
  for (const auto& group : w.steel_groups) run_group(w, group, steel_kernel(w, group));
  for (const auto& group : w.interface_groups) run_group(w, group, interface_kernel(w, group));
}

void contact_forces(World& w) {
  const StageTime timed(w.exec, "contact_forces");
  for_each(w.exec, w.contacts.size(), contact_kernel(w));
}

void concrete_forces_and_sums(World& w) {
  const StageTime timed(w.exec, "link_forces");
  with_number(w.exec.precision, [&w](auto number) { link_forces_and_sums<decltype(number)>(w); });
}

void wall_forces(World& w) {
  if (w.wall_contacts.size() == 0) return;
  const StageTime timed(w.exec, "wall_forces");
  if (w.exec.space != Space::host) copy_to(w.device_walls, w.walls);
  for (std::size_t k = 0; k < w.walls.size(); ++k)
    for_each(w.exec, w.wall_begin[k + 1] - w.wall_begin[k], wall_kernel(w, static_cast<Index>(k)));
}

double choose_time_step(const World& w) {
  const StageTime timed(w.exec, "time_step");
  const double least = w.exec.space != Space::host ? least_there(w) : least_here(w);
  return step_rule(w)(w.domain.least(least), w.last_dt);
}

}  // namespace breccia::dem
