#include "run/method/fdem3_method.hpp"

#include <algorithm>
#include <cstddef>

#include "exec/error.hpp"
#include "fdem3/observe.hpp"
#include "fdem3/ranks.hpp"
#include "fdem3/servos.hpp"
#include "fdem3/setup/stages.hpp"
#include "run/method/loose_array.hpp"
#include "run/method/sim_method.hpp"

namespace breccia {
namespace {

struct Fdem3Sim {
  using World = fdem3::World;
  using Config = fdem3::Config;
  std::vector<Vec3> middles, normals;  ///< of all joints at the start; on rank 0  [m], [-]

  Fdem3Sim(const fdem3::Model& model, const World& mesh) {
    std::vector<Index> faces;
    copy_to(faces, mesh.joints.face_b);
    for (const Index face : faces) {
      const auto& corners = model.tetrahedron[at(face / 4)];
      const auto point = [&](int k) {
        return model.point[at(corners[at(fdem3::corner_of_face(face % 4, k))])];
      };
      middles.push_back((1.0 / 3.0) * (point(0) + point(1) + point(2)));
      const Vec3 twice = cross(point(1) - point(0), point(2) - point(0));
      normals.push_back((1.0 / norm(twice)) * twice);
    }
  }

  static World made(const fdem3::Config& config, const fdem3::Model& model, const Exec& exec) {
    World w = fdem3::make_world(config, model, exec);
    fdem3::energies(w);
    for (const ProbeConfig& p : config.probes) fdem3::probe(w, p);  // refuses what cannot be read
    return w;
  }
  static std::size_t servos_of(const Config& config) { return servos_of_supports(config); }
  static std::vector<std::size_t> changed_servos(const Config& config, std::size_t stage) {
    return changed_supports(config, stage);
  }
  /// Corners that a stage sets free may need shorter steps than those it held.
  static void begun(World& part) {
    part.next_dt = std::min(part.next_dt, fdem3::choose_time_step(part));
  }
  static EnergyBalance balance(Ledger& ledger, const Energies& all, std::int64_t) {
    return fdem3::energies(ledger, all).balance;
  }
  static const char* step_rule(const World& w) { return fdem3::ruling_term(w); }
  static FramePart frame(World& w, const World* mesh) { return fdem3_frame(w, mesh); }

  static void add_model(const World& w, std::vector<Fact>& facts) {
    const auto add = [&](const std::string& path, double value) { facts.push_back({path, value}); };
    add("model.tetrahedra", w.tetrahedra.size());
    for (std::size_t g = 0; g < w.given->groups.size(); ++g)
      add("model.tetrahedra_by_group." + w.given->groups[g],
          static_cast<double>(w.given->sets[g].nodes.size() / 4));
    add("model.joints", w.joints.size());
    for (const fdem3::EffectiveRock& rock : w.given->rocks) {
      const std::string path = "model.rock." + rock.material + ".";
      add(path + "young", rock.young);
      add(path + "poisson", rock.poisson);
      add(path + "wave_speed", rock.fast);
      add(path + "shear_wave_speed", rock.slow);
    }
    add("model.nodes", 4 * w.tetrahedra.size());
    add("searches", static_cast<double>(w.searches));
    add("contacts.candidates", w.couples.size());
  }
  static void add_findings(const World& w, std::vector<Fact>& facts) {
    const auto add = [&](const std::string& path, double value) { facts.push_back({path, value}); };
    const std::vector<fdem3::Crack> cracks = fdem3::cracks(w);
    double area = 0.0, sliding = 0.0;
    for (const fdem3::Crack& c : cracks) {
      area += c.area;
      sliding += c.mode > 0.5 ? 1.0 : 0.0;
    }
    const auto count = static_cast<double>(cracks.size());
    add("fracture.broken_joints", count);
    add("fracture.broken_area", area);
    add("fracture.first_break", cracks.empty() ? -1.0 : cracks.front().time);
    add("fracture.broken_by_mode.opening", count - sliding);
    add("fracture.broken_by_mode.sliding", sliding);
    const EnergySplit split = fdem3::energy_split(w);
    add("fracture.energy_by_mode.opening", split.fracture_open);
    add("fracture.energy_by_mode.sliding", split.fracture_slide);
    const fdem3::Fragments all = fdem3::fragments(w);
    double total = 0.0;
    for (const fdem3::Piece& piece : all.pieces) total += piece.mass;
    add("fracture.fragments", static_cast<double>(all.pieces.size()));
    add("fracture.largest_fragment_fraction", all.pieces.front().mass / total);
  }

  std::vector<Table> tables(const World& w) const {
    Table cracks{
        "cracks",
        {"time", "x", "y", "z", "area", "mode", "energy", "x0", "y0", "z0", "nx0", "ny0", "nz0"},
        {"s", "m", "m", "m", "m2", "-", "J", "m", "m", "m", "-", "-", "-"},
        {}};
    for (const fdem3::Crack& c : fdem3::cracks(w)) {
      const Vec3 &m = middles[at(c.joint)], &n = normals[at(c.joint)];
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
    return {cracks, pieces};
  }

  static void add_arrays(World& w, StateArrays& arrays) {
    const fdem3::Tetrahedra& t = w.tetrahedra;
    const auto of_corners = [&]<class Item>(const char* name, const char* unit,
                                            const Buffer<Item>& items, std::size_t offset) {
      arrays.add_part<Vec3>(name, unit, items, offset, 4, sizeof(Item) / 4);
    };
    of_corners("position", "m", t.nodes, offsetof(fdem3::NodeState, position));
    of_corners("velocity", "m/s", t.nodes, offsetof(fdem3::NodeState, velocity));
    of_corners("force", "N", t.force, 0);
    arrays.add_found("damage", "-", t.size(), [&] { return fdem3::damage(w); });
    arrays.add_found("stress", "Pa", t.size(), [&] { return fdem3::stresses(w); });
    arrays.add_found("fragment", "-", t.size(), [&] { return fdem3::fragments(w).of; });
    arrays.add_fields("", w.tetrahedra);
    arrays.add_fields("joints.", w.joints);
  }

  static constexpr Index force_numbers = 12;
  static Index force_items(const World& w) { return w.tetrahedra.size(); }
  static void add_forces(World& w, const OwnForces& own) {
    add_to(w.tetrahedra.force, own);
    fdem3::share_bundle_forces(w);
  }
  static double book_forces(World& w, const OwnForces& own) {
    const OnHost nodes(w.tetrahedra.nodes, w.exec.space);
    return book_to(w.tetrahedra.load_work, own, [&](std::size_t i) {
      const double* const f = own.numbers.data() + 12 * i;
      const fdem3::TetrahedronNodes& n = nodes->host()[static_cast<std::size_t>(own.items[i])];
      double power = 0.0;
      for (int k = 0; k < 4; ++k)
        power += dot(Vec3{f[3 * k], f[3 * k + 1], f[3 * k + 2]}, n.at[k].velocity);
      return 0.5 * w.last_dt * power;
    });
  }

  static std::vector<std::string> constants() {
    return {"tetrahedra.id",   "tetrahedra.group",     "tetrahedra.material", "tetrahedra.shape",
            "tetrahedra.mass", "tetrahedra.viscosity", "joints.face_a",       "joints.face_b",
            "joints.turn",     "joints.law",           "joints.shape",        "joints.length",
            "joints.strength"};
  }
  template <class Visit>
  static void each_stored(World& w, const Visit& visit) {
    visit.fields("tetrahedra", w.tetrahedra);
    visit.fields("joints", w.joints);
    visit.fields("external", Loose<fdem3::Corners>{"force", w.tetrahedra.external});
    visit.fields("joint_force", Loose<fdem3::JointForce>{"force", w.joints.force});
    visit.fields("changed", Loose<std::uint8_t>{"flags", w.exposed.changed});
    visit.fields("exposed", Loose<std::uint8_t>{"vertex", w.exposed.vertex});
    visit.fields("joint_preset", Loose<Vec3>{"opening", w.joints.preset});
    visit.fields("couples", w.couples);
    visit.fields("reach", w.reach);
    visit("reach.drift", w.reach.drift);
  }
};

}  // namespace

std::unique_ptr<Method> make_method(const fdem3::Config& config, const fdem3::Model& model,
                                    const Exec& exec, Communicator* ranks) {
  return std::make_unique<SimMethod<Fdem3Sim>>(config, model, exec, ranks);
}
Fdem3Part fdem3_part(const fdem3::Config& config, const fdem3::Model& model, const Exec& exec) {
  auto method = std::make_unique<SimMethod<Fdem3Sim>>(config, model, exec, nullptr);
  fdem3::World* const world = &method->world();
  return {std::move(method), world};
}

}  // namespace breccia
