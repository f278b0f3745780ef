#include "dem/free_walls.hpp"

#include "domain/owned.hpp"
#include "domain/together.hpp"

namespace breccia::dem {
namespace {

/// Of contacts with one wall.
struct OnWall {
  ExactSum x, y, z;     ///< force on the wall  [N]
  ExactSum tx, ty, tz;  ///< its torque about the centre of mass, if it turns  [N m]
  ExactSum stiffness;   ///< linear law: of what only comes near, too  [N/m]
  ExactSum dashpot;     ///< likewise  [N s/m]
};
BR_HD inline OnWall operator+(OnWall a, const OnWall& b) {
  a.x.add(b.x);
  a.y.add(b.y);
  a.z.add(b.z);
  a.tx.add(b.tx);
  a.ty.add(b.ty);
  a.tz.add(b.tz);
  a.stiffness.add(b.stiffness);
  a.dashpot.add(b.dashpot);
  return a;
}

struct SumOnWall {
  Index first;  ///< contact of the wall
  int slots;    ///< contacts of each element, of which the first stands for those to come
  Wall wall;
  double wall_mass;  ///<  [kg]
  bool turns;
  Vec3 centre;  ///< of its mass  [m]
  ContactLaw law;
  View<const Index> a;
  View<const Vec3> on_wall, place;
  View<const ContactState> contact;
  View<const std::int16_t> material;
  View<const ElementState> state;
  View<const double> mass;
  View<const ContactPair> pairs;

  BR_HD OnWall operator()(Index k) const {
    const Index i = first + k, e = a[i];
    OnWall r;
    const double overlap = contact[i].overlap, radius = state[e].radius;
    if (overlap > 0.0) {
      r.x.add(on_wall[i].x);
      r.y.add(on_wall[i].y);
      r.z.add(on_wall[i].z);
      if (turns) {
        const Vec3 foot = foot_on(wall, state[e].position, place[i]);
        const Vec3 torque = cross(foot - centre, on_wall[i]);
        r.tx.add(torque.x);
        r.ty.add(torque.y);
        r.tz.add(torque.z);
      }
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

/// Unit vectors of a wall's own frame.
struct Axes {
  Vec3 x, y, z;

  explicit Axes(const Wall& wall)
      : x(wall.along), y(cross(wall.normal, wall.along)), z(wall.normal) {}
  Vec3 out(const Vec3& v) const { return v.x * x + v.y * y + v.z * z; }
  Vec3 in(const Vec3& v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
  Vec3 out(const Sym3& s, const Vec3& v) const { return out(s * in(v)); }
};

/// Cayley's rotation of a vector by an angle: exact to the third order, of the same length.
Vec3 turned(const Vec3& v, const Vec3& angle) {
  const Vec3 half = 0.5 * angle, aside = cross(half, v);
  return v + (2.0 / (1.0 + dot(half, half))) * (aside + cross(half, aside));
}
/// A wall turned by an angle about its point.
Wall turned(Wall wall, const Vec3& angle) {
  const Vec3 normal = turned(wall.normal, angle), along = turned(wall.along, angle);
  wall.normal = (1.0 / norm(normal)) * normal;
  const Vec3 across = along - dot(along, wall.normal) * wall.normal;
  wall.along = (1.0 / norm(across)) * across;
  return wall;
}

Vec3 centre_of(const World& w, std::size_t wall) {
  const FreeWall& free = w.given->free_walls[wall];
  return free.turns ? w.walls[wall].point - Axes(w.walls[wall]).out(free.spread.offset)
                    : w.walls[wall].point;
}
/// Half a step before now.
Vec3 kept_velocity(const World& w, std::size_t wall) {
  return w.given->free_walls[wall].turns ? w.free_walls[wall].velocity : w.walls[wall].velocity;
}

OnWall read(const World& w, std::size_t wall) {
  OnWall sum;
  if (wall + 1 < w.wall_begin.size()) {
    const Index begin = w.wall_begin[wall], end = w.wall_begin[wall + 1];
    const WallContacts& c = w.wall_contacts;
    const int slots = mesh_of(w, static_cast<Index>(wall)).empty() ? 1 : mesh_slots;
    sum = fold_owned(
        w.exec, w.domain, end - begin, OnWall{},
        SumOnWall{begin, slots, w.walls[wall], w.given->free_walls[wall].mass,
                  w.given->free_walls[wall].turns, centre_of(w, wall), w.given->contact,
                  c.pairs.a.view(), c.history.on_wall.view(), c.history.place.view(),
                  c.history.state.view(), w.elements.material.view(), w.elements.state.view(),
                  w.elements.mass.view(), w.given->wall_pairs.view()},
        Sum{}, ListedElement<>{c.pairs.a.view(), begin});
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

/// The mass that a push feels at least.  [kg]
double least_mass(const World& w, std::size_t wall) {
  const FreeWall& free = w.given->free_walls[wall];
  return free.turns ? free.spread.least_mass : free.mass;
}

/// The turn of a step, and where it leaves the wall.
void turn_free_wall(World& w, std::size_t wall) {
  Wall& own = w.walls[wall];
  FreeWallState& state = w.free_walls[wall];
  const MassSpread& spread = w.given->free_walls[wall].spread;
  const double dt = w.next_dt;
  const Vec3 centre = centre_of(w, wall) + dt * state.velocity;
  constexpr int passes = 4;  // the spin at half of the turn that it makes
  Vec3 spin = Axes(own).out(spread.inverse, state.angular);
  for (int pass = 0; pass < passes; ++pass)
    spin = Axes(turned(own, (0.5 * dt) * spin)).out(spread.inverse, state.angular);
  Wall there = turned(own, dt * spin);
  there.point = centre + Axes(there).out(spread.offset);
  there.velocity = (1.0 / dt) * (there.point - own.point);
  there.spin = spin;
  there.travelled += dt * (norm(state.velocity - w.travel.drift.velocity) +
                           norm(spin) * (own.extent() + own.radius + norm(spread.offset)));
  own = there;
}

}  // namespace

void sum_on_free_walls(World& w) {
  for (std::size_t k = 0; k < w.free_walls.size(); ++k) {
    if (!is_free(w, k)) continue;
    const OnWall sum = read(w, k);
    w.free_walls[k].force = {sum.x.value(), sum.y.value(), sum.z.value()};
    w.free_walls[k].torque = {sum.tx.value(), sum.ty.value(), sum.tz.value()};
    // A dashpot c shortens the stable step: dt <= 2/omega (sqrt(1 + xi^2) - xi), xi = c/(2 M
    // omega).
    const double stiffness = sum.stiffness.value(), dashpot = sum.dashpot.value();
    w.free_walls[k].stiffness = stiffness;
    if (!(dashpot > 0.0)) continue;
    const double xi = dashpot / (2.0 * sqrt(least_mass(w, k) * stiffness));
    const double shrink = sqrt(1.0 + xi * xi) - xi;
    w.free_walls[k].stiffness = stiffness / (shrink * shrink);
  }
}

double least_of_free_walls(const World& w) {
  double least = largest_least;
  for (std::size_t k = 0; k < w.free_walls.size(); ++k)
    if (is_free(w, k) && w.free_walls[k].stiffness > 0.0)
      least = min(least, least_mass(w, k) / w.free_walls[k].stiffness);
  return least;
}

void move_free_wall(World& w, std::size_t wall) {
  Wall& own = w.walls[wall];
  FreeWallState& state = w.free_walls[wall];
  const FreeWall& free = w.given->free_walls[wall];
  const double between = 0.5 * (w.last_dt + w.next_dt);
  const Vec3 before = kept_velocity(w, wall), after = before + between * acceleration(w, wall);
  // As elements: forces of a step work on half of the way before it and half of the way after it.
  state.work +=
      0.5 * dot(free.allowed(free.load_at(w.time)), w.last_dt * before + w.next_dt * after);
  if (free.turns) {
    state.velocity = after;
    state.angular += between * state.torque;
    turn_free_wall(w, wall);
  } else {
    own.velocity = after;
    own.move(w.next_dt, w.travel.drift.velocity);
  }
}

void start_turning(World& w, std::size_t wall, const Vec3& velocity, const Vec3& spin) {
  Wall& own = w.walls[wall];
  const Axes axes(own);
  const MassSpread& spread = w.given->free_walls[wall].spread;
  w.free_walls[wall].velocity = velocity;
  w.free_walls[wall].angular = axes.out(spread.inertia, spin);
  own.velocity = velocity + cross(spin, axes.out(spread.offset));
  own.spin = spin;
}

Vec3 velocity_of_free_wall(const World& w, std::size_t wall) {
  return kept_velocity(w, wall) + (0.5 * w.last_dt) * acceleration(w, wall);
}

Vec3 angular_momentum_of_wall(const World& w, std::size_t wall, const Vec3& about) {
  const FreeWall& free = w.given->free_walls[wall];
  const FreeWallState& state = w.free_walls[wall];
  return state.angular + (0.5 * w.last_dt) * state.torque +
         free.mass * cross(centre_of(w, wall) - about, velocity_of_free_wall(w, wall));
}

double kinetic_of_free_wall(const World& w, std::size_t wall) {
  const FreeWall& free = w.given->free_walls[wall];
  const FreeWallState& state = w.free_walls[wall];
  const Vec3 now = velocity_of_free_wall(w, wall);
  if (!free.turns) return 0.5 * free.mass * dot(now, now);
  const Vec3 angular = state.angular + (0.5 * w.last_dt) * state.torque;
  const Vec3 spin = Axes(w.walls[wall]).out(free.spread.inverse, angular);
  return 0.5 * (free.mass * dot(now, now) + dot(angular, spin));
}

Energies held_by_free_walls(const World& w) {
  Energies all;
  if (!w.domain.single_rank() && w.domain.ranks->rank() != 0) return all;
  for (std::size_t k = 0; k < w.free_walls.size(); ++k) {
    if (!is_free(w, k)) continue;
    const FreeWall& free = w.given->free_walls[k];
    const Vec3 a = acceleration(w, k);
    // Less what the half steps of the scheme have too much (dem/energy.cpp).
    const double both = 0.125 * w.last_dt * w.next_dt;
    all.kinetic.add(kinetic_of_free_wall(w, k) - both * free.mass * dot(a, a));
    if (free.turns) {
      const Vec3& torque = w.free_walls[k].torque;
      all.kinetic.add(-both * dot(torque, Axes(w.walls[k]).out(free.spread.inverse, torque)));
    }
    all.work.add(w.free_walls[k].work);
    all.work.add(0.5 * w.last_dt * dot(free.allowed(free.load_at(w.time)), kept_velocity(w, k)));
    all.potential.add(free.mass * dot(free.allowed(w.given->gravity), centre_of(w, k)));
  }
  return all;
}

}  // namespace breccia::dem
