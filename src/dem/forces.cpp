// The launches of a step's loops over elements, links and contacts.

#include <algorithm>
#include <bit>
#include <cmath>

#include "dem/world.hpp"
#include "exec/for_each.hpp"

namespace breccia::dem {
namespace {

struct LeastCritical {
  View<const double> critical;
  BR_HD double operator()(Index e) const { return critical[e]; }
};

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

void move_elements(World& w) {
  const StageTime timed(w.exec, "integration");
  Elements& e = w.elements;
  for_each(w.exec, e.size(),
           MoveElements{kick(w), e.state.view(), e.orientation.view(), e.damping_work.view(),
                        e.load_work.view()});
  for (Wall& wall : w.walls) {
    wall.point += w.next_dt * wall.velocity;
    wall.travelled += w.next_dt * norm(wall.velocity);
  }
  w.time += w.next_dt;
  w.last_dt = w.next_dt;
}

void bar_forces(World& w) {
  const StageTime timed(w.exec, "bar_forces");
  const ElementsView elements = elements_view(w);
  const Index concretes = w.concrete.size();
  SteelLinks& s = w.steel;
  for (const auto& group : w.steel_groups)
    for_each(w.exec, group.end - group.begin,
             Shifted<SteelLinkForces>{{group.law, w.last_dt, elements, s.a.view(), s.b.view(),
                                       s.length.view(), s.state.view(), s.yielded.view(),
                                       s.broke.view(), w.link_actions.view(), concretes},
                                      group.begin});
  InterfaceLinks& b = w.interface;
  for (const auto& group : w.interface_groups)
    for_each(w.exec, group.end - group.begin,
             Shifted<InterfaceLinkForces>{
                 {group.law, w.last_dt, elements, b.a.view(), b.b.view(), b.before.view(),
                  b.after.view(), b.stiffness.view(), b.area.view(), b.state.view(), b.slid.view(),
                  b.broke.view(), w.link_actions.view(), concretes + s.size()},
                 group.begin});
}

void contact_forces(World& w) {
  const StageTime timed(w.exec, "contact_forces");
  Contacts& c = w.contacts;
  for_each(w.exec, c.size(),
           ContactForces{w.parameters.contact, w.last_dt, elements_view(w),
                         w.elements.material.view(), w.contact_pairs.view(), w.parameters.materials,
                         c.pairs.a.view(), c.pairs.b.view(), c.history.state.view(),
                         c.history.slid.view(), c.history.damped.view(), w.contact_actions.view()});
}

void concrete_forces_and_sums(World& w) {
  const StageTime timed(w.exec, "link_forces");
  const ElementsView elements = elements_view(w);
  ConcreteLinks& c = w.concrete;
  std::vector<ConcreteLinkForces> kernels;
  for (const auto& group : w.concrete_groups)
    kernels.push_back({group.law, w.last_dt, elements, c.a.view(), c.b.view(), c.length.view(),
                       c.stiffness.view(), c.opening.view(), c.shear.view(), c.moment.view(),
                       c.slid.view(), c.yielded.view(), c.broke.view(), w.link_actions.view(), 0});
  Elements& e = w.elements;
  const GatherForces gather{w.link_incidence.view(), w.contact_incidence.view(),
                            w.link_actions.view(),   w.contact_actions.view(),
                            e.mass.view(),           e.inertia.view(),
                            e.fixed.view(),          e.force.view(),
                            e.torque.view(),         w.critical.view()};
  // Tile by tile: what the links of a tile write is still in the cache when its elements add it up.
  constexpr Index tile = 512;
  const Sweep& sweep = w.sweep;
  const auto threads = static_cast<int>(sweep.settled.size());
#pragma omp parallel num_threads(threads) if (threads > 1)
  {
    const KernelScope scope;
#pragma omp for schedule(static, 1)
    for (int t = 0; t < threads; ++t) {
      const auto run = static_cast<std::size_t>(t);
      for (Index from = sweep.begin[run]; from < sweep.begin[run + 1]; from += tile) {
        const Index to = std::min(from + tile, sweep.begin[run + 1]);
        for (std::size_t g = 0; g < kernels.size(); ++g) {
          const std::vector<Index>& starts = w.concrete_groups[g].starts;
          run_links(w.lanes, kernels[g], starts[static_cast<std::size_t>(from)],
                    starts[static_cast<std::size_t>(to)]);
        }
        for (Index i = std::max(from, sweep.settled[run]); i < to; ++i) gather(i);
      }
    }
    // The end of the loop above is a barrier: every link is done.
#pragma omp for schedule(static, 1)
    for (int t = 0; t < threads; ++t) {
      const auto run = static_cast<std::size_t>(t);
      const Index end = std::min(sweep.settled[run], sweep.begin[run + 1]);
      for (Index i = sweep.begin[run]; i < end; ++i) gather(i);
    }
  }
}

void wall_forces(World& w) {
  if (w.wall_contacts.size() == 0) return;
  const StageTime timed(w.exec, "wall_forces");
  Contacts& c = w.wall_contacts;
  for (std::size_t k = 0; k < w.walls.size(); ++k)
    for_each(w.exec, w.wall_begin[k + 1] - w.wall_begin[k],
             WallForces{w.parameters.contact, w.last_dt, w.walls[k], elements_view(w),
                        w.elements.material.view(), w.wall_pairs.view(), c.pairs.a.view(),
                        w.wall_begin[k], c.history.state.view(), c.history.slid.view(),
                        c.history.damped.view(), c.history.driven.view(), w.elements.force.view(),
                        w.elements.torque.view(), w.critical.view()});
}

double choose_time_step(const World& w) {
  const StageTime timed(w.exec, "time_step");
  const double least = fold(w.exec, w.elements.size(), 1e300, LeastCritical{w.critical.view()},
                            [](double a, double b) { return smaller(a, b); });
  // sqrt(2): two neighbours in opposite motion (docs/theory.md, time step).
  double dt = w.parameters.time.safety * std::sqrt(2.0 * least);
  dt = std::min({dt, w.parameters.time.max_step, w.parameters.contact_step});
  if (w.last_dt > 0.0) dt = std::min(dt, 1.05 * w.last_dt);  // falls at once, grows slowly
  // Six bits: noise in the stiffest element's last bits must not change every step after it.
  return std::bit_cast<double>(std::bit_cast<std::uint64_t>(dt) & ~((std::uint64_t{1} << 47) - 1));
}

}  // namespace breccia::dem
