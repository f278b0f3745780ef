// From a model to a world: split corners, joints, bundles, supports, loads, first forces.

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/world_space.hpp"
#include "exec/error.hpp"
#include "fdem/observe.hpp"
#include "fdem/setup/loads.hpp"
#include "fdem/setup/materials.hpp"
#include "fdem/setup/mesh_edges.hpp"
#include "fdem/setup/pressed_faces.hpp"
#include "fdem/setup/regions.hpp"
#include "fdem/setup/warnings.hpp"
#include "fdem/shape.hpp"
#include "fdem_shared/setup/elements.hpp"
#include "fdem_shared/setup/heavier.hpp"
#include "fdem_shared/setup/removal.hpp"
#include "fdem_shared/setup/stages.hpp"
#include "fdem_shared/setup/supports.hpp"
#include "fdem_shared/setup/weight.hpp"

namespace breccia::fdem {

using fdem_shared::begin_joints;
using fdem_shared::corners_of_bodies;
using fdem_shared::hold_anew;
using fdem_shared::hold_removed;
using fdem_shared::prescribe_supports;
using fdem_shared::refuse_endless;
using fdem_shared::removable_bodies;
using fdem_shared::set_up;
using fdem_shared::set_up_bodies;
using fdem_shared::set_up_bundles;
using fdem_shared::set_up_elements;
using fdem_shared::set_up_middles;
using fdem_shared::set_up_starts;
using fdem_shared::set_up_supports;
using fdem_shared::with_inertia;

namespace {

/// Joins neighbours: a joint, a bond, or nothing.
void set_up_joints(World& w, const Config& config, const Model& model) {
  BondTable table = bond_table(config);
  std::map<std::pair<Index, Index>, Index> discontinuities;  // law, open or bonded
  for (const Model::Discontinuity& d : model.discontinuities)
    discontinuities[std::minmax(d.edge[0], d.edge[1])] =
        d.material == Model::as_one ? BondTable::bonded
        : d.material < 0            ? BondTable::nothing
                                    : table.of_joint[static_cast<std::size_t>(d.material)];

  std::vector<EdgeJoints> edges(model.triangle.size(), {{edge_free, edge_free, edge_free}});
  std::vector<Index> edge_a, edge_b;
  std::vector<Index> law;
  std::vector<double> length, strength;
  std::vector<Vec2> lines;  // edges of sides a
  std::vector<Vec2> preset;
  Case& given = set_up(w);
  given.base_bond.resize(table.bonds.size());
  std::iota(given.base_bond.begin(), given.base_bond.end(), 0);
  given.open_vertex.assign(model.point.size(), 0);
  w.across.assign(3 * model.triangle.size(), -1);
  std::vector<std::uint8_t> tied(model.point.size(), 0);  // 1: corners here move as one
  std::vector<JointStage> stage;
  const auto slot = [&](Index edge) -> Index& { return edges[at(edge / 3)].at[edge % 3]; };
  const auto next = [](Index edge) { return 3 * (edge / 3) + (edge + 1) % 3; };
  for (const MeshEdge& e : mesh_edges(model)) {
    const auto open = [&](std::uint8_t bits) {
      given.open_vertex[at(e.low)] |= bits;
      given.open_vertex[at(e.high)] |= bits;
    };
    if (e.b < 0) {
      open(1);
      continue;
    }
    w.across[at(e.a)] = e.b;
    w.across[at(e.b)] = e.a;
    const auto a = at(e.a / 3), b = at(e.b / 3);
    const auto weak = discontinuities.find({e.low, e.high});
    const Index found =
        weak != discontinuities.end()
            ? weak->second
            : table.of_pair[static_cast<std::size_t>(model.material[a]) * config.materials.size() +
                            static_cast<std::size_t>(model.material[b])];
    if (found == BondTable::nothing) {
      if (weak != discontinuities.end())
        given.open_cracks.push_back({e.a,
                                     e.b,
                                     {w.vertex[at(e.a)], w.vertex[at(next(e.a))]},
                                     norm(model.point[at(e.high)] - model.point[at(e.low)]),
                                     0.0});
      open(3);
      continue;
    }
    if (found == BondTable::bonded) {
      slot(e.a) = slot(e.b) = edge_bonded;
      tied[at(e.low)] = tied[at(e.high)] = 1;
      continue;
    }
    const bool dormant = weak == discontinuities.end() &&
                         table.dormant[static_cast<std::size_t>(model.material[a])] &&
                         table.dormant[static_cast<std::size_t>(model.material[b])];
    stage.push_back(dormant ? JointStage::dormant : JointStage::whole);
    if (dormant) {
      tied[at(e.low)] = tied[at(e.high)] = 1;
      given.extrinsic = true;
    }
    const auto joint = static_cast<Index>(edge_a.size());
    slot(e.a) = 2 * joint;
    slot(e.b) = 2 * joint + 1;
    edge_a.push_back(e.a);
    edge_b.push_back(e.b);
    law.push_back(found);
    const Vec2 along =
        model.point[at(w.vertex[at(next(e.a))])] - model.point[at(w.vertex[at(e.a)])];
    length.push_back(norm(along));
    lines.push_back(along);
    const auto material = [&](std::size_t t) -> const MaterialConfig& {
      return config.materials[static_cast<std::size_t>(model.material[t])];
    };
    const auto of = [&](std::size_t t) {
      return material(t).bedding.share((1.0 / length.back()) * along);
    };
    const double bedded = weak == discontinuities.end() ? std::min(of(a), of(b)) : 1.0;
    const JointBond shared = table.bonds[static_cast<std::size_t>(found)];
    if (shared.by_rock() && depends_on_line(config, material(a), material(b))) {
      law.back() = static_cast<Index>(table.bonds.size());
      table.bonds.push_back(bond_along(config, material(a), material(b), shared, along));
      given.base_bond.push_back(found);
    }
    strength.push_back(bedded * std::min(static_cast<double>(model.strength[a]),
                                         static_cast<double>(model.strength[b])));
    preset.emplace_back();
    if (dormant || !config.in_situ.any()) continue;
    const Vec2 unit = (1.0 / length.back()) * along, across{-unit.y, unit.x};
    const Vec2 middle = 0.5 * (model.point[at(e.low)] + model.point[at(e.high)]);
    const Vec2 traction = config.in_situ.at(middle) * across;
    Vec2 opening;
    if (!preset_opening(table.bonds[static_cast<std::size_t>(found)], strength.back(),
                        length.back(), dot(traction, across), dot(traction, unit), opening))
      throw InputError(fdem_shared::too_weak_for_stress(
          "triangles " + std::to_string(a) + " and " + std::to_string(b), middle,
          dot(traction, across), std::abs(dot(traction, unit)),
          strength.back() * table.bonds[static_cast<std::size_t>(found)].tension));
    preset.back() = opening;
  }
  std::vector<JointEnds> ends;
  for (std::size_t i = 0; i < edge_a.size(); ++i)
    ends.push_back(JointEnds::of(edge_a[i], edge_b[i]));
  copy_to(w.joint_ends, ends);
  const auto count = static_cast<Index>(edge_a.size());
  Joints& j = w.joints;
  copy_to(given.bonds, table.bonds);
  copy_to(w.edges, edges);
  copy_to(j.edge_a, edge_a);
  copy_to(j.edge_b, edge_b);
  copy_to(j.law, law);
  copy_to(j.length, length);
  copy_to(j.strength, strength);
  if (given.extrinsic || config.in_situ.any()) copy_to(j.preset, preset);
  copy_to(j.stage, stage);
  begin_joints(j, count);
  with_number(w.exec.precision,
              [&](auto number) { j.force.as<decltype(number)>().resize(count + 1); });
  std::vector<double> area;
  for (const auto& corners : model.triangle) {
    const Vec2& from = model.point[at(corners[0])];
    area.push_back(0.5 *
                   cross(model.point[at(corners[1])] - from, model.point[at(corners[2])] - from));
  }
  const std::vector<Index> material(model.material.begin(), model.material.end());
  given.rocks = effective_rocks(
      config, {material, area, edge_a, edge_b, law, length, lines, stage, table.bonds});
  if (given.extrinsic) {
    w.stress.resize(w.triangles.size());
    w.overshoot.resize(count);
    w.reached.resize(1);
  }
  set_up_bundles(w, tied);
}

/// Records of numbers in single precision.
template <template <class> class Law>
void round_all(Buffer<Law<float>>& to, const Buffer<Law<double>>& from) {
  std::vector<Law<double>> laws;
  copy_to(laws, from);
  std::vector<Law<float>> rounded;
  for (const Law<double>& law : laws) rounded.push_back(in_floats(law));
  copy_to(to, rounded);
}
/// Laws as a run that computes in single precision reads them.
void round_laws(World& w) {
  if (w.exec.precision != Precision::single) return;
  Case& given = set_up(w);
  round_all(given.laws_in_single, given.laws);
  round_all(given.bonds_in_single, given.bonds);
}

}  // namespace

World::World(const Exec& how) : exec(how), lanes(widest_lanes()) {
  couples.history.precision = how.precision;
  place_arrays(*this);
}

void move_to(World& w, Space space) {
  move_world(w, space);
}

ShapeOfSetUp::AtStart ShapeOfSetUp::at_start(const TriangleNodes& nodes, double density,
                                             std::size_t number) {
  const Vec2& x = nodes.at[0].position;
  const Mat2 shape = columns(nodes.at[1].position - x, nodes.at[2].position - x);
  const double area = 0.5 * determinant(shape);
  if (!(area > 0.0))
    throw InputError("triangle " + std::to_string(number) +
                     ": its corners do not run counter-clockwise, or it has no area");
  return {inverse(shape), density * area / 3.0, std::sqrt(4.0 * area / std::sqrt(3.0))};
}

std::vector<Index> ShapeOfSetUp::prescribe(World& w, const Config& config) {
  std::vector<Hold> holds;
  std::vector<Index> hold(corners_of_bodies(w, config) / 3, -1);
  hold_removed(w, config, Hold{.fixed = 0x3f, .gone = 1}, holds, hold);
  prescribe_supports(w, config, holds, hold);
  return hold;
}

World make_world(const Config& asked, const Model& model, const Exec& exec) {
  const Config config = with_inertia(asked);
  if (model.size() == 0) throw InputError("the model holds no triangles");
  World w(exec);
  Case& given = set_up(w);
  given.time = config.time.evaluated_every(fdem_shared::usual_evaluation);
  given.gravity = config.gravity.value;
  given.in_situ = config.in_situ;
  given.plane_strain = config.plane == "strain";
  given.local_damping = config.local_damping;
  given.shown = config.output.more_fields();
  given.conservative = config.contact.conservative;
  given.emission = config.emission;
  given.rebound = Rebound::of(config.contact.restitution);
  given.materials = static_cast<Index>(config.materials.size());
  set_up_middles(w, model);
  copy_to(given.laws, elastic_laws(config, given));
  copy_to(given.contact_pairs, contact_table(config));
  given.removable = removable_bodies<World>(config, model);
  set_up_bodies(w, model);
  set_up_elements(w, config, model);
  set_up_joints(w, config, model);
  round_laws(w);
  set_up_supports(w, config, [&](const RegionConfig& region, const std::string& where) {
    return corners_in(model, region, where);
  });
  set_up_starts(w, config, model);
  set_up_loads(w, config, model);
  w.exposed.changed.resize(2);
  w.exposed.vertex.resize(static_cast<Index>(model.point.size()));
  const std::vector<PressedFace> faces = press_faces(w);
  find_couples(w);
  load_faces(w, faces);
  fdem_shared::add_mass_to_ruling(w);
  start_rigid_bodies(w, config);
  set_up(w).free_step = free_time_step(w);
  evaluate_forces(w);
  refuse_endless(w);
  for (std::string& doubt : doubts(w, config)) given.warnings.push_back(std::move(doubt));
  begin_ledger(w);
  return w;
}

void set_gravity(World& w, const Vec2& gravity) {
  set_up(w).gravity = gravity;
  w.graph.clear();
}

void configure(World& w, const Config& config) {
  Case& given = set_up(w);
  if (!config.gravity.is_table())
    given.gravity = (1.0 / config.time.mass_scaling) * config.gravity.value;
  given.local_damping = config.local_damping;
  given.rebound = Rebound::of(config.contact.restitution);
  copy_to(given.laws, elastic_laws(config, given));
  if (fdem_shared::changes_strengths(config)) {
    std::vector<JointBond> bonds;
    copy_to(bonds, given.bonds);
    copy_to(given.bonds, with_strengths(std::move(bonds), bond_table(config), given.base_bond));
  }
  round_laws(w);
  std::vector<ContactPair> pairs = contact_table(config);
  const double friction = config.stage_friction;
  if (friction >= 0.0)
    for (ContactPair& pair : pairs) pair.friction = friction;
  copy_to(given.contact_pairs, pairs);
  hold_anew(w, config);
  prescribe_loads(w, config);
  w.amplitudes.clear();  // listed anew by the next launches
  w.clock.clear();
  w.graph.clear();
}

void derive(World& w) {
  derive_couples(w);
  derive_bundles(w);
  w.graph.clear();
}

}  // namespace breccia::fdem
