// From a model and its case to a world: laws, links, contacts' constants, supports, first forces.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "core/on_host.hpp"
#include "core/set_up.hpp"
#include "core/world_space.hpp"
#include "dem/free_walls.hpp"
#include "dem/setup/link_sets.hpp"
#include "dem/setup/mass_spread.hpp"
#include "dem/setup/materials.hpp"
#include "dem/setup/stages.hpp"
#include "dem/setup/supports.hpp"
#include "dem/setup/wall_meshes.hpp"
#include "dem/setup/walls.hpp"
#include "dem/world.hpp"
#include "exec/error.hpp"
#include "exec/filling.hpp"
#include "math/constants.hpp"

namespace breccia::dem {
namespace {

Case& set_up(World& w) {
  return w.given.change(SetUp{});
}

template <class Items>
auto filled(const World& w, const Items& items) {
  Buffer<typename Items::value_type> buffer(w.exec.space);
  copy_to(buffer, items);
  return buffer;
}

void set_elements(World& w, const Model& m, const Prescribed& held) {
  Elements& e = w.elements;
  const int threads = w.exec.threads;
  fill_items(e.id, m.size(), threads, [](Index i) { return i; });
  copy_to(e.group, m.group);
  copy_to(e.material, m.material);
  copy_to(e.mass, m.mass);
  copy_to(e.inertia, m.inertia);
  fill_items(e.state, m.size(), threads, [&](Index element) {
    const std::size_t i = at(element);
    return ElementState{m.position[i], held.velocity_at_start(i, m.velocity[i]),
                        held.spin_at_start(i, m.spin[i]), m.radius[i]};
  });
  fill_items(e.orientation, m.size(), threads, [](Index) { return Quaternion{}; });
  copy_to(e.fixed, held.fixed);
  copy_to(e.motion, held.motion);
  resize_fields(e, m.size());  // the others are zero
  w.prescribed = held.motions;
  double sum = 0.0;
  for (const double r : m.radius) sum += r;
  set_up(w).mean_radius = m.size() > 0 ? sum / static_cast<double>(m.size()) : 0.0;
}

/// A released pair is D > 1.5 (R_a + R_b) apart. If margins of two elements never exceed half of
/// R_a + R_b, a new search comes before such a pair can meet again, whenever it was released.
void limit_margins(World& w, const Model& m) {
  const auto less = [](double p, double q) { return std::min(p, q); };
  const auto of_link = [&m](Index i) {
    const Model::Link& link = m.links[at(i)];
    if (link.kind == LinkKind::steel || link.kind == LinkKind::interface) return no_limit;
    return std::min(m.radius[at(link.a)], m.radius[at(link.b)]);
  };
  const auto links = static_cast<Index>(m.links.size());
  double least = best_of(w.exec.threads, links, double{no_limit}, of_link, less);
  if (least == no_limit) least = *std::max_element(m.radius.begin(), m.radius.end());
  set_up(w).largest_margin = 0.5 * least;
}

/// Whether a servo moves a support in some stage of a case.
bool moved_by_servo(const Config& config, const SupportConfig& support) {
  bool moved = support.servo.is_on();
  for (const StageConfig& stage : config.stages)
    for (const SupportChange& change : stage.supports)
      moved |= change.name == support.name && change.servo.is_on();
  return moved;
}

/// Bodies and supports, for probes and servos.
void set_sets(World& w, const Config& config, const Model& m, const Prescribed& held) {
  std::vector<ElementSet>& sets = set_up(w).sets;
  for (std::size_t g = 0; g < m.groups.size(); ++g) {
    const auto is_of = [&](Index e) { return m.group[at(e)] == static_cast<std::int16_t>(g); };
    sets.push_back({m.groups[g], filled(w, numbers_where(w.exec.threads, m.size(), is_of))});
  }
  for (std::size_t s = 0; s < config.supports.size(); ++s) {
    sets.push_back({config.supports[s].name, filled(w, held.members[s])});
    const bool moved = moved_by_servo(config, config.supports[s]);
    set_up(w).tied.push_back(
        {config.supports[s].name,
         filled(w, moved ? tied_members(m, held.members[s]) : std::vector<Index>{})});
  }
  w.sets_here.resize(sets.size());
  w.tied_here.resize(config.supports.size());
}

/// Where elements stand, for probes and frames that show how far they have gone.
void set_starts(World& w, const Config& config, const Model& m) {
  Case& given = set_up(w);
  bool any = given.shown.displacement;
  for (const ProbeConfig& p : config.probes) {
    const Quantity::Kind kind = quantity_named(p.quantity).quantity.kind;
    any |= kind == Quantity::Kind::displacement || kind == Quantity::Kind::strain;
    if (kind != Quantity::Kind::strain) continue;
    std::vector<Index> members(m.position.size());
    std::iota(members.begin(), members.end(), 0);
    for (const ElementSet& set : given.sets)
      if (set.name == p.on) copy_to(members, set.members);
    const ReadBox box(p.min, p.max);
    std::vector<Vec3> points;
    for (const Index e : members)
      if (box.holds(m.position[at(e)])) points.push_back(m.position[at(e)]);
    bool fits = false;
    given.strain_fits.push_back({p.name, strain_fit(points, 3, fits)});
    if (!fits)
      throw InputError(fmt::format(
          "probe.{}: strain needs elements that do not lie in a plane; its region holds {}", p.name,
          points.size()));
  }
  if (any) copy_to(given.starts, m.position);
}

/// Walls with mass, and a step that resolves the linear contact of such a wall with one element.
void set_free_walls(World& w, const Config& config, const Model& m) {
  const auto has_mass = [](const WallConfig& wall) { return wall.has_mass(); };
  if (std::none_of(config.walls.begin(), config.walls.end(), has_mass)) return;
  Case& given = set_up(w);
  w.free_walls.resize(config.walls.size());
  std::vector<ContactPair> pairs;  // on the host
  copy_to(pairs, given.wall_pairs);
  auto corners = m.wall_meshes.begin();
  for (std::size_t k = 0; k < config.walls.size(); ++k) {
    const WallConfig& wall = config.walls[k];
    given.free_walls.push_back(free_wall_of(wall, config.time.mass_scaling));
    FreeWall& free = given.free_walls.back();
    const std::vector<Vec3> mesh = wall.shape == "stl" ? *corners++ : std::vector<Vec3>{};
    if (free.turns) {
      free.spread = mass_spread(wall, free.mass, mesh);
      start_turning(w, k, wall.velocity.value, wall.spin.value);
    }
    if (!wall.has_mass() || given.contact.hertz) continue;
    double stiffest = 0.0;
    for (std::size_t e = 0; e < m.radius.size(); ++e)
      stiffest = std::max(stiffest, 0.5 * wall.stiffness * m.radius[e] *
                                        pairs[static_cast<std::size_t>(m.material[e])].normal);
    given.contact_step =
        std::min(given.contact_step,
                 config.time.safety * given.contact.shrink() *
                     std::sqrt(2.0 * std::min(free.mass, free.spread.least_mass) / stiffest));
  }
}

void set_contacts(World& w, const Config& config, const Model& m) {
  Case& given = set_up(w);
  given.contact = contact_law(config.contact);
  given.materials = static_cast<Index>(config.materials.size());
  for (Buffer<ContactPair>* pairs : {&given.contact_pairs, &given.wall_pairs})
    *pairs = Buffer<ContactPair>(w.exec.space);
  set_contact_pairs(w, config);
  given.meshes = wall_meshes(config, m, w.exec.space);
  auto corners = m.wall_meshes.begin();
  for (std::size_t k = 0; k < config.walls.size(); ++k) {
    const WallConfig& wall = config.walls[k];
    const std::vector<std::string> problems = wall_problems(wall);
    if (!problems.empty()) throw InputError(problems[0]);
    given.wall_names.push_back(wall.name);
    given.wall_starts.push_back(wall.point);
    given.wall_friction.push_back(wall.friction);
    const std::size_t motion = add_motion(w, wall, k);
    w.walls.push_back(
        wall_of(wall, wall.has_mass() ? wall.velocity.value : w.prescribed.velocity(motion, 0.0)));
    if (wall.shape == "stl") w.walls.back().half[0] = farthest_corner(*corners++);
  }
  given.wall_spins = wall_spins(config.walls);
  set_free_walls(w, config, m);
  place_motions(w);
  // A step that resolves the contact of two like elements, for those that nothing else slows down.
  std::vector<ContactPair> pairs;
  for (const MaterialConfig& c : config.materials)
    pairs.push_back(contact_pair(config.contact, c, c));
  const auto step_of = [&](Index element) {
    const std::size_t e = at(element);
    const auto material = static_cast<std::size_t>(m.material[e]);
    const double r = m.radius[e];
    double step = 0.0;
    if (config.contact.law == "hertz") {  // a fifth of the Rayleigh time
      const MaterialConfig& c = config.materials[material];
      const double density = m.mass[e] / (4.0 / 3.0 * pi * r * r * r);
      step = 0.2 * pi * r * std::sqrt(density * 2.0 * (1.0 + c.poisson) / c.young) /
             (0.1631 * c.poisson + 0.8766);
    } else {
      step = std::sqrt(2.0 * m.mass[e] / (pairs[material].normal * 0.5 * r));
      if (given.contact.damping > 0.0) step *= 0.5 * given.contact.shrink();  // theory.md, 8
    }
    return config.time.safety * step;
  };
  given.contact_step = best_of(w.exec.threads, m.size(), given.contact_step, step_of,
                               [](double least, double step) { return std::min(least, step); });
  given.first_contact_step = given.contact_step;
  for (const MaterialConfig& each : config.materials) given.first_young.push_back(each.young);
}

}  // namespace

World::World(const Exec& how) : exec(how), lanes(widest_lanes()) {
  concrete.precision = how.precision;
  place_arrays(*this);
}

void move_to(World& w, Space space) {
  move_world(w, space);
}

void place_motions(World& w) {
  copy_to(w.motions, w.prescribed.motions);
  std::vector<LedBy> led(w.prescribed.motions.size());
  for (const ServoMotion& m : w.prescribed.servos)
    if (m.axis >= 0)
      led[static_cast<std::size_t>(m.motion)].servo[m.axis] = static_cast<std::int16_t>(m.servo);
  copy_to(w.led, led);
  copy_to(w.motion_times, w.prescribed.tables.times);
  copy_to(w.motion_factors, w.prescribed.tables.factors);
}

namespace {

/// Says which supports hold a body by so few elements that their links bear all of its reaction.
void tell_narrow_supports(const Config& config, const Model& model,
                          const std::vector<std::vector<Index>>& members,
                          std::vector<std::string>& warnings) {
  constexpr std::size_t few = 10, small = 200;  // elements: of a support, of a whole model
  if (model.position.size() < small) return;
  for (std::size_t s = 0; s < members.size(); ++s) {
    const SupportConfig& support = config.supports[s];
    const bool stands = std::any_of(support.fix.begin(), support.fix.end(), [](const auto& word) {
      return word == "x" || word == "y" || word == "z" || word == "all";
    });
    if (!stands || members[s].empty() || members[s].size() >= few) continue;
    const std::set<Index> held(members[s].begin(), members[s].end());
    const auto links =
        std::count_if(model.links.begin(), model.links.end(), [&](const Model::Link& link) {
          return link.kind != LinkKind::steel && !link.parted &&
                 held.contains(link.a) != held.contains(link.b);
        });
    if (links == 0) continue;
    warnings.push_back(
        fmt::format("support.{}: it holds {} element{}, which {} link{} to the rest: where {} it "
                    "holds nothing more. Widen its region, or let the body rest on a wall",
                    support.name, held.size(), held.size() == 1 ? "" : "s", links,
                    links == 1 ? " joins" : "s join", links == 1 ? "that breaks" : "these break"));
  }
}

/// Says which concretes of the library run with another damping than that which they were found
/// with, links that damp and nothing else (docs/theory.md, 4). Stages set theirs to settle.
void tell_other_damping(const Config& config, std::vector<std::string>& warnings) {
  const bool of_stages = std::ranges::any_of(
      config.stages, [](const StageConfig& stage) { return stage.local_damping >= 0.0; });
  for (const MaterialConfig& m : config.materials) {
    if (m.law != "concrete" || m.use.empty()) continue;
    if (m.link_damping == 0.0)
      warnings.push_back(fmt::format(
          "material.{}: {} was found with link_damping = 0.3, and this case has 0: links that "
          "break ring on and part their neighbours, so that C30 has 8 % less compressive "
          "strength (docs/theory.md, 4)",
          m.name, m.use));
    else if (config.local_damping > 0.0 && !of_stages)
      warnings.push_back(fmt::format(
          "material.{}: {} was found without local damping, and this case has {}: it drags on "
          "pieces that fly, so that C30 with 0.3 has 11 % more compressive and 3 % more tensile "
          "strength (docs/theory.md, 4)",
          m.name, m.use, config.local_damping));
  }
}

/// Says which walls elements reach into before anything moves, and what that is worth.
void tell_overlaps(const World& w, const Config& config, std::vector<std::string>& warnings) {
  constexpr double little = 0.01;  // of a radius
  const OnHost element(w.wall_contacts.pairs.a, w.exec.space);
  const OnHost wall(w.wall_contacts.pairs.b, w.exec.space);
  const OnHost contact(w.wall_contacts.history.state, w.exec.space);
  const OnHost push(w.wall_contacts.history.on_wall, w.exec.space);
  const OnHost state(w.elements.state, w.exec.space);
  struct Overlaps {
    Index elements = 0;
    double deepest = 0.0, share = 0.0;  //  [m], of a radius  [-]
    Vec3 force;                         //  [N]
  };
  std::vector<Overlaps> of(config.walls.size());
  for (Index i = 0; i < w.wall_contacts.size(); ++i) {
    const double overlap = contact->data()[i].overlap;
    if (!(overlap > 0.0)) continue;
    Overlaps& own = of[at(wall->data()[i])];
    ++own.elements;
    own.deepest = std::max(own.deepest, overlap);
    own.share = std::max(own.share, overlap / state->data()[element->data()[i]].radius);
    own.force += push->data()[i];
  }
  for (std::size_t k = 0; k < of.size(); ++k) {
    if (!(of[k].share > little)) continue;
    std::string told = fmt::format(
        "wall.{}: at the start {} elements reach into it, by up to {:.3g} mm ({:.0f} % of a "
        "radius), and press with {:.3g} N; if that is not meant, move the wall back by as much",
        config.walls[k].name, of[k].elements, 1e3 * of[k].deepest, 100.0 * of[k].share,
        norm(of[k].force));
    if (w.walls[k].shape == WallShape::plane) {
      constexpr double beyond = 1e-3;  // of the overlap: what digits leave
      const Vec3 to = w.walls[k].point - ((1.0 + beyond) * of[k].deepest) * w.walls[k].normal;
      told += fmt::format(": with point = [{:.9g}, {:.9g}, {:.9g}] it begins without force",
                          to.x + 0.0, to.y + 0.0, to.z + 0.0);
    }
    warnings.push_back(std::move(told));
  }
}

World made(const Config& config, const Model& model, const Exec& exec) {
  if (model.size() == 0) throw InputError("the case has no elements");
  const FillingThreads filling(exec.threads);
  World w(exec);
  Case& given = set_up(w);
  // Contacts of loose elements last few steps; links are never stiffer than at the start.
  given.time = config.time.evaluated_every(model.links.empty() ? 1 : 10);
  given.search = config.search;
  given.gravity = config.gravity.value;
  given.local_damping = config.local_damping;
  for (const MaterialConfig& m : config.materials) {
    given.bars.push_back(m.law == "steel" ? 1 : 0);
    given.densities.push_back(config.time.mass_scaling * m.density);
  }
  given.shown = config.output.more_fields();
  given.emission = config.emission;
  std::vector<std::vector<Index>> members = support_members(config, model, exec.threads);
  given.dashpots = dashpots_of(config, model, members);
  tell_narrow_supports(config, model, members, given.warnings);
  tell_other_damping(config, given.warnings);
  for (const std::vector<Index>& own : members) {
    given.masses.push_back(0.0);
    for (const Index e : own) given.masses.back() += model.mass[at(e)];
  }
  const Prescribed held =
      prescribed(config, std::move(members), model.position.size(), given.dashpots, given.masses);
  const auto part = [&exec](const char* name, const auto& work) {
    const StageTime timed(exec, name);
    work();
  };
  part("set_up_elements", [&] { set_elements(w, model, held); });
  part("set_up_links", [&] { set_links(w, config, model); });
  part("set_up_linked_pairs", [&] { set_linked_pairs(w); });
  part("set_up_sets", [&] {
    limit_margins(w, model);
    set_sets(w, config, model, held);
    set_starts(w, config, model);
  });
  part("set_up_contacts", [&] { set_contacts(w, config, model); });
  part("set_up_derived", [&] { derive(w); });
  find_contacts(w);
  evaluate_forces(w);
  part("set_up_balance", [&] {
    const EnergyBalance start = balance(w);
    w.ledger.start = start.kinetic + start.elastic;
  });
  tell_overlaps(w, config, given.warnings);
  return w;
}

}  // namespace

World make_world(const Config& config, const Model& model, const Exec& exec) {
  const double scale = config.time.mass_scaling;
  if (scale == 1.0) return made(config, model, exec);
  Config slower = config;  // more inertia under the weight that bodies have
  slower.gravity.value = (1.0 / scale) * config.gravity.value;
  Model heavier = model;
  for (double& mass : heavier.mass) mass *= scale;
  for (double& inertia : heavier.inertia) inertia *= scale;
  return made(slower, heavier, exec);
}

}  // namespace breccia::dem
