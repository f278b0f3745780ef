// From a model to a world: split corners, joints, bundles, supports, loads, first forces.

#include <algorithm>
#include <cmath>
#include <map>

#include "core/world_space.hpp"
#include "exec/error.hpp"
#include "exec/filling.hpp"
#include "fdem3/observe.hpp"
#include "fdem3/setup/flatness.hpp"
#include "fdem3/setup/loads.hpp"
#include "fdem3/setup/materials.hpp"
#include "fdem3/setup/mesh_faces.hpp"
#include "fdem3/setup/regions.hpp"
#include "fdem3/shape.hpp"
#include "fdem_shared/setup/elements.hpp"
#include "fdem_shared/setup/empty_probes.hpp"
#include "fdem_shared/setup/heavier.hpp"
#include "fdem_shared/setup/removal.hpp"
#include "fdem_shared/setup/stages.hpp"
#include "fdem_shared/setup/supports.hpp"
#include "fdem_shared/setup/weight.hpp"

namespace breccia::fdem3 {

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

void corners_of(const Model& model, std::size_t t, Vec3 (&x)[4]) {
  for (std::size_t k = 0; k < 4; ++k) x[k] = model.point[at(model.tetrahedron[t][k])];
}
double volume_of(const Model& model, std::size_t t) {
  Vec3 x[4];
  corners_of(model, t, x);
  return dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0])) / 6.0;
}

/// Joints that are being collected: who is joined, then what is measured of each.
struct JointList {
  std::vector<Index> face_a, face_b, law;
  std::vector<JointStage> stage;
  std::vector<std::uint8_t> turn;
  std::vector<FaceShape> shape;
  std::vector<double> length, strength;
  std::vector<Vec3> preset;
};

/// The place in a's list of corners of what lies at the first corner of b's.
std::uint8_t turn_between(const Model& model, Index a, Index b) {
  const auto vertex = [&](Index face, int place) {
    return model.tetrahedron[at(face / 4)][at(corner_of_face(face % 4, place))];
  };
  for (int place = 0; place < 3; ++place)
    if (vertex(a, place) == vertex(b, 0) && vertex(a, (place + 2) % 3) == vertex(b, 1))
      return static_cast<std::uint8_t>(place);
  throw InputError("tetrahedra " + std::to_string(a / 4) + " and " + std::to_string(b / 4) +
                   " lie on the same side of their common face");
}

/// Opening and slip at which a joint carries the stress at the start.
Vec3 preset_of(const Config& config, const JointBond& bond, double strength, double h,
               const Vec3 (&corner)[3], Index a, Index b) {
  const Vec3 middle = (1.0 / 3.0) * (corner[0] + corner[1] + corner[2]);
  const Sym3 stress = config.in_situ.at(middle);
  const JointOpening o = opening_of(corner, corner);
  const Vec3 traction = stress * o.normal, across = cross(o.normal, o.along);
  Vec3 opening;
  if (!preset_opening(bond, strength, h,
                      {dot(traction, o.normal), dot(traction, o.along), dot(traction, across)},
                      opening))
    throw InputError(fdem_shared::too_weak_for_stress(
        "tetrahedra " + std::to_string(a) + " and " + std::to_string(b), middle,
        dot(traction, o.normal), norm(traction - dot(traction, o.normal) * o.normal),
        strength * bond.tension));
  return opening;
}

/// Joins neighbours: a joint, a bond, or nothing.
class Joining {
 public:
  Joining(World& w, const Config& config, const Model& model)
      : w_(w),
        config_(config),
        model_(model),
        table_(fdem::bond_table(shared_keys(config))),
        faces_(model.tetrahedron.size(), {{face_free, face_free, face_free, face_free}}),
        tied_(model.point.size(), 0) {
    for (const Model::Discontinuity& d : model.discontinuities)
      weak_[d.face] = d.material < 0 ? fdem::BondTable::nothing
                                     : table_.of_joint[static_cast<std::size_t>(d.material)];
    set_up(w).open_vertex.assign(model.point.size(), 0);
    const std::size_t joints = w.across.size() / 2;
    list_.face_a.reserve(joints);
    list_.face_b.reserve(joints);
    list_.law.reserve(joints);
    list_.stage.reserve(joints);
    each_face(model, w.across, [this](const MeshFace& f) { add(f); });
    measure();
  }

  void store() {
    Joints& j = w_.joints;
    const int threads = w_.exec.threads;
    const auto count = static_cast<Index>(list_.face_a.size());
    copy_to(set_up(w_).bonds, table_.bonds);
    std::vector<std::uint8_t> exposed;
    exposed.reserve(faces_.size());
    for (const FaceJoints& f : faces_) {
      unsigned bits = 0;
      for (unsigned k = 0; k < 4; ++k)
        if (f.at[k] == face_free) bits |= 1U << k;
      exposed.push_back(static_cast<std::uint8_t>(bits));
    }
    copy_to(w_.tetrahedra.exposed, exposed);
    hand_over(w_.faces, faces_, threads);
    hand_over(j.face_a, list_.face_a, threads);
    hand_over(j.face_b, list_.face_b, threads);
    hand_over(j.turn, list_.turn, threads);
    hand_over(j.law, list_.law, threads);
    hand_over(j.shape, list_.shape, threads);
    hand_over(j.length, list_.length, threads);
    hand_over(j.strength, list_.strength, threads);
    if (config_.in_situ.any())
      hand_over(j.preset, list_.preset, threads);
    else if (w_.given->extrinsic)
      j.preset.resize(count);
    hand_over(j.stage, list_.stage, threads);
    j.force.resize(count);
    begin_joints(j, count);
    if (w_.given->extrinsic) {
      w_.stress.resize(w_.tetrahedra.size());
      w_.overshoot.resize(count);
      w_.reached.resize(1);
    }
    set_up_bundles(w_, tied_);
  }

 private:
  void add(const MeshFace& f) {
    if (f.b < 0) return open(f, 1);
    const auto a = at(f.a / 4), b = at(f.b / 4);
    const auto weak = weak_.find(f.corners);
    const Index found =
        weak != weak_.end()
            ? weak->second
            : table_
                  .of_pair[static_cast<std::size_t>(model_.material[a]) * config_.materials.size() +
                           static_cast<std::size_t>(model_.material[b])];
    if (found == fdem::BondTable::nothing) {
      if (weak != weak_.end()) set_up(w_).open_cracks.push_back(open_crack(f));
      return open(f, 3);
    }
    if (found == fdem::BondTable::bonded) {
      slot(f.a) = slot(f.b) = face_bonded;
      for (const Index vertex : f.corners) tied_[at(vertex)] = 1;
      return;
    }
    join(f, found);
  }
  /// A crack that is open from the start.
  fdem_shared::FaceCrack open_crack(const MeshFace& f) const {
    Index v[3];
    for (int k = 0; k < 3; ++k)
      v[k] = model_.tetrahedron[at(f.b / 4)][at(corner_of_face(f.b % 4, k))];
    fdem_shared::FaceCrack crack{.a = f.a, .b = f.b, .turn = turn_between(model_, f.a, f.b)};
    for (int k = 0; k < 3; ++k) {
      const Index p = v[k], q = v[(k + 1) % 3];
      crack.port[k] = fdem_shared::port_between(p, q);
      crack.edge[k] = norm(model_.point[at(q)] - model_.point[at(p)]);
    }
    crack.length = (volume_of(model_, at(f.a / 4)) + volume_of(model_, at(f.b / 4))) / crack.area();
    return crack;
  }
  void open(const MeshFace& f, std::uint8_t bits) {
    for (const Index vertex : f.corners) set_up(w_).open_vertex[at(vertex)] |= bits;
  }
  void join(const MeshFace& f, Index law) {
    const auto joint = static_cast<Index>(list_.face_a.size());
    slot(f.a) = 2 * joint;
    slot(f.b) = 2 * joint + 1;
    const bool dormant = is_within(f.corners) && sleeps(f.a) && sleeps(f.b);
    if (dormant) {
      for (const Index vertex : f.corners) tied_[at(vertex)] = 1;
      set_up(w_).extrinsic = true;
    }
    list_.face_a.push_back(f.a);
    list_.face_b.push_back(f.b);
    list_.law.push_back(law);
    list_.stage.push_back(dormant ? JointStage::dormant : JointStage::whole);
  }
  bool sleeps(Index face) const {
    return table_.dormant[static_cast<std::size_t>(model_.material[at(face / 4)])];
  }
  /// No discontinuity, which is there from the start.
  bool is_within(const std::array<Index, 3>& corners) const { return !weak_.contains(corners); }

  /// Lengths, shapes and strengths of joints at the start, by their faces.
  void measure() {
    const std::size_t count = list_.face_a.size();
    list_.turn.resize(count);
    list_.shape.resize(count);
    list_.length.resize(count);
    list_.strength.resize(count);
    if (config_.in_situ.any()) list_.preset.resize(count);
    each_portion(w_.exec.threads, static_cast<Index>(count), [this](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) measure(at(i));
    });
  }
  void measure(std::size_t i) {
    const Index face_a = list_.face_a[i], face_b = list_.face_b[i];
    const auto a = at(face_a / 4), b = at(face_b / 4);
    Vec3 corner[3];
    for (int k = 0; k < 3; ++k)
      corner[k] = model_.point[at(model_.tetrahedron[b][at(corner_of_face(face_b % 4, k))])];
    const FaceShape shape = FaceShape::of(corner[0], corner[1], corner[2]);
    const double h = (volume_of(model_, a) + volume_of(model_, b)) / shape.area();
    const Vec3 across = cross(corner[1] - corner[0], corner[2] - corner[0]);
    const auto bedded = [&](std::size_t t) {
      return config_.materials[static_cast<std::size_t>(model_.material[t])].bedding.share(
          (1.0 / norm(across)) * across);
    };
    const bool within = is_within(vertices_of(model_, face_a));
    const double planes = within ? std::min(bedded(a), bedded(b)) : 1.0;
    const double strength = planes * std::min(static_cast<double>(model_.strength[a]),
                                              static_cast<double>(model_.strength[b]));
    list_.turn[i] = turn_between(model_, face_a, face_b);
    list_.shape[i] = shape;
    list_.length[i] = h;
    list_.strength[i] = strength;
    if (config_.in_situ.any() && list_.stage[i] != JointStage::dormant)
      list_.preset[i] = preset_of(config_, table_.bonds[static_cast<std::size_t>(list_.law[i])],
                                  strength, h, corner, face_a / 4, face_b / 4);
  }
  Index& slot(Index face) { return faces_[at(face / 4)].at[face % 4]; }

  World& w_;
  const Config& config_;
  const Model& model_;
  fdem::BondTable table_;
  std::map<std::array<Index, 3>, Index> weak_;  ///< law, or nothing where open
  std::vector<FaceJoints> faces_;
  std::vector<std::uint8_t> tied_;  ///< 1: corners here move as one
  JointList list_;
};

/// h_c of each material: mean of 2 V/A over the faces of its border, or over all of its faces.  [m]
std::vector<double> contact_lengths(const Config& config, const Model& model,
                                    const std::vector<Index>& sides) {
  const std::size_t n = config.materials.size();
  std::vector<double> at_border(n, 0.0), borders(n, 0.0), any(n, 0.0), count(n, 0.0);
  each_face(model, sides, [&](const MeshFace& f) {
    for (const Index face : {f.a, f.b}) {
      if (face < 0) continue;
      const auto t = at(face / 4);
      const auto m = static_cast<std::size_t>(model.material[t]);
      Vec3 x[3];
      for (int k = 0; k < 3; ++k)
        x[k] = model.point[at(model.tetrahedron[t][at(corner_of_face(face % 4, k))])];
      const double h = 2.0 * volume_of(model, t) / FaceShape::of(x[0], x[1], x[2]).area();
      any[m] += h;
      count[m] += 1.0;
      if (f.b >= 0) continue;
      at_border[m] += h;
      borders[m] += 1.0;
    }
  });
  std::vector<double> lengths;
  for (std::size_t m = 0; m < n; ++m)
    lengths.push_back(borders[m] > 0.0 ? at_border[m] / borders[m]
                      : count[m] > 0.0 ? any[m] / count[m]
                                       : 1.0);
  return lengths;
}

}  // namespace

World::World(const Exec& how) : exec(how), lanes(widest_lanes()) {
  place_arrays(*this);
}

void move_to(World& w, Space space) {
  move_world(w, space);
}

ShapeOfSetUp::AtStart ShapeOfSetUp::at_start(const TetrahedronNodes& nodes, double density,
                                             std::size_t number) {
  Vec3 x[4];
  places(nodes, x);
  const double volume = dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0])) / 6.0;
  if (!(volume > 0.0))
    throw InputError("tetrahedron " + std::to_string(number) +
                     ": it is turned inside out, or has no volume");
  return {shape_gradients(x), 0.25 * density * volume, std::cbrt(6.0 * std::sqrt(2.0) * volume)};
}

std::vector<Index> ShapeOfSetUp::prescribe(World& w, const Config& config) {
  std::vector<Hold> holds;
  std::vector<Index> hold(corners_of_bodies(w, config) / 4, -1);
  hold_removed(w, config, Hold{.fixed = 0xfff, .gone = 1}, holds, hold);
  prescribe_supports(w, config, holds, hold);
  return hold;
}

World make_world(const Config& asked, const Model& model, const Exec& exec) {
  const Config config = with_inertia(asked);
  if (model.size() == 0) throw InputError("the model holds no tetrahedra");
  World w(exec);
  const FillingThreads filling(exec.threads);
  Case& given = set_up(w);
  given.time = config.time.evaluated_every(fdem_shared::usual_evaluation);
  given.gravity = config.gravity.value;
  given.in_situ = config.in_situ;
  given.local_damping = config.local_damping;
  given.shown = config.output.more_fields();
  given.emission = config.emission;
  given.materials = static_cast<Index>(config.materials.size());
  w.across = sides_across(model, exec.threads);
  given.contact_lengths = contact_lengths(config, model, w.across);
  given.rocks = effective_rocks(config);
  given.bedded = has_bedded_rock(config);
  set_up_middles(w, model);
  copy_to(given.laws, elastic_laws(config, given));
  copy_to(given.contact_pairs, contact_table(config, given.contact_lengths));
  given.removable = removable_bodies<World>(config, model);
  set_up_bodies(w, model);
  set_up_elements(w, config, model);
  Joining(w, config, model).store();
  set_up_supports(w, config, [&](const RegionConfig& region, const std::string& where) {
    return corners_in(model, region, where);
  });
  set_up_starts(w, config, model);
  set_up_loads(w, config, model);
  w.exposed.changed.resize(2);
  w.exposed.vertex.resize(static_cast<Index>(model.point.size()));
  find_couples(w);
  fdem_shared::add_mass_to_ruling(w);
  start_rigid_bodies(w, config);
  set_up(w).free_step = free_time_step(w);
  evaluate_forces(w);
  refuse_endless(w);
  fdem_shared::look_for_unbalanced_weight(
      config,
      "xx_slope[0] + xy_slope[1] + xz_slope[2], xy_slope[0] + yy_slope[1] + yz_slope[2] and "
      "xz_slope[0] + yz_slope[1] + zz_slope[2]",
      given.warnings);
  fdem_shared::look_for_empty_probes(w, config, given.warnings);
  if (auto flat = flat_tetrahedron(model)) given.warnings.push_back(std::move(*flat));
  begin_ledger(w);
  return w;
}

void set_gravity(World& w, const Vec3& gravity) {
  set_up(w).gravity = gravity;
  w.graph.clear();
}

void configure(World& w, const Config& config) {
  Case& given = set_up(w);
  if (!config.gravity.is_table())
    given.gravity = (1.0 / config.time.mass_scaling) * config.gravity.value;
  given.local_damping = config.local_damping;
  copy_to(given.laws, elastic_laws(config, given));
  if (fdem_shared::changes_strengths(config)) {
    std::vector<JointBond> bonds;
    copy_to(bonds, given.bonds);
    copy_to(given.bonds,
            fdem::with_strengths(std::move(bonds), fdem::bond_table(shared_keys(config)), {}));
  }
  copy_to(given.contact_pairs, contact_table(config, given.contact_lengths));
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

}  // namespace breccia::fdem3
