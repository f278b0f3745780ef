#pragma once
// Supports: corners whose motion is prescribed.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "exec/error.hpp"
#include "fdem_shared/setup/over_time.hpp"
#include "fdem_shared/setup/writable.hpp"
#include "fdem_shared/shape.hpp"
#include "fdem_shared/summed_apart.hpp"

namespace breccia::fdem_shared {

/// Corners of all elements of the whole mesh.
template <class World, class Config>
std::size_t corners_of_bodies(const World& w, const Config& config) {
  const std::size_t bodies = w.given->sets.size() - config.supports.size();
  std::size_t corners = 0;
  for (std::size_t b = 0; b < bodies; ++b) corners += w.given->sets[b].nodes.size();
  return corners;
}

/// Held nodes start with the motion of their support: no jump of velocity at the start does work.
template <class World, class Hold>
void start_held(World& w, const std::vector<Hold>& holds, const std::vector<Index>& hold) {
  using Shape = ShapeOf<World>;
  const auto start = [&](const Hold& h, typename Shape::Nodes& nodes) {
    for (int k = 0; k < Shape::corners; ++k) {
      auto& velocity = nodes.at[k].velocity;
      const auto given = h.motion[k] >= 0 ? w.prescribed[at(h.motion[k])].now(0.0, 0.0).at(
                                                nodes.at[k].position, 0.0)
                                          : typename Shape::Vector{};
      velocity = held_parts(h.fixed >> (Shape::dimension * k), given, velocity);
    }
  };
  // A few at once go to the host and back, if one of them is held.
  constexpr std::size_t at_once = 1024;
  Buffer<typename Shape::Nodes>& all = Shape::elements(w).nodes;
  std::vector<typename Shape::Nodes> some;
  for (std::size_t first = 0; first < hold.size(); first += at_once) {
    const std::size_t end = std::min(hold.size(), first + at_once);
    const auto is_held = [](Index place) { return place >= 0; };
    if (std::none_of(hold.begin() + static_cast<std::ptrdiff_t>(first),
                     hold.begin() + static_cast<std::ptrdiff_t>(end), is_held))
      continue;
    some.resize(end - first);
    const std::size_t bytes = some.size() * sizeof some[0];
    copy_bytes(some.data(), Space::host, all.data() + first, all.space(), bytes);
    for (std::size_t t = first; t < end; ++t)
      if (is_held(hold[t]) && holds[at(hold[t])].loose == 0)
        start(holds[at(hold[t])], some[t - first]);
    copy_bytes(all.data() + first, all.space(), some.data(), Space::host, bytes);
  }
}

/// A support holds a corner.
/// @param n       the corner
/// @param bits    directions that the support prescribes
/// @param motion  its place in World::prescribed, -1: it stands still
/// @param clash   clash(bits) tells of directions that another support prescribes, too; 0: of two
///                that move it
template <class Shape, class Hold, class Clash>
void hold_corner(Index n, int bits, std::int16_t motion, Shape, Hold& hold, const Clash& clash) {
  const int corner = n % Shape::corners;
  const int twice = hold.fixed >> (Shape::dimension * corner) & bits;
  if (twice != 0 || (motion >= 0 && hold.motion[corner] >= 0)) clash(twice);
  hold.fixed = static_cast<decltype(hold.fixed)>(hold.fixed | bits << (Shape::dimension * corner));
  if (motion >= 0) hold.motion[corner] = motion;
}

/// Refuses two supports that hold a corner in one direction, or that move it both.
/// @param s     the second of them
/// @param n     the corner
/// @param bits  the directions; 0: both move it, in different ones
template <class World, class Config>
[[noreturn]] void refuse_two_supports(const World& w, const Config& config, std::size_t s, Index n,
                                      int bits) {
  using Shape = ShapeOf<World>;
  const std::size_t bodies = w.given->sets.size() - config.supports.size();
  std::string other = "another support";
  for (std::size_t o = 0; o < s; ++o) {
    const auto& nodes = w.given->sets[bodies + o].nodes;
    const bool meant = bits == 0 || (fixed_directions(config.supports[o]) & bits) != 0;
    if (meant && std::find(nodes.begin(), nodes.end(), n) != nodes.end())
      other = "support." + config.supports[o].name;
  }
  std::string axes;
  for (int axis = 0; axis < Shape::dimension; ++axis)
    if ((bits >> axis & 1) != 0) axes += std::string(axes.empty() ? "" : " and ") + "xyz"[axis];
  const std::string element =
      std::string(Shape::element) + " " + std::to_string(n / Shape::corners);
  const auto& all = Shape::elements(w).nodes;
  std::string place;
  if (w.domain.single_rank() && n / Shape::corners < all.size()) {
    typename Shape::Nodes nodes;
    copy_bytes(&nodes, Space::host, all.data() + n / Shape::corners, all.space(), sizeof nodes);
    const Vec3 x = to_space(nodes.at[n % Shape::corners].position);
    place = Shape::dimension == 2 ? fmt::format(" at ({:.4g}, {:.4g}) m", x.x, x.y)
                                  : fmt::format(" at ({:.4g}, {:.4g}, {:.4g}) m", x.x, x.y, x.z);
  }
  const std::string head = "support." + config.supports[s].name;
  if (bits == 0)
    throw InputError(head + ": moves a corner of " + element + place + " that " + other +
                     " moves, too");
  throw InputError(head + ": prescribes " + axes + " of a corner of " + element + place + " that " +
                   other + " prescribes, too; leave " + axes +
                   " out of fix of one of them, or hold different regions");
}

/// A rigid body as the keys of its support say.
/// @param set  of its corners
template <class Vector, class Support>
RigidBodyOf<Vector> rigid_body(const Support& support, std::size_t number, std::size_t set,
                               std::int16_t motion) {
  RigidBodyOf<Vector> body{number, set, motion, support.free_directions(), support.is_turning()};
  body.force = scale_of(support.force);
  body.force_over = amplitudes<Vector>(support.force, support.history);
  body.torque = scale_of(support.torque);
  body.torque_over = amplitudes<SpinOf<Vector>>(support.torque, support.history);
  return body;
}

/// Refuses rigid bodies that hold a part of an element, or of what moves as one.
template <class World, class Config, class Hold>
void refuse_parts_of_bodies(const World& w, const Config& config, const std::vector<Hold>& holds,
                            const std::vector<Index>& hold) {
  using Shape = ShapeOf<World>;
  if (w.rigid_bodies.empty() || !w.domain.single_rank()) return;
  const auto motion_of_body = [&](std::size_t t) -> std::int16_t {
    const Index own = hold[t];
    return own < 0 || holds[at(own)].loose == 0 ? std::int16_t{-1} : holds[at(own)].motion[0];
  };
  const auto refuse = [&](std::int16_t motion, std::size_t t, const std::string& why) {
    for (const auto& body : w.rigid_bodies)
      if (body.motion == motion)
        throw InputError("support." + config.supports[body.support].name +
                         ".free: " + Shape::element + " " + std::to_string(t) + why);
  };
  constexpr int all = (1 << Shape::dimension) - 1;
  for (std::size_t t = 0; t < hold.size(); ++t) {
    if (hold[t] < 0 || holds[at(hold[t])].loose == 0) continue;
    const Hold& h = holds[at(hold[t])];
    std::int16_t motion = -1;
    bool whole = true;
    for (int k = 0; k < static_cast<int>(Shape::corners); ++k) {
      if (h.motion[k] >= 0) motion = h.motion[k];
      whole = whole && h.fixed_at(k) == all && h.motion[k] == h.motion[0];
    }
    if (!whole)
      refuse(motion, t,
             " has corners outside its region; a body that moves by forces is one of whole "
             "elements, as `on` takes them");
  }
  std::vector<Index> starts, nodes, leader;
  copy_to(starts, w.bundles.starts);
  copy_to(nodes, w.bundles.nodes);
  copy_to(leader, w.bundles.leader);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const std::size_t t = at(nodes[k] / Shape::corners),
                      with = at(nodes[at(leader[k])] / Shape::corners);
    const auto is_out = [&](std::size_t e) {
      return hold[e] >= 0 && Shape::is_gone(holds[at(hold[e])]);
    };
    if (is_out(t) || is_out(with) || motion_of_body(t) == motion_of_body(with)) continue;
    const bool first = motion_of_body(t) >= 0;
    refuse(motion_of_body(first ? t : with), first ? t : with,
           " moves as one with " + std::string(Shape::element) + " " +
               std::to_string(first ? with : t) +
               ", which it does not hold; joints must join them, or nothing");
  }
}

/// Each corner follows the sum of the supports that hold it, each in its own directions.
/// @param holds  those that there are already: of elements that have been taken out
/// @param hold   place in `holds` of each element of the whole mesh, -1: it is free
template <class World, class Config, class Hold>
void prescribe_supports(World& w, const Config& config, std::vector<Hold>& holds,
                        std::vector<Index>& hold) {
  using Shape = ShapeOf<World>;
  using Vector = typename Shape::Vector;
  const std::size_t bodies = w.given->sets.size() - config.supports.size();
  w.prescribed.clear();
  w.servo_motions.clear();
  w.rigid_bodies.clear();
  for (std::size_t s = 0; s < config.supports.size(); ++s) {
    const auto& support = config.supports[s];
    const int bits = fixed_directions(support);
    PrescribedMotionOf<Vector> prescribed = motion_of<Vector>(support);
    const bool loose = support.is_free() && bits != 0;
    if (loose) prescribed.spin = {};  // with which it begins
    std::int16_t motion = -1;
    if (norm(prescribed.velocity) > 0.0 || prescribed.turns() || loose ||
        (support.servo.is_on() && bits != 0)) {
      motion = static_cast<std::int16_t>(w.prescribed.size());
      if (support.servo.is_on())
        w.servo_motions.push_back({s, motion, support.servo.axis_number()});
      if (loose) w.rigid_bodies.push_back(rigid_body<Vector>(support, s, bodies + s, motion));
      w.prescribed.push_back(prescribed);
    }
    if (bits == 0) continue;  // it lets go
    for (const Index n : w.given->sets[bodies + s].nodes) {
      Index& own = hold[at(n / Shape::corners)];
      if (own >= 0 && Shape::is_gone(holds[at(own)])) continue;
      if (own < 0) {
        own = static_cast<Index>(holds.size());
        holds.emplace_back();
      }
      hold_corner(n, bits, motion, Shape{}, holds[at(own)],
                  [&](int twice) { refuse_two_supports(w, config, s, n, twice); });
      if (loose) holds[at(own)].loose = 1;
    }
  }
  refuse_parts_of_bodies(w, config, holds, hold);
  copy_to(set_up(w).holds, holds);
  w.motions.resize(static_cast<Index>(w.prescribed.size()));
}

/// Whether a support ever lets a body move by forces.
template <class Config>
bool frees_any(const Config& config) {
  const auto is_free = [](const auto& support) { return support.is_free(); };
  return std::any_of(config.supports.begin(), config.supports.end(), is_free) ||
         std::any_of(config.stages.begin(), config.stages.end(), [&](const auto& stage) {
           return std::any_of(stage.supports.begin(), stage.supports.end(), is_free);
         });
}

/// Supports of a new world. @param find  find(region, where): the corners in a region
template <class World, class Config, class Find>
void set_up_supports(World& w, const Config& config, const Find& find) {
  for (const auto& support : config.supports)
    set_up(w).sets.push_back({support.name, find(support.region, "support." + support.name)});
  w.sets_here.resize(w.given->sets.size());
  if (frees_any(config)) w.rigid.resize(config.supports.size());
  const std::vector<Index> hold = ShapeOf<World>::prescribe(w, config);
  copy_to(ShapeOf<World>::elements(w).hold, hold);
  std::vector<typename ShapeOf<World>::Hold> holds;
  copy_to(holds, w.given->holds);
  start_held(w, holds, hold);
}

/// Supports of another stage: elements that are here get their holds.
template <class World, class Config>
void hold_anew(World& w, const Config& config) {
  const std::vector<Index> hold = ShapeOf<World>::prescribe(w, config);
  auto& e = ShapeOf<World>::elements(w);
  std::vector<Index> ids, own;
  copy_to(ids, e.id);
  for (const Index id : ids) own.push_back(hold[at(id)]);
  copy_to(e.hold, own);
  w.held_couples.known = false;
  forget_apart(w);
}

}  // namespace breccia::fdem_shared
