// From a model to a world: split corners, joints, bundles, supports, loads, first forces.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>

#include "core/set_up.hpp"
#include "core/world_space.hpp"
#include "exec/error.hpp"
#include "fdem/observe.hpp"
#include "fdem/setup/loads.hpp"
#include "fdem/setup/materials.hpp"
#include "fdem/setup/mesh_edges.hpp"
#include "fdem/setup/pressed_faces.hpp"
#include "fdem/setup/regions.hpp"
#include "fdem/setup/removal.hpp"
#include "fdem/setup/starts.hpp"
#include "fdem/setup/warnings.hpp"
#include "fdem/world.hpp"

namespace breccia::fdem {
namespace {

Case& set_up(World& w) {
  return w.given.change(SetUp{});
}

void set_up_triangles(World& w, const Config& config, const Model& model) {
  std::vector<GlobalId> id(model.triangle.size());
  std::iota(id.begin(), id.end(), 0);
  std::vector<TriangleNodes> nodes;
  std::vector<Mat2> shape_inverse;
  std::vector<double> mass, viscosity;
  double edges = 0.0;
  for (std::size_t t = 0; t < model.triangle.size(); ++t) {
    Vec2 x[3];
    TriangleNodes corners;
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = model.point[at(model.triangle[t][k])];
      corners.at[k] = {x[k], model.velocity[t]};
      w.vertex.push_back(model.triangle[t][k]);
    }
    const Mat2 shape = columns(x[1] - x[0], x[2] - x[0]);
    const double area = 0.5 * determinant(shape);
    if (!(area > 0.0))
      throw InputError("triangle " + std::to_string(t) +
                       ": its corners do not run counter-clockwise, or it has no area");
    const MaterialConfig& m = config.materials[static_cast<std::size_t>(model.material[t])];
    nodes.push_back(corners);
    shape_inverse.push_back(inverse(shape));
    mass.push_back(m.density * area / 3.0);
    const double edge = std::sqrt(4.0 * area / std::sqrt(3.0));  // of the equilateral one as large
    edges += edge;
    viscosity.push_back(m.damping * 2.0 * edge * std::sqrt(m.young * m.density));
  }
  Case& given = set_up(w);
  given.mean_edge = edges / static_cast<double>(model.triangle.size());
  given.skin = config.search.margin * given.mean_edge;
  Triangles& triangles = w.triangles;
  copy_to(triangles.id, id);
  copy_to(triangles.group, model.group);
  copy_to(triangles.material, std::vector<Index>(model.material.begin(), model.material.end()));
  copy_to(triangles.nodes, nodes);
  copy_to(triangles.shape_inverse, shape_inverse);
  copy_to(triangles.mass, mass);
  copy_to(triangles.viscosity, viscosity);
  triangles.force.resize(model.size());
  triangles.viscous_work.resize(model.size());
  triangles.damping_work.resize(model.size());
  triangles.load_work.resize(model.size());
}

/// Materials and middles of triangles, for their laws where the stress in situ has a slope.
void set_up_middles(Case& given, const Model& model) {
  if (!given.in_situ.graded()) return;
  given.materials_of.assign(model.material.begin(), model.material.end());
  for (const auto& corners : model.triangle) {
    Vec2 sum{};
    for (const Index corner : corners) sum += model.point[at(corner)];
    given.middles.push_back((1.0 / 3.0) * sum);
  }
}

/// Vertices with several corners, some of which move as one, at least at the start.
void set_up_bundles(World& w, const std::vector<std::uint8_t>& tied) {
  std::vector<std::vector<Index>> corners(tied.size());
  for (Index n = 0; n < 3 * w.triangles.size(); ++n)
    if (tied[at(w.vertex[at(n)])] != 0) corners[at(w.vertex[at(n)])].push_back(n);
  std::vector<Index> starts{0}, nodes;
  for (const std::vector<Index>& ring : corners) {
    if (ring.empty()) continue;
    nodes.insert(nodes.end(), ring.begin(), ring.end());
    starts.push_back(static_cast<Index>(nodes.size()));
  }
  if (nodes.empty()) return;
  copy_to(w.bundles.starts, starts);
  copy_to(w.bundles.nodes, nodes);
  derive_bundles(w);
}

/// Joins neighbours: a joint, a bond, or nothing.
void set_up_joints(World& w, const Config& config, const Model& model) {
  BondTable table = bond_table(config);
  std::map<std::pair<Index, Index>, std::int16_t> discontinuities;  // law, or -1 where open
  for (const Model::Discontinuity& d : model.discontinuities)
    discontinuities[std::minmax(d.edge[0], d.edge[1])] =
        d.material < 0 ? BondTable::nothing : table.of_joint[static_cast<std::size_t>(d.material)];

  std::vector<EdgeJoints> edges(model.triangle.size(), {{edge_free, edge_free, edge_free}});
  std::vector<Index> edge_a, edge_b;
  std::vector<Index> law;
  std::vector<double> length, strength;
  std::vector<Vec2> preset;
  Case& given = set_up(w);
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
    const std::int16_t found =
        weak != discontinuities.end()
            ? weak->second
            : table.of_pair[static_cast<std::size_t>(model.material[a]) * config.materials.size() +
                            static_cast<std::size_t>(model.material[b])];
    if (found == BondTable::nothing) {
      if (weak != discontinuities.end())
        given.open_cracks.push_back({e.a, e.b, w.vertex[at(e.a)], w.vertex[at(next(e.a))],
                                     norm(model.point[at(e.high)] - model.point[at(e.low)]), 0.0});
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
      throw InputError("in_situ: the joint between triangles " + std::to_string(a) + " and " +
                       std::to_string(b) + " is too weak for this stress");
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
  copy_to(j.broke_at, std::vector<double>(edge_a.size(), -1.0));
  copy_to(j.stage, stage);
  j.points.resize(count);
  with_number(w.exec.precision,
              [&](auto number) { j.force.as<decltype(number)>().resize(count + 1); });
  j.work.resize(count);
  j.pressing.resize(count);
  j.shear_at_break.resize(count);
  j.inherited_work.resize(count);
  std::vector<double> area;
  for (const auto& corners : model.triangle) {
    const Vec2& from = model.point[at(corners[0])];
    area.push_back(0.5 *
                   cross(model.point[at(corners[1])] - from, model.point[at(corners[2])] - from));
  }
  const std::vector<Index> material(model.material.begin(), model.material.end());
  given.rocks =
      effective_rocks(config, {material, area, edge_a, edge_b, law, length, stage, table.bonds});
  if (given.extrinsic) {
    w.stress.resize(w.triangles.size());
    w.overshoot.resize(count);
    w.reached.resize(1);
  }
  set_up_bundles(w, tied);
}

/// Held nodes start with the motion of their support: no jump of velocity at the start does work.
void start_held(World& w, const std::vector<Hold>& holds, const std::vector<Index>& hold) {
  std::vector<TriangleNodes> nodes;
  copy_to(nodes, w.triangles.nodes);
  for (std::size_t t = 0; t < hold.size(); ++t) {
    if (hold[t] < 0) continue;
    const Hold& h = holds[at(hold[t])];
    for (int k = 0; k < 3; ++k) {
      Vec2 given;
      if (h.motion[k] >= 0) {
        const PrescribedMotion& p = w.prescribed[at(h.motion[k])];
        given = p.at(0.0);
      }
      Vec2& velocity = nodes[t].at[k].velocity;
      if ((h.fixed >> (2 * k) & 1) != 0) velocity.x = given.x;
      if ((h.fixed >> (2 * k + 1) & 1) != 0) velocity.y = given.y;
    }
  }
  copy_to(w.triangles.nodes, nodes);
}

/// Supports: each corner follows the sum of those that hold it, each in its own directions.
/// Returns the place in World::holds of each triangle of the whole mesh, -1: it is free.
std::vector<Index> prescribe_supports(World& w, const Config& config) {
  const std::size_t bodies = w.given->sets.size() - config.supports.size();
  std::size_t corners = 0;
  for (std::size_t b = 0; b < bodies; ++b) corners += w.given->sets[b].nodes.size();
  std::vector<Hold> holds;
  std::vector<Index> hold(corners / 3, -1);
  Case& given = set_up(w);
  given.removed = removed_bodies(config, given.groups);
  for (std::size_t b = 0; b < bodies; ++b) {
    if (given.removed[b] == 0) continue;
    if (holds.empty()) holds.push_back({.fixed = 0x3f, .gone = 1});
    for (const Index n : given.sets[b].nodes) hold[at(n / 3)] = 0;
  }
  w.prescribed.clear();
  w.servo_motions.clear();
  for (std::size_t s = 0; s < config.supports.size(); ++s) {
    const SupportConfig& support = config.supports[s];
    const std::string where = "support." + support.name;
    int bits = 0;
    for (const std::string& direction : support.fix) {
      bits |= direction == "x" ? 1 : 2;
    }
    const Vec2 whole = scale_of(support.velocity);
    const Vec2 velocity{(bits & 1) != 0 ? whole.x : 0.0, (bits & 2) != 0 ? whole.y : 0.0};
    std::int16_t motion = -1;
    if (velocity.x != 0.0 || velocity.y != 0.0 || (support.servo.is_on() && bits != 0)) {
      motion = static_cast<std::int16_t>(w.prescribed.size());
      if (support.servo.is_on())
        w.servo_motions.push_back({s, motion, support.servo.axis_number()});
      w.prescribed.push_back({velocity, amplitude(support.velocity, 0, support.history),
                              amplitude(support.velocity, 1, support.history)});
    }
    if (bits == 0) continue;  // it lets go
    for (const Index n : w.given->sets[bodies + s].nodes) {
      Index& own = hold[at(n / 3)];
      if (own >= 0 && holds[at(own)].gone != 0) continue;
      if (own < 0) {
        own = static_cast<Index>(holds.size());
        holds.emplace_back();
      }
      Hold& h = holds[at(own)];
      const int corner = n % 3;
      if ((h.fixed >> (2 * corner) & bits) != 0)
        throw InputError(where + ": prescribes a direction of triangle " + std::to_string(n / 3) +
                         " that another support prescribes, too");
      if (motion >= 0 && h.motion[corner] >= 0)
        throw InputError(where + ": triangle " + std::to_string(n / 3) +
                         " has a corner that another support moves, too");
      h.fixed = static_cast<std::uint8_t>(h.fixed | bits << (2 * corner));
      if (motion >= 0) h.motion[corner] = motion;
    }
  }
  copy_to(given.holds, holds);
  w.motions.resize(static_cast<Index>(w.prescribed.size()));
  return hold;
}

void set_up_supports(World& w, const Config& config, const Model& model) {
  for (const SupportConfig& support : config.supports)
    set_up(w).sets.push_back(
        {support.name, corners_in(model, support.region, "support." + support.name)});
  w.sets_here.resize(w.given->sets.size());
  const std::vector<Index> hold = prescribe_supports(w, config);
  copy_to(w.triangles.hold, hold);
  std::vector<Hold> holds;
  copy_to(holds, w.given->holds);
  start_held(w, holds, hold);
}

void set_up_bodies(World& w, const Config& config, const Model& model) {
  Case& given = set_up(w);
  given.groups = model.groups;
  given.removable = removable_bodies(config, model);
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    NodeSet set{model.groups[g], {}};
    for (Index t = 0; t < model.size(); ++t)
      if (static_cast<std::size_t>(model.group[at(t)]) == g)
        for (Index k = 0; k < 3; ++k) set.nodes.push_back(3 * t + k);
    given.sets.push_back(std::move(set));
  }
}

/// No machine takes more steps than this, and time, a sum of them, would stop.
void refuse_endless(const World& w) {
  constexpr double most = 1e15;
  const RuledStep least = ruled_step(w, true);
  const double dt = std::min(w.next_dt, w.given->time.safety * least.step);
  if (dt * most > w.given->time.end) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "the stable time step is %.3g s, ruled by %s: time.end = %.3g s is more than 1e15 "
                "steps away; see the densities, moduli and stiffnesses of the materials",
                dt, least.term, w.given->time.end);
  throw InputError(text);
}

}  // namespace

World::World(const Exec& how) : exec(how), lanes(widest_lanes()) {
  couples.history.precision = how.precision;
  place_arrays(*this);
}

void move_to(World& w, Space space) {
  move_world(w, space);
}

namespace {

/// More inertia under the weight that bodies have: time.mass_scaling.
Config with_inertia(Config config) {
  const double scale = config.time.mass_scaling;
  for (MaterialConfig& material : config.materials) material.density *= scale;
  config.gravity = (1.0 / scale) * config.gravity;
  return config;
}

}  // namespace

World make_world(const Config& asked, const Model& model, const Exec& exec) {
  const Config config = with_inertia(asked);
  if (model.size() == 0) throw InputError("the model holds no triangles");
  World w(exec);
  Case& given = set_up(w);
  given.time = config.time;
  given.gravity = config.gravity;
  given.in_situ = config.in_situ;
  given.plane_strain = config.plane == "strain";
  given.local_damping = config.local_damping;
  given.shown = config.output.more_fields();
  given.conservative = config.contact.conservative;
  given.emission = config.emission;
  given.rebound = Rebound::of(config.contact.restitution);
  given.materials = static_cast<Index>(config.materials.size());
  set_up_middles(given, model);
  copy_to(given.laws, elastic_laws(config, given));
  copy_to(given.contact_pairs, contact_table(config));
  set_up_bodies(w, config, model);
  set_up_triangles(w, config, model);
  set_up_joints(w, config, model);
  set_up_supports(w, config, model);
  set_up_starts(set_up(w), config, model);
  set_up_loads(w, config, model);
  w.exposed.changed.resize(2);
  w.exposed.vertex.resize(static_cast<Index>(model.point.size()));
  const std::vector<PressedFace> faces = press_faces(w);
  find_couples(w);
  load_faces(w, faces);
  evaluate_forces(w);
  refuse_endless(w);
  for (std::string& doubt : doubts(w, config)) given.warnings.push_back(std::move(doubt));
  begin_ledger(w);
  return w;
}

void set_gravity(World& w, const Vec2& gravity) {
  set_up(w).gravity = gravity;
}

void configure(World& w, const Config& config) {
  Case& given = set_up(w);
  given.gravity = (1.0 / config.time.mass_scaling) * config.gravity;
  given.local_damping = config.local_damping;
  copy_to(given.laws, elastic_laws(config, given));
  std::vector<ContactPair> pairs = contact_table(config);
  const double friction = config.stage_friction;
  if (friction >= 0.0)
    for (ContactPair& pair : pairs) pair.friction = friction;
  copy_to(given.contact_pairs, pairs);
  const std::vector<Index> hold = prescribe_supports(w, config);
  std::vector<Index> ids, own;
  copy_to(ids, w.triangles.id);
  for (const Index id : ids) own.push_back(hold[at(id)]);
  copy_to(w.triangles.hold, own);
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
