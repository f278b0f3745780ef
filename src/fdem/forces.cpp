// The launches of a step's loops over triangles, joints and couples.

#include <algorithm>
#include <cmath>

#include "exec/for_each.hpp"
#include "fdem/kernel_lanes.hpp"
#include "fdem/launches.hpp"

namespace breccia::fdem {
namespace {

/// A kernel over all its items: on the host in packs as wide as the processor's, shared by the
/// threads in runs that packs fill.
template <class Kernel>
void run(const World& w, Index count, const Kernel& kernel) {
  if (w.exec.space != Space::host || w.lanes == Lanes::one) return for_each(w.exec, count, kernel);
  constexpr Index grain = 512;
  for_each_run(w.exec, count, grain,
               [&](Index begin, Index end) { run_packs(w.lanes, kernel, begin, end); });
}

bool takes_all(const World& w) {
  return w.domain.alone() || w.exec.space != Space::host || w.lanes == Lanes::one;
}

/// The same over some of the triangles.
template <class Kernel>
void run_of(const World& w, const std::vector<ElementRun>& runs, const Kernel& kernel) {
  constexpr Index grain = 512;
  for_each_run(w.exec, w.triangles.size(), grain, [&](Index begin, Index end) {
    Domain::each_run_of(runs, begin, end,
                        [&](Index from, Index to) { run_packs(w.lanes, kernel, from, to); });
  });
}

/// The same over the triangles that this rank owns.
template <class Kernel>
void run_own(const World& w, const Kernel& kernel) {
  if (takes_all(w)) return run(w, w.triangles.size(), kernel);
  run_of(w, w.domain.runs, kernel);
}

}  // namespace

double Amplitude::at(double time) const {
  View<const double> seen_times, seen_factors;
  seen_times.data = times.data();
  seen_factors.data = factors.data();
  seen_times.size = seen_factors.size = static_cast<Index>(times.size());
  return AmplitudeTable{ramp, 0, seen_times.size}.at(time, seen_times, seen_factors);
}

double Amplitude::largest() const {
  double most = factors.empty() ? 1.0 : 0.0;
  for (const double f : factors) most = std::max(most, std::abs(f));
  return most;
}

Kick kick(const World& w) {
  const Triangles& t = w.triangles;
  return {w.last_dt,      w.next_dt,        w.parameters.gravity, w.parameters.local_damping,
          w.holds.view(), w.motions.view(), t.mass.view(),        t.nodes.view(),
          t.force.view(), t.hold.view()};
}

StableStep stable_step(const World& w) {
  const Triangles& t = w.triangles;
  const Pairs& pairs = w.couples.pairs;
  return {t.nodes.view(),
          t.material.view(),
          w.laws.view(),
          t.viscosity.view(),
          t.mass.view(),
          w.contact_pairs.view(),
          w.parameters.materials,
          w.edges.view(),
          w.bonds.view(),
          w.joints.law.view(),
          w.joints.stage.view(),
          t.hold.view(),
          w.holds.view(),
          w.dashpots.view(),
          {t.nodes.view(), t.shape_inverse.view(), w.couple_incidence.view(), pairs.a.view(),
           pairs.b.view(), w.joints.edge_a.view(), w.joints.edge_b.view()},
          w.parameters.time.evaluate_every};
}

void list_motions(World& w) {
  if (w.prescribed.empty()) return;
  std::vector<Motion> now;
  const double middle = w.time + 0.5 * w.next_dt;
  for (const PrescribedMotion& p : w.prescribed)
    now.push_back({p.amplitude.at(middle) * p.velocity});
  copy_to(w.motions, now);
}

void move_awaited(World& w) {
  const StageTime timed(w.exec, "integration");
  list_motions(w);
  if (w.exec.space != Space::host)
    move_on_device(w);
  else if (takes_all(w))
    run(w, w.triangles.size(), move_kernel(w));
  else
    run_of(w, w.domain.awaited_runs, move_kernel(w));
}

void move_others(World& w) {
  const StageTime timed(w.exec, "integration");
  if (!takes_all(w)) run_of(w, w.domain.other_runs, move_kernel(w));
  w.time += w.next_dt;
  w.last_dt = w.next_dt;
}

namespace {

/// Calls visit(begin, end) for runs of joints whose packs take(pack) chooses.
template <class Take, class Visit>
void each_run_of_packs(const World& w, const Take& take, const Visit& visit) {
  constexpr Index grain = 64 * joint_pack;
  for_each_run(w.exec, w.joints.size(), grain, [&](Index begin, Index end) {
    const auto taken = [&](Index i) {
      return take(w.joint_packs[static_cast<std::size_t>(i / joint_pack)]);
    };
    for (Index from = begin; from < end; from += joint_pack) {
      if (!taken(from)) continue;
      Index to = from;
      while (to < end && taken(to)) to += joint_pack;
      visit(from, std::min(to, end));
      from = to;
    }
  });
}

}  // namespace

void inner_joint_forces(World& w) {
  if (w.joint_packs.empty()) return;
  const StageTime timed(w.exec, "joint_forces");
  with_number(w.exec.precision, [&w](auto number) {
    const auto kernel = joint_kernel<decltype(number)>(w);
    each_run_of_packs(
        w, [](JointPack pack) { return pack == JointPack::inner; },
        [&](Index begin, Index end) {
          while (begin < end) {
            const Index stop = run_whole(w.lanes, kernel, begin, end);
            for (; begin < stop && (begin + joint_pack <= stop || stop == end); begin += joint_pack)
              w.joint_packs[static_cast<std::size_t>(begin / joint_pack)] = JointPack::done;
            if (stop < end) begin += joint_pack;  // the pack where it stopped: in its turn
          }
        });
  });
}

void joint_forces(World& w) {
  const StageTime timed(w.exec, "joint_forces");
  with_number(w.exec.precision, [&w](auto number) {
    const auto kernel = joint_kernel<decltype(number)>(w);
    if (w.joint_packs.empty()) return run(w, w.joints.size(), kernel);
    each_run_of_packs(
        w, [](JointPack pack) { return pack != JointPack::done; },
        [&](Index begin, Index end) { run_packs(w.lanes, kernel, begin, end); });
  });
  std::replace(w.joint_packs.begin(), w.joint_packs.end(), JointPack::done, JointPack::inner);
}

void couple_forces(World& w) {
  const StageTime timed(w.exec, "contact_forces");
  with_number(w.exec.precision, [&](auto number) {
    for_each(w.exec, w.couples.size(), couple_kernel<decltype(number)>(w));
  });
}

void triangle_forces(World& w) {
  const StageTime timed(w.exec, "triangle_forces");
  with_number(w.exec.precision,
              [&](auto number) { run_own(w, triangle_kernel<decltype(number)>(w)); });
}

void load_forces(World& w) {
  if (w.load_starts.size() > 1) {
    const StageTime timed(w.exec, "load_forces");
    std::vector<LoadLaw> now = w.loads;
    for (std::size_t i = 0; i < now.size(); ++i) now[i].factor = w.load_amplitudes[i].at(w.time);
    copy_to(w.load_laws, now);
    for_each(w.exec, w.load_starts.size() - 1, load_kernel(w));
  }
  if (w.mesh.bundled && !w.domain.alone()) {  // also on ranks that have none
    const StageTime timed(w.exec, "halo");
    w.tied_forces.refresh(w.exec, *w.domain.ranks, w.triangles.force);
  }
  if (w.bundles.starts.size() < 2) return;
  const StageTime timed(w.exec, "bundles");
  for_each(w.exec, w.bundles.starts.size() - 1, bundle_kernel(w));
}

namespace {

struct OwnedStableStep {
  StableStep stable;
  OwnedView owned;
  BR_HD double operator()(Index t) const { return owned(t) ? stable(t) : largest_least; }
};

/// The stable step of the triangles that can touch: those where a joint may just have broken.
struct StableStepOf {
  OwnedStableStep stable;
  View<const Index> triangle;
  BR_HD double operator()(Index i) const { return stable(triangle[i]); }
};

}  // namespace

AllowedStep allowed_step(const World& w) {
  return {w.parameters.time.safety, w.parameters.time.max_step};
}

double choose_time_step(const World& w) {
  const StageTime timed(w.exec, "time_step");
  const OwnedStableStep stable{stable_step(w), w.domain.owned_view()};
  const double least =
      w.domain.least(fold(w.exec, w.triangles.size(), largest_least, stable, Least{}));
  return allowed_step(w)(least, w.last_dt);
}

double shortened_time_step(const World& w, const Buffer<Index>& triangles) {
  const StageTime timed(w.exec, "time_step");
  const double stable = w.domain.least(
      fold(w.exec, triangles.size(), largest_least,
           StableStepOf{{stable_step(w), w.domain.owned_view()}, triangles.view()}, Least{}));
  return std::min(w.next_dt, allowed_step(w)(stable, w.last_dt));
}

}  // namespace breccia::fdem
