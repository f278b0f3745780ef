#include "run/method/dem_method.hpp"

#include <algorithm>
#include <cstddef>

#include "dem/emission.hpp"
#include "dem/energy.hpp"
#include "dem/observe.hpp"
#include "dem/ranks.hpp"
#include "dem/servos.hpp"
#include "dem/setup/moduli.hpp"
#include "dem/setup/removal.hpp"
#include "dem/setup/stages.hpp"
#include "dem/stepping/step.hpp"
#include "run/method/dem_tables.hpp"
#include "run/method/emission_table.hpp"
#include "run/method/energy_of_rounding.hpp"
#include "run/method/sim_method.hpp"

namespace breccia {
namespace {

std::size_t group_count(const dem::World& w) {
  std::size_t groups = 0;
  Buffer<std::int16_t> group;
  copy_to(group, w.elements.group);
  for (const std::int16_t g : group.host()) groups = std::max(groups, std::size_t(g) + 1);
  return groups;
}

std::size_t servo_count(const dem::Config& config) {
  bool any = false;
  for (const dem::WallConfig& wall : config.walls) any |= wall.servo.is_on();
  for (const dem::SupportConfig& support : config.supports) any |= support.servo.is_on();
  for (const dem::StageConfig& stage : config.stages) {
    for (const dem::WallChange& wall : stage.walls) any |= wall.servo.is_on();
    for (const dem::SupportChange& support : stage.supports) any |= support.servo.is_on();
  }
  return any ? config.walls.size() + config.supports.size() : 0;
}

struct DemSim {
  using World = dem::World;
  using Config = dem::Config;
  double interaction_range;
  std::vector<dem::Model::Bulk> bulk;  ///< of each body

  DemSim(const dem::Model& model, const World&)
      : interaction_range(model.interaction_range), bulk(model.bulk) {}

  static World made(const dem::Config& config, const dem::Model& model, const Exec& exec) {
    return dem::make_world(config, model, exec);
  }
  static double rounding(const dem::Model& model, const World& w) {
    return energy_of_rounding(w.elements.mass, model.position, w.next_dt);
  }
  /// How many states of servos a run of the case keeps.
  static std::size_t servos_of(const Config& config) { return servo_count(config); }
  /// Servos that a stage gives another task, by name.
  static std::vector<std::size_t> changed_servos(const Config& config, std::size_t stage) {
    std::vector<std::size_t> changed;
    for (std::size_t k = 0; k < config.walls.size(); ++k)
      for (const dem::WallChange& change : config.stages[stage].walls)
        if (change.name == config.walls[k].name) changed.push_back(k);
    for (std::size_t s = 0; s < config.supports.size(); ++s)
      for (const dem::SupportChange& change : config.stages[stage].supports)
        if (change.name == config.supports[s].name) changed.push_back(config.walls.size() + s);
    return changed;
  }
  /// Elements that a stage sets free may need shorter steps than those it held.
  static void begun(World& part) {
    part.next_dt = std::min(part.next_dt, dem::step_allowed_now(part));
  }
  static EnergyBalance balance(Ledger& ledger, const Energies& all, std::int64_t step) {
    return dem::balance(ledger, all, step);
  }
  static FramePart frame(const World& w, const World*) { return dem_frame(w); }

  void add_model(const World& w, std::vector<Fact>& facts) const {
    const auto add = [&](const std::string& path, double value) { facts.push_back({path, value}); };
    add("model.elements", w.elements.size());
    const std::size_t groups = group_count(w);
    for (std::size_t g = 0; g < groups; ++g)
      add("model.elements_by_group." + w.given->sets[g].name, w.given->sets[g].members.size());
    add("model.links", w.links());
    w.each_set(
        [&](const auto& set) { add(std::string("model.links_by_kind.") + set.name, set.size()); });
    add("model.interaction_range", interaction_range);
    for (std::size_t g = 0; g < bulk.size(); ++g) {
      const dem::Model::Bulk& s = bulk[g];
      if (!(s.young > 0.0)) continue;
      const std::string path = "model.elasticity." + w.given->sets[g].name + '.';
      add(path + "young", s.young);
      add(path + "poisson", s.poisson);
      add(path + "packed_young", s.packed_young);
      add(path + "packed_poisson", s.packed_poisson);
      add(path + "factor", s.factor);
      if (s.rupture_opening > 0.0) add(path + "rupture_opening", s.rupture_opening);
    }
    add("searches", static_cast<double>(w.searches));
    add("contacts.candidates", w.contacts.size());
    if (w.exec.space != Space::host)
      add("device.tiles",
          w.tiles.plan == nullptr ? 0.0 : static_cast<double>(w.tiles.plan->tiles.size()));
  }
  static void add_findings(const World& w, std::vector<Fact>& facts, const SpentOnCracks&) {
    const auto add = [&](const std::string& path, double value) { facts.push_back({path, value}); };
    const dem::Counts n = dem::count(w);
    add("contacts.touching", n.touching);
    add("fracture.broken_links", n.broken_links());
    if (const auto& out = w.given->removed; std::find(out.begin(), out.end(), 1) != out.end())
      add("fracture.removed_links", n.removed);
    w.each_set([&](const auto& set) {
      add(std::string("fracture.broken_by_kind.") + set.name, n.broken_of(set.kind));
    });
    add("fracture.fragments", n.fragments);
    add("fracture.largest_fragment_fraction", n.largest_fragment);
    add_emission(facts, dem::emission(w));
  }

  static void note_breaks(World& w) { dem::note_breaks(w); }
  static std::vector<Table> tables(const World& w) { return dem_tables(w); }

  static void add_arrays(World& w, StateArrays& arrays) {
    const Buffer<dem::ElementState>& state = w.elements.state;
    arrays.add_part<Vec3>("position", "m", state, offsetof(dem::ElementState, position));
    arrays.add_part<Vec3>("velocity", "m/s", state, offsetof(dem::ElementState, velocity));
    arrays.add_part<Vec3>("spin", "rad/s", state, offsetof(dem::ElementState, spin));
    arrays.add_part<double>("radius", "m", state, offsetof(dem::ElementState, radius));
    arrays.add_found("damage", "-", w.elements.size(), [&] {
      require_places(w);
      return dem::damage(w);
    });
    arrays.add_fields("", w.elements);
    w.each_set([&](auto& set) {
      if (set.size() > 0) arrays.add_fields(std::string("links.") + set.name + '.', set);
    });
  }

  static constexpr Index force_numbers = 3;
  static Index force_items(const World& w) { return w.elements.size(); }
  static void add_forces(World& w, const OwnForces& own) { add_to(w.elements.force, own); }
  static double book_forces(World& w, const OwnForces& own) {
    const OnHost state(w.elements.state, w.exec.space);
    return book_to(w.elements.load_work, own, [&](std::size_t i) {
      const double* const f = own.numbers.data() + 3 * i;
      const Vec3& v = state->host()[static_cast<std::size_t>(own.items[i])].velocity;
      return 0.5 * w.last_dt * dot(Vec3{f[0], f[1], f[2]}, v);
    });
  }

  static std::vector<std::string> constants() {
    return {"elements.id",
            "elements.group",
            "elements.material",
            "elements.mass",
            "elements.inertia",
            "concrete.a",
            "concrete.b",
            "concrete.length",
            "concrete.stiffness",
            "concrete.area",
            "steel.a",
            "steel.b",
            "steel.length",
            "interface.a",
            "interface.b",
            "interface.before",
            "interface.after",
            "interface.stiffness",
            "interface.area",
            "parallel.a",
            "parallel.b",
            "parallel.length",
            "parallel.stiffness",
            "parallel.strength",
            "ldpm.a",
            "ldpm.b",
            "ldpm.c",
            "ldpm.d",
            "ldpm.place"};
  }
  template <class Visit>
  static void each_stored(World& w, const Visit& visit) {
    visit.fields("elements", w.elements);
    w.each_set([&](auto& set) {  // older files have no parallel bonds, nor facets
      if (set.kind < dem::LinkKind::parallel || set.size() > 0) visit.fields(set.name, set);
    });
    visit.fields("contacts", w.contacts);
    visit.fields("wall_contacts", w.wall_contacts);
    visit.fields("travel", w.travel);
    visit.where_kept("travel.drift", w.travel.drift);  // files of before drifts have none
    for (std::size_t k = 0; k < w.walls.size(); ++k)
      visit("walls." + std::to_string(k), w.walls[k]);
    for (std::size_t k = 0; k < w.free_walls.size(); ++k)
      visit("free_walls." + std::to_string(k), w.free_walls[k]);
  }
};

}  // namespace

std::unique_ptr<Method> make_method(const dem::Config& config, const dem::Model& model,
                                    const Exec& exec, Communicator* ranks) {
  return std::make_unique<SimMethod<DemSim>>(config, model, exec, ranks);
}
DemPart dem_part(const dem::Config& config, const dem::Model& model, const Exec& exec,
                 Communicator* ranks) {
  auto method = std::make_unique<SimMethod<DemSim>>(config, model, exec, ranks);
  dem::World* const world = &method->world();
  return {std::move(method), world};
}

}  // namespace breccia
