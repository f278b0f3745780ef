#pragma once
// Parts of a Simulation (run/method/sim_method.hpp) that both finite-discrete methods share.

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "core/energy_split.hpp"
#include "fdem_shared/couple_phase.hpp"
#include "fdem_shared/fluid/gas_source.hpp"
#include "fdem_shared/joint_stages.hpp"
#include "fdem_shared/shape.hpp"
#include "run/method/energy_of_rounding.hpp"
#include "run/method/loose_array.hpp"
#include "run/method/sim_method.hpp"

namespace breccia {

template <class OfWorld, class OfConfig>
struct MeshSim {
  using World = OfWorld;
  using Config = OfConfig;
  using Shape = fdem_shared::ShapeOf<World>;
  using Vector = typename Shape::Vector;
  static constexpr Index corners = Shape::corners, axes = Shape::dimension;

  template <class Model>
  static World made(const Config& config, const Model& model, const Exec& exec) {
    World w = make_world(config, model, exec);
    energies(w);
    for (const ProbeConfig& p : config.probes) probe(w, p);  // refuses what cannot be read
    return w;
  }
  template <class Model>
  static double rounding(const Model& model, const World& w) {
    return corners * energy_of_rounding(Shape::elements(w).mass, model.point, w.next_dt);
  }
  /// How many states of servos a run of the case keeps.
  static std::size_t servos_of(const Config& config) { return servos_of_supports(config); }
  static std::vector<std::size_t> changed_servos(const Config& config, std::size_t stage) {
    return changed_supports(config, stage);
  }
  static bool has_fluid(const World& w) { return !w.given->fluids.empty(); }
  static void spread(World& part) { spread_fluid(part); }
  static void restore(World& part) { restore_fluid(part); }
  /// Corners that a stage sets free may need shorter steps than those it held.
  static void begun(World& part) {
    take_up_rigid_bodies(part);
    part.next_dt = std::min(part.next_dt, choose_time_step(part));
  }
  static EnergyBalance balance(Ledger& ledger, const Energies& all, std::int64_t) {
    return split_and_note(ledger, all).balance;
  }
  static const char* step_rule(const World& w) { return ruling_term(w); }

  static void add_model(const World& w, std::vector<Fact>& facts) {
    const auto add = [&](const std::string& path, double value) { facts.push_back({path, value}); };
    const std::string elements = std::string("model.") + Shape::elements_word;
    const Index count = Shape::elements(w).size();
    add(elements, count);
    for (std::size_t g = 0; g < w.given->groups.size(); ++g)
      add(elements + "_by_group." + w.given->groups[g],
          static_cast<double>(w.given->sets[g].nodes.size() / at(corners)));
    add("model.joints", w.joints.size());
    if (const AddedMass& added = w.given->added_mass; added.elements > 0) {
      add("model.added_mass.elements", added.elements);
      add("model.added_mass.share", added.share);
      add("model.added_mass.longer", added.longer);
    }
    for (const auto& rock : w.given->rocks) {
      const std::string path = "model.rock." + rock.material + ".";
      add(path + "young", rock.young);
      add(path + "poisson", rock.poisson);
      add(path + "wave_speed", rock.fast);
      add(path + "shear_wave_speed", rock.slow);
      if constexpr (axes == 2) {
        if (!(rock.tension > 0.0)) continue;
        add(path + "tension_over_given", rock.tension);
        add(path + "splitting_over_given", rock.splitting);
      }
    }
    add("model.nodes", corners * count);
    add("searches", static_cast<double>(w.searches));
    std::vector<fdem_shared::CouplePhase> phase;
    copy_to(phase, w.couple_phase);
    const auto waiting = std::count(phase.begin(), phase.end(), fdem_shared::CouplePhase::waits);
    add("contacts.candidates", static_cast<double>(w.couples.size() - waiting));
  }
  static void add_cracks(const World& w, std::vector<Fact>& facts, const SpentOnCracks& spent) {
    const auto add = [&](const std::string& path, double value) { facts.push_back({path, value}); };
    const auto all = cracks(w);
    double area = 0.0, sliding = 0.0;
    for (const auto& crack : all) {
      if constexpr (axes == 3) area += crack.area;
      sliding += crack.mode > 0.5 ? 1.0 : 0.0;
    }
    const auto count = static_cast<double>(all.size());
    add("fracture.broken_joints", count);
    if (const auto& out = w.given->removed; std::find(out.begin(), out.end(), 1) != out.end())
      add("fracture.removed_joints", fdem_shared::count_broken(w) - count);
    if (axes == 3) add("fracture.broken_area", area);
    add("fracture.first_break", all.empty() ? -1.0 : all.front().time);
    add("fracture.broken_by_mode.opening", count - sliding);
    add("fracture.broken_by_mode.sliding", sliding);
    const EnergySplit split = energy_split(w);
    add("fracture.energy_by_mode.opening", split.fracture_open + spent.opening());
    add("fracture.energy_by_mode.sliding", split.fracture_slide + spent.sliding);
  }
  /// @param mass  of each piece, falling
  static void add_fragments(const std::vector<double>& mass, std::vector<Fact>& facts) {
    double total = 0.0;
    for (const double m : mass) total += m;
    facts.push_back({"fracture.fragments", static_cast<double>(mass.size())});
    facts.push_back({"fracture.largest_fragment_fraction",
                     mass.empty() ? 0.0 : mass.front() / total});  // a stage may have taken all out
  }

  static void add_fluids(const World& w, std::vector<Fact>& facts) {
    const auto add = [&](const std::string& path, double value) { facts.push_back({path, value}); };
    for (std::size_t k = 0; k < w.given->fluids.size(); ++k) {
      const auto load = static_cast<std::size_t>(w.given->fluids[k].load);
      const auto filled = filled_part(w, load);
      const std::string path = "fluid." + w.given->load_names[load] + ".";
      add(path + (axes == 3 ? "area" : "length"), filled.extent);
      add(path + "volume", filled.volume);
      const bool flows = w.given->flow.on && static_cast<std::size_t>(w.given->flow.load) == load;
      if (!flows) {
        add(path + "pressure", pressure_now(w, k));
        if (const auto& source = w.given->fluids[k]; !source.holes.empty())
          add(path + "energy", source.charge * w.fluid.gas.data()[k].energy);
        continue;
      }
      add(path + "injected", w.fluid.injected);
      if (!w.given->flow.outlet.empty()) add(path + "released", w.fluid.released);
      add(path + "pressure", w.fluid.pressure);
    }
  }
  /// Of a fluid that does not flow: as given, or that of gas.  [Pa]
  static double pressure_now(const World& w, std::size_t fluid) {
    if (!w.given->fluids[fluid].holes.empty()) return w.fluid.gas.data()[fluid].pressure;
    const auto load = static_cast<std::size_t>(w.given->fluids[fluid].load);
    return w.given->load_amplitudes[load].at(w.time).x * w.given->loads[load].pressure;
  }

  static void add_arrays(World& w, StateArrays& arrays) {
    auto& e = Shape::elements(w);
    using Node = std::remove_reference_t<decltype(e.nodes.data()->at[0])>;
    const auto of_corners = [&]<class Item>(const char* name, const char* unit,
                                            const Buffer<Item>& items, std::size_t offset) {
      arrays.add_part<Vector>(name, unit, items, offset, corners, sizeof(Item) / at(corners));
    };
    of_corners("position", "m", e.nodes, offsetof(Node, position));
    of_corners("velocity", "m/s", e.nodes, offsetof(Node, velocity));
    of_corners("force", Shape::force_unit, e.force, 0);
    const auto found = [&](const char* name, const char* unit, const auto& work) {
      arrays.add_found(name, unit, e.size(), [&] {
        require_places(w);
        return work();
      });
    };
    found("damage", "-", [&] { return damage(w); });
    found("stress", "Pa", [&] { return stresses(w); });
    found("fragment", "-", [&] { return fragments(w).of; });
    arrays.add_fields("", e);
    arrays.add_fields("joints.", w.joints);
  }

  static constexpr Index force_numbers = corners * axes;
  static Index force_items(const World& w) { return Shape::elements(w).size(); }
  static void add_forces(World& w, const OwnForces& own) {
    add_to(Shape::elements(w).force, own);
    share_bundle_forces(w);
  }
  static double book_forces(World& w, const OwnForces& own) {
    auto& e = Shape::elements(w);
    const OnHost nodes(e.nodes, w.exec.space);
    return book_to(e.load_work, own, [&](std::size_t i) {
      const double* f = own.numbers.data() + at(force_numbers) * i;
      double power = 0.0;
      for (const auto& n : nodes->host()[static_cast<std::size_t>(own.items[i])].at) {
        Vector force;
        for (int axis = 0; axis < axes; ++axis) fdem_shared::part_of(force, axis) = *f++;
        power += dot(force, n.velocity);
      }
      return 0.5 * w.last_dt * power;
    });
  }

  template <class Visit>
  static void each_stored_rigid(World& w, const Visit& visit) {
    for (std::size_t s = 0; s < w.rigid.size(); ++s)
      visit("rigid." + std::to_string(s), w.rigid[s]);
  }
  template <class Visit>
  static void each_stored_fluid(World& w, const Visit& visit) {
    if (has_fluid(w)) visit("fluid.time", w.fluid.time);
    if (!w.given->flow.on) return;
    visit("fluid.injected", w.fluid.injected);
    if (!w.given->flow.outlet.empty()) visit("fluid.released", w.fluid.released);
    visit("fluid.pressure", w.fluid.pressure);
    visit.fields("fluid", Loose<double>{"volume", w.fluid.volume});
  }
  template <class Visit>
  static void each_stored_gas(World& w, const Visit& visit) {
    if (fdem_shared::has_gas(w))
      visit.fields("gas", Loose<fdem_shared::SourceNow>{"sources", w.fluid.gas});
  }
  /// @param joint_forces  joint_forces(visit): forces of joints, in the precision of the run
  template <class Visit, class JointForces>
  static void each_stored_array(World& w, const Visit& visit, const JointForces& joint_forces) {
    auto& e = Shape::elements(w);
    visit.fields(Shape::elements_word, e);
    visit.fields("joints", w.joints);
    visit.fields("external", Loose<typename Shape::CornersOfElement>{"force", e.external});
    joint_forces(visit);
    visit.fields("changed", Loose<std::uint8_t>{"flags", w.exposed.changed});
    visit.fields("exposed", Loose<std::uint8_t>{"vertex", w.exposed.vertex});
    visit.fields("joint_preset", Loose<Vector>{"opening", w.joints.preset});
    visit.fields("couples", w.couples);
    visit.fields("reach", w.reach);
    visit("reach.drift", w.reach.drift);
  }
};

}  // namespace breccia
