#include "fdem/setup/removal.hpp"

#include <algorithm>

#include "core/on_host.hpp"
#include "core/set_up.hpp"

namespace breccia::fdem {
namespace {

bool any_removed(const World& w) {
  const std::vector<std::uint8_t>& removed = w.given->removed;
  return std::find(removed.begin(), removed.end(), 1) != removed.end();
}

/// Energy that a joint that is not broken has spent by now: the work it took up, less what it still
/// holds.
JointWork spent_by(const World& w, const std::vector<JointBond>& bonds,
                   const View<const NodeState>& nodes, const Joints& j, Index i) {
  if (j.stage.data()[i] != JointStage::softened) return {};
  const JointEnds e = JointEnds::of(j.edge_a.data()[i], j.edge_b.data()[i]);
  const Vec2 offset = w.joints.preset.size() > 0 ? j.preset.data()[i] : Vec2{};
  const StoredEnergy held =
      stored_in(bonds[at(j.law.data()[i])], j.strength.data()[i], j.length.data()[i], offset,
                opening_of(nodes[e.a0].position, nodes[e.a1].position, nodes[e.b0].position,
                           nodes[e.b1].position),
                j.points.data()[i]);
  const JointWork& work = j.work.data()[i];
  return {work.open - held.open, work.slide - held.slide};
}

}  // namespace

std::vector<NodeSet> removable_bodies(const Config& config, const Model& model) {
  std::vector<NodeSet> bodies;
  for (const StageConfig& stage : config.stages)
    for (const std::string& name : stage.remove) {
      const auto found = std::find(model.groups.begin(), model.groups.end(), name);
      NodeSet body{name, {}};
      for (std::size_t t = 0; t < model.triangle.size(); ++t)
        if (model.group[t] == found - model.groups.begin())
          body.nodes.insert(body.nodes.end(), model.triangle[t].begin(), model.triangle[t].end());
      std::sort(body.nodes.begin(), body.nodes.end());
      body.nodes.erase(std::unique(body.nodes.begin(), body.nodes.end()), body.nodes.end());
      bodies.push_back(std::move(body));
    }
  return bodies;
}

std::vector<std::uint8_t> removed_bodies(const Config& config,
                                         const std::vector<std::string>& bodies) {
  std::vector<std::uint8_t> removed;
  for (const std::string& body : bodies)
    removed.push_back(std::count(config.removed.begin(), config.removed.end(), body) > 0 ? 1 : 0);
  return removed;
}

std::vector<std::uint8_t> gone_triangles(const World& w) {
  std::vector<std::int16_t> group;
  copy_to(group, w.triangles.group);
  std::vector<std::uint8_t> gone;
  gone.reserve(group.size());
  for (const std::int16_t g : group) gone.push_back(w.given->removed[static_cast<std::size_t>(g)]);
  return gone;
}

void open_around_removed(World& w) {
  if (!any_removed(w)) return;
  Case& given = w.given.change(SetUp{});
  for (const NodeSet& body : given.removable) {
    const auto place = std::find(given.groups.begin(), given.groups.end(), body.name);
    if (given.removed[static_cast<std::size_t>(place - given.groups.begin())] == 0) continue;
    for (const Index vertex : body.nodes) given.open_vertex[at(vertex)] = 3;
  }
  w.border_vertex.clear();
  const std::vector<std::uint8_t> gone = gone_triangles(w);
  std::vector<EdgeJoints> edges;
  copy_to(edges, w.edges);
  for (std::size_t t = 0; t < edges.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      Index& entry = edges[t].at[k];
      const Index other = w.across[3 * t + k];
      if (entry == edge_bonded && (gone[t] != 0 || (other >= 0 && gone[at(other / 3)] != 0)))
        entry = edge_free;
    }
  copy_to(w.edges, edges);
  if (!edges.empty()) derive_bundles(w);
  w.graph.clear();
}

void cut_off_removed(World& w) {
  if (!any_removed(w)) return;
  const std::vector<std::uint8_t> gone = gone_triangles(w);
  std::vector<TriangleNodes> nodes;
  copy_to(nodes, w.triangles.nodes);
  for (std::size_t t = 0; t < nodes.size(); ++t)
    if (gone[t] != 0)
      for (NodeState& n : nodes[t].at) n.velocity = {};
  copy_to(w.triangles.nodes, nodes);

  Joints j = host_copy(w.joints);
  if (w.joints.preset.size() > 0) {
    std::vector<Vec2> preset;
    copy_to(preset, w.joints.preset);
    copy_to(j.preset, preset);
  }
  std::vector<JointBond> bonds;
  copy_to(bonds, w.given->bonds);
  View<const TriangleNodes> all;
  all.data = nodes.data();
  all.size = static_cast<Index>(nodes.size());
  for (Index i = 0; i < j.size(); ++i) {
    const bool at_gone =
        gone[at(j.edge_a.data()[i] / 3)] != 0 || gone[at(j.edge_b.data()[i] / 3)] != 0;
    JointStage& stage = j.stage.data()[i];
    if (!at_gone || is_parted(stage)) continue;
    j.inherited_work.data()[i] = j.work.data()[i] = spent_by(w, bonds, by_number(all), j, i);
    stage = JointStage::cut;
  }
  const auto back = [](auto& to, const auto& from) {
    const auto values = from.host();
    copy_to(to, std::vector(values.begin(), values.end()));
  };
  back(w.joints.stage, j.stage);
  back(w.joints.work, j.work);
  back(w.joints.inherited_work, j.inherited_work);
  copy_to(w.exposed.changed, std::vector<std::uint8_t>{1, 1});  // the next step searches
  if (j.size() > 0) derive_bundles(w);
  w.graph.clear();
}

}  // namespace breccia::fdem
