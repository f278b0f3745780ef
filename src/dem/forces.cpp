// The launches of a step's loops over elements, links and contacts.

#include <algorithm>
#include <bit>
#include <cmath>

#include "dem/world.hpp"
#include "exec/for_each.hpp"

namespace breccia::dem {
namespace {

/// Concrete links [begin, end), shared among threads in whole packs.
void run_shared(const World& w, const ConcreteLinkForces& kernel, Index begin, Index end) {
  const int threads = end - begin < smallest_shared_loop ? 1 : w.exec.threads;
  constexpr Index pack = 8;
  const Index packs = (end - begin + pack - 1) / pack;
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
  for (int t = 0; t < threads; ++t) {
    const KernelScope scope;
    const auto share = [&](int part) {
      return static_cast<Index>(static_cast<std::int64_t>(packs) * part / threads) * pack;
    };
    run_links(w.lanes, kernel, begin + share(t), std::min(end, begin + share(t + 1)));
  }
}

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

void link_forces(World& w) {
  const StageTime timed(w.exec, "link_forces");
  const ElementsView elements = elements_view(w);
  ConcreteLinks& c = w.concrete;
  for (const auto& group : w.concrete_groups)
    run_shared(w,
               {group.law, w.last_dt, elements, c.a.view(), c.b.view(), c.length.view(),
                c.stiffness.view(), c.opening.view(), c.shear.view(), c.moment.view(),
                c.slid.view(), c.yielded.view(), c.broke.view(), w.link_actions.view(), 0},
               group.begin, group.end);
  SteelLinks& s = w.steel;
  for (const auto& group : w.steel_groups)
    for_each(w.exec, group.end - group.begin,
             Shifted<SteelLinkForces>{{group.law, w.last_dt, elements, s.a.view(), s.b.view(),
                                       s.length.view(), s.state.view(), s.yielded.view(),
                                       s.broke.view(), w.link_actions.view(), c.size()},
                                      group.begin});
  InterfaceLinks& b = w.interface;
  for (const auto& group : w.interface_groups)
    for_each(w.exec, group.end - group.begin,
             Shifted<InterfaceLinkForces>{
                 {group.law, w.last_dt, elements, b.a.view(), b.b.view(), b.before.view(),
                  b.after.view(), b.stiffness.view(), b.area.view(), b.state.view(), b.slid.view(),
                  b.broke.view(), w.link_actions.view(), c.size() + s.size()},
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

void gather_forces(World& w) {
  const StageTime timed(w.exec, "gather");
  Elements& e = w.elements;
  for_each(w.exec, e.size(),
           GatherForces{w.link_incidence.view(), w.contact_incidence.view(), w.link_actions.view(),
                        w.contact_actions.view(), e.mass.view(), e.inertia.view(), e.fixed.view(),
                        e.force.view(), e.torque.view(), w.critical.view()});
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
