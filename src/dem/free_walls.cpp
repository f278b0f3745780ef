#include "dem/free_walls.hpp"

#include "domain/together.hpp"
#include "exec/for_each.hpp"

namespace breccia::dem {
namespace {

/// Of contacts with one wall.
struct OnWall {
  ExactSum x, y, z;    ///< force on the wall  [N]
  ExactSum stiffness;  ///< linear law: of what only comes near, too  [N/m]
  ExactSum dashpot;    ///< likewise  [N s/m]
};
BR_HD inline OnWall operator+(OnWall a, const OnWall& b) {
  a.x.add(b.x);
  a.y.add(b.y);
  a.z.add(b.z);
  a.stiffness.add(b.stiffness);
  a.dashpot.add(b.dashpot);
  return a;
}

struct SumOnWall {
  OwnedView owned;
  Index first;  ///< contact of the wall
  int slots;    ///< contacts of each element, of which the first stands for those to come
  Wall wall;
  double wall_mass;  ///<  [kg]
  ContactLaw law;
  View<const Index> a;
  View<const Vec3> on_wall;
  View<const ContactState> contact;
  View<const std::int16_t> material;
  View<const ElementState> state;
  View<const double> mass;
  View<const ContactPair> pairs;

  BR_HD OnWall operator()(Index k) const {
    const Index i = first + k, e = a[i];
    OnWall r;
    const double overlap = contact[i].overlap, radius = state[e].radius;
    if (!owned(e)) return r;
    if (overlap > 0.0) {
      r.x.add(on_wall[i].x);
      r.y.add(on_wall[i].y);
      r.z.add(on_wall[i].z);
    } else if (law.hertz || k % slots != 0) {
      return r;
    }
    const double constant = pairs[material[e]].normal;
    const double stiffness = law.hertz ? 2.0 * constant * sqrt(wall.curved(radius) * overlap)
                                       : 0.5 * constant * wall.stiffness * radius;
    const double both = mass[e] * wall_mass / (mass[e] + wall_mass);
    r.stiffness.add(stiffness);
    if (law.damping > 0.0) r.dashpot.add(2.0 * law.damping * sqrt(both * stiffness));
    return r;
  }
};

OnWall read(const World& w, std::size_t wall) {
  OnWall sum;
  if (wall + 1 < w.wall_begin.size()) {
    const Index begin = w.wall_begin[wall], end = w.wall_begin[wall + 1];
    const WallContacts& c = w.wall_contacts;
    const int slots = mesh_of(w, static_cast<Index>(wall)).empty() ? 1 : mesh_slots;
    sum =
        fold(w.exec, end - begin, OnWall{},
             SumOnWall{w.domain.owned_view(), begin, slots, w.walls[wall],
                       w.given->free_walls[wall].mass, w.given->contact, c.pairs.a.view(),
                       c.history.on_wall.view(), c.history.state.view(), w.elements.material.view(),
                       w.elements.state.view(), w.elements.mass.view(), w.given->wall_pairs.view()},
             Sum{});
  }
  if (w.domain.single_rank()) return sum;
  OnWall all;
  for (const OnWall& own : from_each(*w.domain.ranks, sum)) all = all + own;
  return all;
}

/// Of all forces at the time of the positions.  [m/s2]
Vec3 acceleration(const World& w, std::size_t wall) {
  const FreeWall& free = w.given->free_walls[wall];
  const Vec3 force = w.free_walls[wall].force + free.load_at(w.time);
  return (1.0 / free.mass) * free.allowed(force) + free.allowed(w.given->gravity);
}

}  // namespace

void sum_on_free_walls(World& w) {
  for (std::size_t k = 0; k < w.free_walls.size(); ++k) {
    if (!is_free(w, k)) continue;
    const OnWall sum = read(w, k);
    w.free_walls[k].force = {sum.x.value(), sum.y.value(), sum.z.value()};
    // A dashpot c shortens the stable step: dt <= 2/omega (sqrt(1 + xi^2) - xi), xi = c/(2 M
    // omega).
    const double stiffness = sum.stiffness.value(), dashpot = sum.dashpot.value();
    w.free_walls[k].stiffness = stiffness;
    if (!(dashpot > 0.0)) continue;
    const double xi = dashpot / (2.0 * sqrt(w.given->free_walls[k].mass * stiffness));
    const double shrink = sqrt(1.0 + xi * xi) - xi;
    w.free_walls[k].stiffness = stiffness / (shrink * shrink);
  }
}

double least_of_free_walls(const World& w) {
  double least = largest_least;
  for (std::size_t k = 0; k < w.free_walls.size(); ++k)
    if (is_free(w, k) && w.free_walls[k].stiffness > 0.0)
      least = min(least, w.given->free_walls[k].mass / w.free_walls[k].stiffness);
  return least;
}

void kick_free_wall(World& w, std::size_t wall) {
  Wall& own = w.walls[wall];
  const FreeWall& free = w.given->free_walls[wall];
  const Vec3 before = own.velocity;
  own.velocity += (0.5 * (w.last_dt + w.next_dt)) * acceleration(w, wall);
  // As elements: forces of a step work on half of the way before it and half of the way after it.
  w.free_walls[wall].work +=
      0.5 * dot(free.allowed(free.load_at(w.time)), w.last_dt * before + w.next_dt * own.velocity);
}

Vec3 velocity_of_free_wall(const World& w, std::size_t wall) {
  return w.walls[wall].velocity + (0.5 * w.last_dt) * acceleration(w, wall);
}

Energies held_by_free_walls(const World& w) {
  Energies all;
  if (!w.domain.single_rank() && w.domain.ranks->rank() != 0) return all;
  for (std::size_t k = 0; k < w.free_walls.size(); ++k) {
    if (!is_free(w, k)) continue;
    const FreeWall& free = w.given->free_walls[k];
    const Wall& wall = w.walls[k];
    const Vec3 a = acceleration(w, k), now = velocity_of_free_wall(w, k);
    all.kinetic.add(0.5 * free.mass * (dot(now, now) - 0.25 * w.last_dt * w.next_dt * dot(a, a)));
    all.work.add(w.free_walls[k].work);
    all.work.add(0.5 * w.last_dt * dot(free.allowed(free.load_at(w.time)), wall.velocity));
    all.potential.add(free.mass * dot(free.allowed(w.given->gravity), wall.point));
  }
  return all;
}

}  // namespace breccia::dem
