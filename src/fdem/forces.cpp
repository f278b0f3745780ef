// The launches of a step's loops over triangles, joints and couples.

#include <algorithm>
#include <cmath>

#include "exec/for_each.hpp"
#include "fdem/kernel_lanes.hpp"
#include "fdem/world.hpp"

namespace breccia::fdem {
namespace {

/// A kernel over all its items: on the host in packs as wide as the processor's, shared by the
/// threads in runs that packs fill.
template <class Kernel>
void run(const World& w, Index count, const Kernel& kernel) {
  if (w.exec.space == Space::cuda || w.lanes == Lanes::one) return for_each(w.exec, count, kernel);
  constexpr Index grain = 512;
  for_each_run(w.exec, count, grain,
               [&](Index begin, Index end) { run_packs(w.lanes, kernel, begin, end); });
}

}  // namespace

double Amplitude::at(double time) const {
  const double grown = ramp > 0.0 ? std::clamp(time / ramp, 0.0, 1.0) : 1.0;
  if (times.empty()) return grown;
  const auto next = std::upper_bound(times.begin(), times.end(), time);
  if (next == times.begin()) return grown * factors.front();
  if (next == times.end()) return grown * factors.back();
  const auto i = static_cast<std::size_t>(next - times.begin());
  const double share = (time - times[i - 1]) / (times[i] - times[i - 1]);
  return grown * (factors[i - 1] + share * (factors[i] - factors[i - 1]));
}

Kick kick(const World& w) {
  const Triangles& t = w.triangles;
  return {w.last_dt,      w.next_dt,        w.parameters.gravity, w.parameters.local_damping,
          w.holds.view(), w.motions.view(), t.mass.view(),        t.nodes.view(),
          t.force.view(), t.hold.view()};
}

StableStep stable_step(const World& w) {
  const Triangles& t = w.triangles;
  return {t.nodes.view(), t.material.view(),      w.laws.view(),          t.viscosity.view(),
          t.mass.view(),  w.contact_pairs.view(), w.parameters.materials, w.edges.view(),
          w.bonds.view(), w.joints.law.view(),    w.joints.stage.view(),  t.hold.view(),
          w.holds.view()};
}

void move_triangles(World& w) {
  const StageTime timed(w.exec, "integration");
  if (!w.prescribed.empty()) {
    std::vector<Motion> now;
    const double middle = w.time + 0.5 * w.next_dt;
    for (const PrescribedMotion& p : w.prescribed)
      now.push_back({p.amplitude.at(middle) * p.velocity});
    copy_to(w.motions, now);
  }
  Triangles& t = w.triangles;
  run(w, t.size(),
      MoveTriangles{kick(w), std::as_const(t.external).view(), t.nodes.view(),
                    t.damping_work.view(), t.load_work.view()});
  w.time += w.next_dt;
  w.last_dt = w.next_dt;
}

void joint_forces(World& w) {
  const StageTime timed(w.exec, "joint_forces");
  Joints& j = w.joints;
  run(w, j.size(),
      JointForces{w.time, w.last_dt, by_number(std::as_const(w.triangles.nodes).view()),
                  w.bonds.view(), w.joint_ends.view(), j.law.view(), j.length.view(),
                  j.strength.view(), j.preset.view(), j.stage.view(), j.points.view(),
                  j.force.view(), j.work.view(), j.broke_at.view(), j.pressing.view(),
                  w.opened.changed.view()});
}

void couple_forces(World& w) {
  const StageTime timed(w.exec, "contact_forces");
  Couples& c = w.couples;
  for_each(
      w.exec, c.size(),
      CoupleForces{w.last_dt, w.parameters.conservative, std::as_const(w.triangles.nodes).view(),
                   w.triangles.material.view(), w.contact_pairs.view(), w.parameters.materials,
                   c.pairs.a.view(), c.pairs.b.view(), std::as_const(w.born).view(),
                   c.history.state.view(), c.history.force.view()});
}

void triangle_forces(World& w) {
  const StageTime timed(w.exec, "triangle_forces");
  Triangles& t = w.triangles;
  run(w, t.size(),
      TriangleForces{w.last_dt, std::as_const(t.nodes).view(), t.material.view(), w.laws.view(),
                     t.shape_inverse.view(), t.viscosity.view(), w.edges.view(),
                     std::as_const(w.joints.force).view(), w.couple_incidence.view(),
                     std::as_const(w.couples.history.force).view(), t.force.view(),
                     t.viscous_work.view()});
}

void load_forces(World& w) {
  Triangles& t = w.triangles;
  if (w.load_starts.size() > 1) {
    const StageTime timed(w.exec, "load_forces");
    std::vector<LoadLaw> now = w.loads;
    for (std::size_t i = 0; i < now.size(); ++i) now[i].factor = w.load_amplitudes[i].at(w.time);
    copy_to(w.load_laws, now);
    for_each(w.exec, w.load_starts.size() - 1,
             LoadForces{w.load_starts.view(), w.loaded_edges.view(), w.load_laws.view(),
                        std::as_const(t.nodes).view(), t.external.view(), t.force.view()});
  }
  if (w.bundles.starts.size() < 2) return;
  const StageTime timed(w.exec, "bundles");
  for_each(w.exec, w.bundles.starts.size() - 1,
           BundleForces{w.bundles.starts.view(), w.bundles.nodes.view(), w.bundles.leader.view(),
                        t.mass.view(), t.force.view()});
}

namespace {

/// The stable step of the triangles that can touch: those where a joint may just have broken.
struct StableStepOf {
  StableStep stable;
  View<const Index> triangle;
  BR_HD double operator()(Index i) const { return stable(triangle[i]); }
};

double allowed_step(const World& w, double stable) {
  return rounded_down(std::min(w.parameters.time.safety * stable, w.parameters.time.max_step));
}

}  // namespace

double choose_time_step(const World& w) {
  const StageTime timed(w.exec, "time_step");
  return allowed_step(w, fold(w.exec, w.triangles.size(), 1e300, stable_step(w), Least{}));
}

double shortened_time_step(const World& w, const Buffer<Index>& triangles) {
  const StageTime timed(w.exec, "time_step");
  const double stable = fold(w.exec, triangles.size(), 1e300,
                             StableStepOf{stable_step(w), triangles.view()}, Least{});
  return std::min(w.next_dt, allowed_step(w, stable));
}

}  // namespace breccia::fdem
