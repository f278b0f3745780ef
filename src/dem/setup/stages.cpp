#include "dem/setup/stages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/by_stages.hpp"
#include "core/named.hpp"
#include "core/set_up.hpp"
#include "core/unused_motion.hpp"
#include "dem/setup/materials.hpp"
#include "dem/setup/walls.hpp"
#include "dem/world.hpp"
#include "exec/error.hpp"

namespace breccia::dem {

Config config_at(Config config, const StageProgress& progress) {
  for (std::size_t k = 0; k < config.stages.size() && k <= static_cast<std::size_t>(progress.index);
       ++k) {
    const StageConfig& stage = config.stages[k];
    const double begin = progress.begin[k];
    config.removed.insert(config.removed.end(), stage.remove.begin(), stage.remove.end());
    if (stage.local_damping >= 0.0) config.local_damping = stage.local_damping;
    if (stage.friction >= 0.0) config.stage_friction = stage.friction;
    if (stage.restitution > 0.0) config.contact.restitution = stage.restitution;
    if (stage.gravity.is_table() || stage.gravity.value.x < no_limit) {
      config.gravity = stage.gravity;
      config.gravity_begin = begin;
    }
    for (const SupportChange& change : stage.supports)
      if (SupportConfig* const s = find_named(config.supports, change.name)) {
        if (change.fix != std::vector<std::string>{"same"}) s->fix = change.fix;
        s->velocity = change.velocity;
        s->ramp = change.ramp;
        s->force = change.force;
        s->servo = change.servo;
        s->begin = begin;
      }
    for (const MaterialChange& change : stage.materials)
      if (MaterialConfig* const m = find_named(config.materials, change.name)) {
        if (change.tensile_strength >= 0.0) m->tensile_strength = change.tensile_strength;
        if (change.cohesion >= 0.0) m->cohesion = change.cohesion;
        if (change.broken_friction >= 0.0) m->broken_friction = change.broken_friction;
        if (change.young >= 0.0) m->young = change.young;
      }
    for (const WallChange& change : stage.walls)
      if (WallConfig* const wall = find_named(config.walls, change.name)) {
        wall->force = change.force;
        if (change.friction < no_limit) wall->friction = change.friction;
        wall->begin = begin;
        if (wall->has_mass()) continue;  // its velocity is the one that it began with
        wall->velocity = change.velocity;
        wall->servo = change.servo;
        wall->spin = change.spin;
      }
  }
  return config;
}

std::size_t add_motion(World& w, const WallConfig& wall, std::size_t k) {
  std::array<ScaledAmplitude, 3> velocity;
  for (int axis = 0; axis < 3 && !wall.servo.is_on() && !wall.has_mass(); ++axis)
    velocity[static_cast<std::size_t>(axis)] =
        scaled_amplitude(wall.velocity, axis, 0.0, wall.begin);
  const std::int16_t motion = w.prescribed.add(velocity);
  if (wall.servo.is_on()) w.prescribed.servos.push_back({k, motion, -1});
  return static_cast<std::size_t>(motion);
}

namespace {

/// A wall with mass moves by forces, one without as it is told.
void add_change_problems(const std::string& where, const WallConfig& wall, const WallChange& change,
                         std::vector<std::string>& problems) {
  const auto given = [](const OverTime<Vec3>& of) { return of.is_table() || norm(of.value) > 0.0; };
  const auto add = [&](const char* text) {
    problems.push_back(where + ".wall." + change.name + text);
  };
  if (!wall.has_mass() && given(change.force))
    add(".force acts on a wall with mass; this one moves as it is told");
  if (wall.has_mass() && (given(change.velocity) || change.servo.is_on() || given(change.spin)))
    add(": a wall with mass moves by the forces on it; a stage may change its force only");
}

}  // namespace

namespace {
/// How many of x, y, z it fixes.
std::ptrdiff_t directions_of(const SupportConfig& s) {
  return std::count_if(
             s.fix.begin(), s.fix.end(),
             [](const std::string& word) { return word == "x" || word == "y" || word == "z"; }) +
         3 * std::count(s.fix.begin(), s.fix.end(), "all");
}

/// Velocities along what is not fixed, and ramps that lead nothing.
void add_motion_problems(const Config& config, const Config& now, std::size_t stage,
                         std::vector<std::string>& problems) {
  each_given_motion(config, now, stage, [&](const SupportConfig& s, const std::string& where) {
    if (!s.absorbs() && !s.pushes() && !s.servo.is_on())
      add_unfixed(where, s.fix, s.velocity, problems);
    if (s.ramp > 0.0 && !breccia::is_given(s.velocity) && !s.pushes())
      problems.push_back(where + ".ramp leads nothing: " +
                         (s.servo.is_on() ? "a servo's force grows by a table of its own"
                                          : "the support has no velocity and no force"));
  });
}
}  // namespace

std::vector<std::string> stage_problems(const Config& config) {
  std::vector<std::string> problems =
      breccia::stage_problems({config.stages.begin(), config.stages.end()}, names_of(config.probes),
                              names_of(config.bodies));
  const std::vector<std::string> supports = names_of(config.supports);
  const std::vector<std::string> walls = names_of(config.walls);
  for (const StageConfig& stage : config.stages) {
    const std::string where = "stage." + stage.name;
    if (!stage.remove.empty() && config.search.every > 0)
      problems.push_back(where +
                         ".remove needs search.every = 0: contacts with the body end at a search");
    for (const SupportChange& change : stage.supports)
      add_unknown(where + ".support.name", change.name, "support", supports, problems);
    for (const MaterialChange& change : stage.materials) {
      add_unknown(where + ".material.name", change.name, "material", names_of(config.materials),
                  problems);
      for (const MaterialConfig& m : config.materials) {
        if (m.name != change.name) continue;
        const bool strength = change.tensile_strength >= 0.0 || change.cohesion >= 0.0;
        const bool linked = m.law == "concrete" || m.law == "parallel";
        if (!linked && (m.law != "grain" || strength || change.broken_friction >= 0.0))
          problems.push_back(where + ".material." + m.name + ": its law is " + m.law +
                             "; a stage changes those of law concrete and parallel, and young of "
                             "law grain");
      }
    }
    for (const WallChange& change : stage.walls) {
      add_unknown(where + ".wall.name", change.name, "wall", walls, problems);
      for (const WallConfig& wall : config.walls)
        if (wall.name == change.name) add_change_problems(where, wall, change, problems);
    }
  }
  const auto add_servo = [](const std::string& where, const ServoConfig& s, const auto& velocity,
                            std::vector<std::string>& found) {
    if (!s.is_on()) return;
    if (velocity.is_table() || norm(velocity.value) > 0.0)
      found.push_back(where + ": it has a velocity and a servo, which decides that");
    if ((s.pressure.is_table() || s.pressure.value != 0.0) && !(s.area > 0.0))
      found.push_back(where + ".servo.area: the pressure needs an area to act on");
    if (s.is_plate() && s.gain != ServoConfig{}.gain)
      found.push_back(where + ".servo.gain: a plate has none; with mass = inf it counts");
  };
  const auto problems_in = [&](const Config& now) {
    std::vector<std::string> found;
    for (const WallConfig& wall : now.walls)
      add_servo("wall." + wall.name, wall.servo, wall.velocity, found);
    for (const SupportConfig& s : now.supports) {
      add_servo("support." + s.name, s.servo, s.velocity, found);
      if (s.absorbs() && (s.servo.is_on() || s.velocity.is_table() || norm(s.velocity.value) > 0.0))
        found.push_back("support." + s.name +
                        ".absorb: dashpots move nothing; leave velocity and servo out");
      if (s.pushes() && (!s.fix.empty() || s.absorbs() || s.servo.is_on() ||
                         s.velocity.is_table() || norm(s.velocity.value) > 0.0))
        found.push_back("support." + s.name +
                        ".force acts on elements that are free: fix must be [], and velocity, "
                        "servo and absorb left out");
      if (s.friction > 0.0 && !s.fix.empty() && (directions_of(s) != 1 || s.absorbs()))
        found.push_back("support." + s.name +
                        ".friction: a platen with friction fixes one of x, y, z");
      if (s.servo.is_on() && std::find(s.fix.begin(), s.fix.end(), s.servo.axis) == s.fix.end() &&
          std::find(s.fix.begin(), s.fix.end(), "all") == s.fix.end())
        found.push_back("support." + s.name + ".servo.axis = \"" + s.servo.axis +
                        "\": it does not fix that direction");
    }
    return found;
  };
  add_by_stages(
      config, problems, [&](const StageProgress& progress) { return config_at(config, progress); },
      problems_in,
      [&](const Config& now, std::size_t k) { add_motion_problems(config, now, k, problems); });
  std::sort(problems.begin(), problems.end());
  problems.erase(std::unique(problems.begin(), problems.end()), problems.end());
  return problems;
}

namespace {

void set_modulus(LinkGroup<ConcreteLink>& group, const MaterialConfig& m) {
  group.law.modulus = local_elasticity(m).modulus * group.bulk;
  group.law.rate = rate_curve(m);
  group.law.damping = damping_branch(m);
}
void set_modulus(LinkGroup<ParallelBond>&, const MaterialConfig&) {}

/// Whether some stage changes a material.
bool changes(const Config& config, const MaterialConfig& m) {
  return std::any_of(config.stages.begin(), config.stages.end(), [&](const StageConfig& stage) {
    return std::any_of(stage.materials.begin(), stage.materials.end(),
                       [&](const MaterialChange& change) { return change.name == m.name; });
  });
}

/// Strengths and moduli of links as they are in a stage.
template <class Law>
void set_laws(LinkSet<Law>& set, const Config& config) {
  for (LinkGroup<Law>& group : set.groups) {
    const MaterialConfig& m = config.materials[static_cast<std::size_t>(group.material)];
    if (!changes(config, m)) continue;
    group.law.tensile_strength = group.strength * m.tensile_strength;
    group.law.cohesion = group.strength * m.cohesion;
    group.law.broken_friction =
        m.broken_friction < 0.0 ? config.contact.friction : m.broken_friction;
    set_modulus(group, m);
  }
}

/// Refuses moduli with which a link would reach its strength beyond the opening at which it parts.
/// Its links must be as set up.
void refuse_soft_links(const World& w, const Config& config) {
  std::vector<double> stiffness, area;
  copy_to(stiffness, w.concrete.stiffness);
  copy_to(area, w.concrete.area);
  for (const LinkGroup<ConcreteLink>& group : w.concrete.groups) {
    const auto material = static_cast<std::size_t>(group.material);
    const MaterialConfig& m = config.materials[material];
    const double by = m.young / w.given->first_young[material], last = group.law.rupture_opening;
    if (!(last > 0.0) || by == 1.0 || group.end > w.concrete.size()) continue;
    for (Index i = group.begin; i < group.end; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (by * stiffness[k] * last > group.strength * m.tensile_strength * area[k]) continue;
      throw InputError(fmt::format(
          "stage.material.{}.young = {:.6g} Pa: a link would reach its strength beyond the opening "
          "{:.3g} m at which it parts by fracture_energy; give a larger one",
          m.name, m.young, last));
    }
  }
}

/// The step that resolves contacts falls with the root of the modulus that grew most.
double contact_step(const Case& given, const Config& config) {
  double most = 1.0;
  for (std::size_t k = 0; k < config.materials.size(); ++k)
    most = std::max(most, config.materials[k].young / given.first_young[k]);
  return given.first_contact_step / std::sqrt(most);
}

void set_materials(World& w, const Config& config) {
  if (std::none_of(config.materials.begin(), config.materials.end(),
                   [&](const MaterialConfig& m) { return changes(config, m); }))
    return;
  if (w.step == 0) refuse_soft_links(w, config);
  set_laws(w.concrete, config);
  set_laws(w.parallel, config);
  set_contact_pairs(w, config);
  Case& given = w.given.change(SetUp{});
  given.contact_step = contact_step(given, config);
  list_laws(w);
  w.tiles.forget();
}

}  // namespace

void set_contact_pairs(World& w, const Config& config) {
  std::vector<ContactPair> pairs, walls;
  for (const MaterialConfig& a : config.materials) {
    for (const MaterialConfig& b : config.materials)
      pairs.push_back(contact_pair(config.contact, a, b));
    walls.push_back(wall_pair(config.contact, a));
  }
  Case& given = w.given.change(SetUp{});
  copy_to(given.contact_pairs, pairs);
  copy_to(given.wall_pairs, walls);
}

void set_gravity(World& w, const Vec3& gravity) {
  w.given.change(SetUp{}).gravity = gravity;
  w.graph.clear();
}

void configure(World& w, const Config& config) {
  Case& given = w.given.change(SetUp{});
  if (!config.gravity.is_table())
    given.gravity = (1.0 / config.time.mass_scaling) * config.gravity.value;
  given.local_damping = config.local_damping;
  given.contact.friction =
      config.stage_friction < 0.0 ? config.contact.friction : config.stage_friction;
  given.contact.damping = contact_law(config.contact).damping;
  set_materials(w, config);
  const std::size_t bodies = w.given->sets.size() - config.supports.size();
  std::size_t elements = 0;
  for (std::size_t b = 0; b < bodies; ++b)
    elements += static_cast<std::size_t>(w.given->sets[b].members.size());
  std::vector<std::vector<Index>> members(config.supports.size());
  for (std::size_t s = 0; s < members.size(); ++s)
    copy_to(members[s], w.given->sets[bodies + s].members);
  Prescribed held = prescribed(config, std::move(members), elements, given.dashpots, given.masses);
  given.removed.assign(bodies, 0);
  for (std::size_t b = 0; b < bodies; ++b)
    if (std::count(config.removed.begin(), config.removed.end(), given.sets[b].name) > 0) {
      given.removed[b] = 1;
      std::vector<Index> members_of_body;
      copy_to(members_of_body, given.sets[b].members);
      for (const Index e : members_of_body) {
        held.fixed[static_cast<std::size_t>(e)] = 0x3f | fixed_gone;
        held.motion[static_cast<std::size_t>(e)] = -1;
      }
    }
  std::vector<GlobalId> ids;
  copy_to(ids, w.elements.id);
  std::vector<std::uint8_t> fixed;
  std::vector<std::int16_t> motion;
  for (const GlobalId id : ids) {
    fixed.push_back(held.fixed[static_cast<std::size_t>(id)]);
    motion.push_back(held.motion[static_cast<std::size_t>(id)]);
  }
  copy_to(w.elements.fixed, fixed);
  copy_to(w.elements.motion, motion);
  w.prescribed = std::move(held.motions);
  for (std::size_t k = 0; k < config.walls.size(); ++k) add_motion(w, config.walls[k], k);
  place_motions(w);
  given.wall_spins = wall_spins(config.walls);
  // A wall that stood still has no contacts listed around it: the next step searches.
  for (std::size_t k = 0; k < config.walls.size(); ++k) {
    if (!w.free_walls.empty())
      given.free_walls[k].load = free_wall_of(config.walls[k], config.time.mass_scaling).load;
    given.wall_friction[k] = config.walls[k].friction;
    if (!config.walls[k].has_mass())
      w.walls[k].spin = config.walls[k].spin.at(w.time - config.walls[k].begin);
    w.walls[k].travelled = 2.0 * w.given->largest_margin;
  }
  w.graph.clear();
}

}  // namespace breccia::dem
