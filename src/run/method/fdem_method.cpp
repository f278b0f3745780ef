#include "run/method/fdem_method.hpp"

#include <algorithm>
#include <cstddef>

#include "exec/error.hpp"
#include "fdem/emission.hpp"
#include "fdem/energy.hpp"
#include "fdem/fluid/fluid.hpp"
#include "fdem/observe.hpp"
#include "fdem/ranks.hpp"
#include "fdem/servos.hpp"
#include "fdem/setup/removal.hpp"
#include "fdem/setup/stages.hpp"
#include "fdem/stepping/step.hpp"
#include "run/method/emission_table.hpp"
#include "run/method/loose_array.hpp"
#include "run/method/sim_method.hpp"

namespace breccia {
namespace {

struct FdemSim {
  using World = fdem::World;
  using Config = fdem::Config;
  /// Where a joint lay at the start.
  struct Line {
    Vec2 begin, end;  ///<  [m]
  };
  std::vector<Line> lines;  ///< of all joints; on rank 0

  FdemSim(const fdem::Model& model, const World& mesh) {
    std::vector<Index> edges;
    copy_to(edges, mesh.joints.edge_a);
    for (const Index edge : edges) {
      const auto& corners = model.triangle[at(edge / 3)];
      const auto point = [&](Index k) { return model.point[at(corners[at(k % 3)])]; };
      lines.push_back({point(edge % 3), point(edge % 3 + 1)});
    }
  }

  static World made(const fdem::Config& config, const fdem::Model& model, const Exec& exec) {
    World w = fdem::make_world(config, model, exec);
    fdem::energies(w);
    for (const ProbeConfig& p : config.probes) fdem::probe(w, p);  // refuses what cannot be read
    return w;
  }
  /// How many states of servos a run of the case keeps.
  static std::size_t servos_of(const Config& config) { return servos_of_supports(config); }
  static std::vector<std::size_t> changed_servos(const Config& config, std::size_t stage) {
    return changed_supports(config, stage);
  }
  /// Corners that a stage sets free may need shorter steps than those it held.
  static void begun(World& part) {
    part.next_dt = std::min(part.next_dt, fdem::choose_time_step(part));
  }
  static bool has_fluid(const World& w) { return !w.given->fluids.empty(); }
  static void spread(World& part) { fdem::spread_fluid(part); }
  static void restore(World& part) { fdem::restore_fluid(part); }
  static EnergyBalance balance(Ledger& ledger, const Energies& all, std::int64_t) {
    return fdem::energies(ledger, all).balance;
  }
  static const char* step_rule(const World& w) { return fdem::ruling_term(w); }
  static FramePart frame(World& w, const World* mesh) { return fdem_frame(w, mesh); }

  static void add_model(const World& w, std::vector<Fact>& facts) {
    const auto add = [&](const std::string& path, double value) { facts.push_back({path, value}); };
    add("model.triangles", w.triangles.size());
    for (std::size_t g = 0; g < w.given->groups.size(); ++g)
      add("model.triangles_by_group." + w.given->groups[g],
          static_cast<double>(w.given->sets[g].nodes.size() / 3));
    add("model.joints", w.joints.size());
    for (const fdem::EffectiveRock& rock : w.given->rocks) {
      const std::string path = "model.rock." + rock.material + ".";
      add(path + "young", rock.young);
      add(path + "poisson", rock.poisson);
      add(path + "wave_speed", rock.fast);
      add(path + "shear_wave_speed", rock.slow);
    }
    add("model.nodes", 3 * w.triangles.size());
    add("searches", static_cast<double>(w.searches));
    add("contacts.candidates", w.couples.size());
  }
  void add_findings(const World& w, std::vector<Fact>& facts) const {
    const auto add = [&](const std::string& path, double value) { facts.push_back({path, value}); };
    const std::vector<fdem::Crack> cracks = fdem::cracks(w);
    const auto sliding = std::count_if(cracks.begin(), cracks.end(),
                                       [](const fdem::Crack& c) { return c.mode > 0.5; });
    add("fracture.broken_joints", static_cast<double>(cracks.size()));
    add("fracture.first_break", cracks.empty() ? -1.0 : cracks.front().time);
    add("fracture.broken_by_mode.opening",
        static_cast<double>(cracks.size()) - static_cast<double>(sliding));
    add("fracture.broken_by_mode.sliding", static_cast<double>(sliding));
    const EnergySplit split = fdem::energy_split(w);
    add("fracture.energy_by_mode.opening", split.fracture_open);
    add("fracture.energy_by_mode.sliding", split.fracture_slide);
    const fdem::Fragments pieces = fdem::fragments(w);
    double total = 0.0;
    for (const double m : pieces.mass) total += m;
    for (const fdem::FluidSource& fluid : w.given->fluids) {
      const auto load = static_cast<std::size_t>(fluid.load);
      const fdem::FilledPart filled = fdem::filled_part(w, load);
      const std::string path = "fluid." + w.given->load_names[load] + ".";
      add(path + "length", filled.length);
      add(path + "volume", filled.volume);
      if (!w.given->flow.on || w.given->flow.load != fluid.load) continue;
      add(path + "injected", w.fluid.injected);
      add(path + "pressure", w.fluid.pressure);
    }
    add_emission(facts, events(w));
    add("fracture.fragments", static_cast<double>(pieces.mass.size()));
    add("fracture.largest_fragment_fraction", pieces.mass.front() / total);
  }

  std::vector<Table> tables(const World& w) const {
    Table cracks{"cracks",
                 {"time", "x", "y", "length", "mode", "energy", "x0", "y0", "x1", "y1"},
                 {"s", "m", "m", "m", "-", "J/m", "m", "m", "m", "m"},
                 {}};
    for (const fdem::Crack& c : fdem::cracks(w)) {
      const Vec2 middle = 0.5 * (c.begin + c.end);
      const Line& line = lines[at(c.joint)];
      cracks.rows.push_back({c.time, middle.x, middle.y, norm(c.end - c.begin), c.mode, c.energy,
                             line.begin.x, line.begin.y, line.end.x, line.end.y});
    }
    Table pieces{"fragments", {"fragment", "mass", "share"}, {"-", "kg/m", "-"}, {}};
    const fdem::Fragments all = fdem::fragments(w);
    const double scaling = w.given->time.mass_scaling;
    double total = 0.0;
    for (const double m : all.mass) total += m;
    for (std::size_t i = 0; i < all.mass.size(); ++i)
      pieces.rows.push_back({static_cast<double>(i), all.mass[i] / scaling, all.mass[i] / total});
    return {cracks, pieces, table_of(events(w))};
  }
  std::vector<EmissionEvent> events(const World& w) const {
    std::vector<fdem::JointLine> at_start;
    for (const Line& line : lines) at_start.push_back({line.begin, line.end});
    return fdem::emission(w, at_start);
  }

  static void add_arrays(World& w, StateArrays& arrays) {
    const fdem::Triangles& t = w.triangles;
    const auto of_corners = [&]<class Item>(const char* name, const char* unit,
                                            const Buffer<Item>& items, std::size_t offset) {
      arrays.add_part<Vec2>(name, unit, items, offset, 3, sizeof(Item) / 3);
    };
    of_corners("position", "m", t.nodes, offsetof(fdem::NodeState, position));
    of_corners("velocity", "m/s", t.nodes, offsetof(fdem::NodeState, velocity));
    of_corners("force", "N/m", t.force, 0);
    arrays.add_found("damage", "-", t.size(), [&] { return fdem::damage(w); });
    arrays.add_found("stress", "Pa", t.size(), [&] { return fdem::stresses(w); });
    arrays.add_found("fragment", "-", t.size(), [&] { return fdem::fragments(w).of; });
    arrays.add_fields("", w.triangles);
    arrays.add_fields("joints.", w.joints);
  }

  static constexpr Index force_numbers = 6;
  static Index force_items(const World& w) { return w.triangles.size(); }
  static void add_forces(World& w, const OwnForces& own) {
    add_to(w.triangles.force, own);
    fdem::share_bundle_forces(w);
  }
  static double book_forces(World& w, const OwnForces& own) {
    const OnHost nodes(w.triangles.nodes, w.exec.space);
    return book_to(w.triangles.load_work, own, [&](std::size_t i) {
      const double* const f = own.numbers.data() + 6 * i;
      const fdem::TriangleNodes& n = nodes->host()[static_cast<std::size_t>(own.items[i])];
      double power = 0.0;
      for (int k = 0; k < 3; ++k) power += dot(Vec2{f[2 * k], f[2 * k + 1]}, n.at[k].velocity);
      return 0.5 * w.last_dt * power;
    });
  }

  static std::vector<std::string> constants() {
    return {
        "triangles.id",   "triangles.group",     "triangles.material", "triangles.shape_inverse",
        "triangles.mass", "triangles.viscosity", "joints.edge_a",      "joints.edge_b",
        "joints.law",     "joints.length",       "joints.strength"};
  }
  template <class Visit>
  static void each_stored(World& w, const Visit& visit) {
    visit.fields("triangles", w.triangles);
    visit.fields("joints", w.joints);
    visit.fields("external", Loose<fdem::Corners>{"force", w.triangles.external});
    with_number(w.exec.precision, [&](auto number) {
      using Number = decltype(number);
      visit.fields("joint_force",
                   Loose<fdem::JointForceOf<Number>>{"force", w.joints.force.as<Number>()});
    });
    visit.fields("changed", Loose<std::uint8_t>{"flags", w.exposed.changed});
    visit.fields("exposed", Loose<std::uint8_t>{"vertex", w.exposed.vertex});
    visit.fields("joint_preset", Loose<Vec2>{"opening", w.joints.preset});
    visit.fields("couples", w.couples);
    visit.fields("reach", w.reach);
    visit("reach.drift", w.reach.drift);
    if (has_fluid(w)) visit("fluid.time", w.fluid.time);
    if (!w.given->flow.on) return;
    visit("fluid.injected", w.fluid.injected);
    visit("fluid.pressure", w.fluid.pressure);
    visit.fields("fluid", Loose<double>{"volume", w.fluid.volume});
  }
};

}  // namespace

std::unique_ptr<Method> make_method(const fdem::Config& config, const fdem::Model& model,
                                    const Exec& exec, Communicator* ranks) {
  return std::make_unique<SimMethod<FdemSim>>(config, model, exec, ranks);
}

}  // namespace breccia
