#pragma once
// Supports: corners whose motion is prescribed.

#include <algorithm>
#include <string>
#include <vector>

#include "exec/error.hpp"
#include "fdem_shared/setup/over_time.hpp"
#include "fdem_shared/setup/writable.hpp"
#include "fdem_shared/shape.hpp"

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
      if (is_held(hold[t])) start(holds[at(hold[t])], some[t - first]);
    copy_bytes(all.data() + first, all.space(), some.data(), Space::host, bytes);
  }
}

/// A support holds a corner.
/// @param n       the corner
/// @param bits    directions that the support prescribes
/// @param motion  its place in World::prescribed, -1: it stands still
/// @throws InputError where another support does so, too
template <class Shape, class Hold>
void hold_corner(const std::string& support, Index n, int bits, std::int16_t motion, Shape,
                 Hold& hold) {
  const int corner = n % Shape::corners;
  const std::string element =
      std::string(Shape::element) + " " + std::to_string(n / Shape::corners);
  if ((hold.fixed >> (Shape::dimension * corner) & bits) != 0)
    throw InputError("support." + support + ": prescribes a direction of " + element +
                     " that another support prescribes, too");
  if (motion >= 0 && hold.motion[corner] >= 0)
    throw InputError("support." + support + ": " + element +
                     " has a corner that another support moves, too");
  hold.fixed = static_cast<decltype(hold.fixed)>(hold.fixed | bits << (Shape::dimension * corner));
  if (motion >= 0) hold.motion[corner] = motion;
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
  for (std::size_t s = 0; s < config.supports.size(); ++s) {
    const auto& support = config.supports[s];
    const int bits = fixed_directions(support);
    const PrescribedMotionOf<Vector> prescribed = motion_of<Vector>(support);
    std::int16_t motion = -1;
    if (norm(prescribed.velocity) > 0.0 || prescribed.turns() ||
        (support.servo.is_on() && bits != 0)) {
      motion = static_cast<std::int16_t>(w.prescribed.size());
      if (support.servo.is_on())
        w.servo_motions.push_back({s, motion, support.servo.axis_number()});
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
      hold_corner(support.name, n, bits, motion, Shape{}, holds[at(own)]);
    }
  }
  copy_to(set_up(w).holds, holds);
  w.motions.resize(static_cast<Index>(w.prescribed.size()));
}

/// Supports of a new world. @param find  find(region, where): the corners in a region
template <class World, class Config, class Find>
void set_up_supports(World& w, const Config& config, const Find& find) {
  for (const auto& support : config.supports)
    set_up(w).sets.push_back({support.name, find(support.region, "support." + support.name)});
  w.sets_here.resize(w.given->sets.size());
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
}

}  // namespace breccia::fdem_shared
