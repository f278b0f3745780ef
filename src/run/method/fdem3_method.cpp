#include "run/method/fdem3_method.hpp"

#include "exec/error.hpp"
#include "fdem3/emission.hpp"
#include "fdem3/fluid/fluid.hpp"
#include "fdem3/observe.hpp"
#include "fdem3/ranks.hpp"
#include "fdem3/servos.hpp"
#include "fdem3/setup/stages.hpp"
#include "run/method/bolts.hpp"
#include "run/method/emission_table.hpp"
#include "run/method/mesh_sim.hpp"

namespace breccia {
namespace {

struct Fdem3Sim : MeshSim<fdem3::World, fdem3::Config> {
  std::vector<Vec3> points;  ///< vertices at the start  [m]

  Fdem3Sim(const fdem3::Model& model, const World&) : points(model.point) {}

  /// A joint of the whole mesh at the start.
  /// @param face  its face on side b
  fdem3::JointPlace place_at_start(const World& whole, Index face) const {
    Vec3 x[3];
    for (int k = 0; k < 3; ++k)
      x[k] = points[at(whole.vertex[at(4 * (face / 4) + fdem3::corner_of_face(face % 4, k))])];
    return fdem3::place_of(x);
  }
  std::vector<EmissionEvent> emission(const World& whole) const {
    return fdem3::emission(whole, [&](Index face) { return place_at_start(whole, face); });
  }

  static FramePart frame(World& w, const World* mesh) { return fdem3_frame(w, mesh); }

  void add_findings(const World& w, std::vector<Fact>& facts, const SpentOnCracks& spent) const {
    add_cracks(w, facts, spent);
    add_fluids(w, facts);
    add_bolt_findings(w, facts);
    add_emission(facts, emission(w));
    std::vector<double> mass;
    for (const fdem3::Piece& piece : fdem3::fragments(w).pieces) mass.push_back(piece.mass);
    add_fragments(mass, facts);
  }

  std::vector<Table> tables(const World& w) const {
    Table cracks{
        "cracks",
        {"time", "x", "y", "z", "area", "mode", "energy", "x0", "y0", "z0", "nx0", "ny0", "nz0"},
        {"s", "m", "m", "m", "m2", "-", "J", "m", "m", "m", "-", "-", "-"},
        {}};
    const std::vector<fdem3::Crack> all_cracks = fdem3::cracks(w);
    std::vector<Index> face_b;
    if (!all_cracks.empty()) copy_to(face_b, w.joints.face_b);
    for (const fdem3::Crack& c : all_cracks) {
      const fdem3::JointPlace place = place_at_start(w, face_b[at(c.joint)]);
      const Vec3 &m = place.middle, &n = place.normal;
      cracks.rows.push_back({c.time, c.middle.x, c.middle.y, c.middle.z, c.area, c.mode, c.energy,
                             m.x, m.y, m.z, n.x, n.y, n.z});
    }
    Table pieces{"fragments",
                 {"fragment", "mass", "share", "volume", "x", "y", "z", "vx", "vy", "vz"},
                 {"-", "kg", "-", "m3", "m", "m", "m", "m/s", "m/s", "m/s"},
                 {}};
    const fdem3::Fragments all = fdem3::fragments(w);
    const double scaling = w.given->time.mass_scaling;
    double total = 0.0, number = 0.0;
    for (const fdem3::Piece& p : all.pieces) total += p.mass;
    for (const fdem3::Piece& p : all.pieces) {
      pieces.rows.push_back({number, p.mass / scaling, p.mass / total, p.volume, p.centre.x,
                             p.centre.y, p.centre.z, p.velocity.x, p.velocity.y, p.velocity.z});
      number += 1.0;
    }
    std::vector<Table> tables{cracks, pieces, table_of(emission(w))};
    add_bolt_table(w, tables);
    return tables;
  }

  static std::vector<std::string> constants() {
    return {"tetrahedra.id",   "tetrahedra.group",     "tetrahedra.material", "tetrahedra.shape",
            "tetrahedra.mass", "tetrahedra.viscosity", "joints.face_a",       "joints.face_b",
            "joints.turn",     "joints.law",           "joints.shape",        "joints.length",
            "joints.strength"};
  }
  template <class Visit>
  static void each_stored(World& w, const Visit& visit) {
    each_stored_array(w, visit, [&](const Visit& of) {
      of.fields("joint_force", Loose<fdem3::JointForce>{"force", w.joints.force});
    });
    each_stored_bolt(w, visit);
    each_stored_rigid(w, visit);
    each_stored_fluid(w, visit);
    each_stored_gas(w, visit);
  }
};

}  // namespace

std::unique_ptr<Method> make_method(const fdem3::Config& config, const fdem3::Model& model,
                                    const Exec& exec, Communicator* ranks) {
  return std::make_unique<SimMethod<Fdem3Sim>>(config, model, exec, ranks);
}
Fdem3Part fdem3_part(const fdem3::Config& config, const fdem3::Model& model, const Exec& exec,
                     Communicator* ranks) {
  auto method = std::make_unique<SimMethod<Fdem3Sim>>(config, model, exec, ranks);
  fdem3::World* const world = &method->world();
  return {std::move(method), world};
}

}  // namespace breccia
