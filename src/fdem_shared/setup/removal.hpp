#pragma once
// Bodies that a stage takes out of the model. Their elements stay in memory, where they are, held
// and without contact, so that numbers of elements are for ever. One text for both methods, made in
// the removal.cpp of each.

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/on_host.hpp"
#include "exec/error.hpp"
#include "fdem_shared/setup/writable.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// Which vertices bodies have that some stage takes out, ascending.
template <class World, class Config, class Model>
auto removable_bodies(const Config& config, const Model& model) {
  auto bodies = std::remove_cvref_t<decltype(std::declval<World&>().given->removable)>{};
  const auto& corners = ShapeOf<World>::corners_of(model);
  for (const auto& stage : config.stages)
    for (const std::string& name : stage.remove) {
      const auto found = std::find(model.groups.begin(), model.groups.end(), name);
      bodies.push_back({name, {}});
      std::vector<Index>& own = bodies.back().nodes;
      for (std::size_t t = 0; t < corners.size(); ++t)
        if (model.group[t] == found - model.groups.begin())
          own.insert(own.end(), corners[t].begin(), corners[t].end());
      std::sort(own.begin(), own.end());
      own.erase(std::unique(own.begin(), own.end()), own.end());
    }
  return bodies;
}

/// Sides that a stage lays bare by the bodies that it takes out.
struct LaidBare {
  std::string stage;                      ///< empty: none; the border at the start counts
  std::vector<std::uint8_t> taken, gone;  ///< of each body: by this stage, and by its end

  /// The one of two sides that lie on each other that a load acts on, -1: none.
  /// @param a, b  sides, b -1: none  @param group  group(side): its body
  template <class Group>
  Index side(Index a, Index b, const Group& group) const {
    if (stage.empty()) return b < 0 ? a : -1;
    if (b < 0) return -1;
    if (taken[group(b)] != 0 && gone[group(a)] == 0) return a;
    return taken[group(a)] != 0 && gone[group(b)] == 0 ? b : -1;
  }
  /// Why a region takes none. @param sides  "edge", "face"
  std::string none_of(const std::string& where, const std::string& sides) const {
    if (stage.empty()) return where + ": its region holds no " + sides + " on the border";
    return where + ": its region holds no " + sides + " that stage." + stage + " lays bare";
  }
};
/// @throws InputError where there is no such stage
template <class Config>
LaidBare laid_bare_by(const Config& config, const std::string& name,
                      const std::vector<std::string>& bodies) {
  LaidBare bare{name, std::vector<std::uint8_t>(bodies.size(), 0), {}};
  bare.gone = bare.taken;
  if (name.empty()) return bare;
  for (const auto& stage : config.stages) {
    for (std::size_t b = 0; b < bodies.size(); ++b)
      if (std::count(stage.remove.begin(), stage.remove.end(), bodies[b]) > 0) {
        bare.gone[b] = 1;
        if (stage.name == name) bare.taken[b] = 1;
      }
    if (stage.name == name) return bare;
  }
  throw InputError("there is no stage." + name);
}

/// Of each body whether it is gone in this stage.
template <class Config>
std::vector<std::uint8_t> removed_bodies(const Config& config,
                                         const std::vector<std::string>& bodies) {
  std::vector<std::uint8_t> removed;
  for (const std::string& body : bodies)
    removed.push_back(std::count(config.removed.begin(), config.removed.end(), body) > 0 ? 1 : 0);
  return removed;
}

/// Holds of elements that have been taken out.
template <class World, class Config, class Hold>
void hold_removed(World& w, const Config& config, const Hold& gone, std::vector<Hold>& holds,
                  std::vector<Index>& hold) {
  auto& given = set_up(w);
  given.removed = removed_bodies(config, given.groups);
  for (std::size_t b = 0; b < given.removed.size(); ++b) {
    if (given.removed[b] == 0) continue;
    if (holds.empty()) holds.push_back(gone);
    for (const Index n : given.sets[b].nodes) hold[at(n / ShapeOf<World>::corners)] = 0;
  }
}

template <class World>
bool any_removed(const World& w) {
  const std::vector<std::uint8_t>& removed = w.given->removed;
  return std::find(removed.begin(), removed.end(), 1) != removed.end();
}

/// Of each element of this world: 1 if it is gone.
template <class World>
std::vector<std::uint8_t> gone_elements(const World& w) {
  std::vector<std::int16_t> group;
  copy_to(group, ShapeOf<World>::elements(w).group);
  std::vector<std::uint8_t> gone;
  gone.reserve(group.size());
  for (const std::int16_t g : group) gone.push_back(w.given->removed[static_cast<std::size_t>(g)]);
  return gone;
}

/// Parts the bodies that are gone by now from all others, where the mesh never changes otherwise:
/// as their stage begins, and before a checkpoint of a later time is loaded.
template <class World>
void open_around(World& w) {
  using Shape = ShapeOf<World>;
  if (!any_removed(w)) return;
  auto& given = set_up(w);
  for (const auto& body : given.removable) {
    const auto place = std::find(given.groups.begin(), given.groups.end(), body.name);
    if (given.removed[static_cast<std::size_t>(place - given.groups.begin())] == 0) continue;
    for (const Index vertex : body.nodes) given.open_vertex[at(vertex)] = 3;
  }
  w.border_vertex.clear();
  const std::vector<std::uint8_t> gone = gone_elements(w);
  std::vector<typename Shape::Sides> sides;
  copy_to(sides, Shape::sides(w));
  for (std::size_t t = 0; t < sides.size(); ++t)
    for (std::size_t k = 0; k < static_cast<std::size_t>(Shape::corners); ++k) {
      Index& entry = sides[t].at[k];
      const Index other = w.across[static_cast<std::size_t>(Shape::corners) * t + k];
      if (entry == Shape::side_bonded &&
          (gone[t] != 0 || (other >= 0 && gone[at(other / Shape::corners)] != 0)))
        entry = Shape::side_free;
    }
  copy_to(Shape::sides(w), sides);
  if (!sides.empty()) derive_bundles(w);
  w.graph.clear();
}

/// Brings the bodies that are gone to a stop and cuts their joints, as their stage begins.
/// @param spent_by  spent_by(nodes, joints, i): what joint i, whole or softened, has spent by now
template <class World, class Spent>
void cut_off(World& w, const Spent& spent_by) {
  using Shape = ShapeOf<World>;
  if (!any_removed(w)) return;
  const std::vector<std::uint8_t> gone = gone_elements(w);
  std::vector<typename Shape::Nodes> nodes;
  copy_to(nodes, Shape::elements(w).nodes);
  for (std::size_t t = 0; t < nodes.size(); ++t)
    if (gone[t] != 0)
      for (auto& n : nodes[t].at) n.velocity = {};
  copy_to(Shape::elements(w).nodes, nodes);

  auto j = host_copy(w.joints);
  if (w.joints.preset.size() > 0) {
    std::vector<typename Shape::Vector> preset;
    copy_to(preset, w.joints.preset);
    copy_to(j.preset, preset);
  }
  for (Index i = 0; i < j.size(); ++i) {
    const bool at_gone = gone[at(Shape::side_a(j).data()[i] / Shape::corners)] != 0 ||
                         gone[at(Shape::side_b(j).data()[i] / Shape::corners)] != 0;
    auto& stage = j.stage.data()[i];
    if (!at_gone || is_parted(stage)) continue;
    const auto spent = spent_by(nodes, j, i);
    j.work.data()[i] = spent.work;
    inherit(j, i, spent.work, spent.rubbed);
    stage = std::remove_reference_t<decltype(stage)>::cut;
  }
  const auto back = [](auto& to, const auto& from) {
    const auto values = from.host();
    copy_to(to, std::vector(values.begin(), values.end()));
  };
  back(w.joints.stage, j.stage);
  back(w.joints.work, j.work);
  take_inherited(w.joints, j);
  copy_to(w.exposed.changed, std::vector<std::uint8_t>{1, 1});  // the next step searches
  if (j.size() > 0) derive_bundles(w);
  w.graph.clear();
}

}  // namespace breccia::fdem_shared
