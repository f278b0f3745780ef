#pragma once
// One method for every kind of world: steps, looks, saves, alone or on ranks.

#include <algorithm>
#include <concepts>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/precision.hpp"
#include "core/probe.hpp"
#include "core/unsound.hpp"
#include "exec/error.hpp"
#include "run/frames/frame_parts.hpp"
#include "run/machine/load_check.hpp"
#include "run/method/each_servo.hpp"
#include "run/method/lagging_probes.hpp"
#include "run/method/method.hpp"
#include "run/method/read_later.hpp"
#include "run/method/shared_world.hpp"
#include "run/method/spent_on_cracks.hpp"
#include "run/method/stored.hpp"

namespace breccia {

/// The parts that differ between kinds of world. It may also have `step_rule(world)`,
/// `note_breaks(world)`, `tables(world)` and `constants()`, and has `each_stored(world, visit)`:
/// the one list of what a checkpoint holds, as visit(name, value), visit.fields(prefix, state), and
/// visit.where_kept(name, value) for what older files lack. Beside the world are advance, held,
/// probe, read_own, find_unsound, fastest, state_hash, derive, share_out, collect and rebalance.
template <class Sim>
concept Simulation = requires(const Sim& sim, typename Sim::World& w, std::vector<Fact>& facts,
                              Ledger& ledger, const Energies& energies, StateArrays& arrays,
                              const OwnForces& own, const SpentOnCracks& spent) {
  { Sim::balance(ledger, energies, std::int64_t{}) } -> std::same_as<EnergyBalance>;
  // The frame of a world, or what a part has of it; rank 0 knows the whole mesh, too.
  { Sim::frame(w, &w) } -> std::same_as<FramePart>;
  // Counts of the model, and findings about its state.
  sim.add_model(w, facts);
  sim.add_findings(w, facts, spent);
  // Arrays that others may look at while it runs.
  Sim::add_arrays(w, arrays);
  // Forces of the program that holds the simulation.
  Sim::add_forces(w, own);
  { Sim::book_forces(w, own) } -> std::same_as<double>;
};

template <class World>
std::uint64_t hash_of(const World& w) {
  return state_hash(w);
}

template <class World>
Fastest fastest_of(const World& w) {
  return fastest(w);
}

template <Simulation Sim>
class SimMethod final : public Method {
 public:
  using World = typename Sim::World;
  using Config = typename Sim::Config;

  template <class Model>
  SimMethod(const Config& config, const Model& model, const Exec& exec, Communicator* ranks)
      : world_([&](const Exec& where) { return made(config, model, where); },
               in_precision(exec, config.precision), ranks, config.domain),
        sim_(model, world_.mesh()),
        rounding_(Sim::rounding(model, world_.mesh())),
        probes_(config.probes),
        lagging_(config.probes),
        case_(config),
        now_(config_at(config, {})) {
    change_gravity();
  }

  /// The world that it steps, for a method that couples two worlds.
  World& world() { return world_.part(); }

  Advanced advance(const StopAt& stop) override {
    if (world_.part().servos.empty() && !has_fluid(world_.part()) && lagging_.empty() &&
        !now_.gravity.is_table())
      return world_.advance_to(stop);
    const std::int64_t every = has_plates() ? 1 : servo_every;
    const std::int64_t next = (steps() / every + 1) * every;
    const Advanced taken = world_.advance_to({stop.time, std::min(stop.step, next)});
    if (taken.steps > 0) steer({});
    return taken;
  }
  void steer(const std::vector<ServoReading>& more) override {
    const bool servos = !world_.part().servos.empty(), all = steps() % servo_every == 0;
    if (servos && (all || has_plates())) correct_all_servos(more);
    if constexpr (requires(World & w) { Sim::spread(w); })
      if (all && has_fluid(world_.part()))
        at_once(world_.ranks(), [&] { Sim::spread(world_.part()); });
    if (all && now_.gravity.is_table()) change_gravity();
    if (all && !lagging_.empty()) lagging_.look(read_now(lagging_.configs()), time());
  }
  void begin_steps() override { world_.begin_steps(); }
  void end_steps() override { world_.end_steps(); }
  std::int64_t steps() const override { return world_.part().step; }
  double time() const override { return world_.part().time; }
  double time_step() const override {
    const World& w = world_.part();
    return w.step > 0 ? w.last_dt : w.next_dt;
  }
  std::int64_t searches() const override { return world_.part().searches; }
  std::vector<std::string> warnings() override { return world_.mesh().given->warnings; }
  std::string step_rule() override {
    if constexpr (requires(const World& w) { Sim::step_rule(w); })
      return world_.of_whole([](const World& w) { return std::string(Sim::step_rule(w)); });
    return {};
  }

  std::vector<StageEnd> stages() const override {
    return {case_.stages.begin(), case_.stages.end()};
  }
  StageProgress stage() const override { return world_.part().stage; }
  void set_stage(const StageProgress& now) override {
    const bool begins = now.index != world_.part().stage.index;
    world_.in_both([&](World& w) { w.stage = now; });
    if (!begins) return;
    const Config before = std::exchange(now_, config_at(case_, now));
    change_gravity();
    const auto& stage = case_.stages[static_cast<std::size_t>(now.index)];
    const bool removes = !stage.remove.empty();
    bool books = removes;
    if constexpr (requires { stage.materials; }) books |= !stage.materials.empty();
    if constexpr (requires { stage.joints; }) books |= !stage.joints.empty();
    const auto change = [&](World& w) {
      if constexpr (requires { change_moduli(w, before, now_); }) change_moduli(w, before, now_);
      configure(w, now_);
      if (removes) {
        open_around_removed(w);
        cut_off_removed(w);
      }
    };
    if (books)
      booked([&] {
        world_.in_both(change);
        if constexpr (requires { changes_moduli(stage); })
          if (changes_moduli(stage))
            at_once(world_.ranks(), [&] { world_.in_part([](World& w) { evaluate_anew(w); }); });
      });
    else
      world_.in_both(change);
    world_.in_both([&](World& w) {
      if (w.servos.empty()) return;
      for (const std::size_t k : Sim::changed_servos(case_, static_cast<std::size_t>(now.index)))
        w.servos[k] = {};
      place_servos(w);
    });
    if constexpr (requires(World & w) { Sim::begun(w); })
      at_once(world_.ranks(), [&] { Sim::begun(world_.part()); });
  }
  EnergyBalance energy() override { return balance_of(energies_of_all()); }
  EnergyBalance balance_of(const Energies& all) {  // on rank 0
    if (!leads(world_.ranks())) return {};
    EnergyBalance now = Sim::balance(world_.ledger(), all, steps());
    now.fracture += spent_.all;
    if (spent_.all != 0.0 && steps() != 0) now.relate_to(world_.ledger().largest);
    if (world_.ledger().largest <= rounding()) now.error_relative = now.contact_relative = 0.0;
    return now;
  }
  double rounding() const override { return rounding_ * static_cast<double>(steps()); }
  std::vector<double> probes() override {
    std::vector<double> values = read_now(probes_);
    lagging_.tell(values);
    return values;
  }
  Row row() override {
    if (!single_rank()) return Method::row();
    foresee();
    World& w = world_.part();
    const UnsoundLater unsound = find_unsound_later(w);
    note_breaks();
    const std::function<std::vector<double>()> probes = read_later(w, probes_);
    const std::function<Energies()> energies = held_later(w);
    require_sound(unsound());
    Row now;
    now.probes = probes();
    lagging_.tell(now.probes);
    now.energy = balance_of(energies());
    return now;
  }
  void note_breaks() override {
    if constexpr (requires(World & w) { Sim::note_breaks(w); })
      at_once(world_.ranks(), [&] { world_.in_part([](World& w) { Sim::note_breaks(w); }); });
  }
  std::uint64_t state_hash() override {
    const std::uint64_t own = hash_of(world_.part());
    if (single_rank()) return own;
    Message message;
    put_value(message, own);
    std::uint64_t all = 0;  // each rank's part has a term for each of its elements
    for (const Message& told : world_.told(std::move(message)))
      all += Unpacking(told).value<std::uint64_t>();
    return all;
  }
  void verify() override {
    Unsound first = find_unsound(world_.part());
    if (!single_rank()) {
      Message message;
      put_value(message, first.id);
      put_array(message, std::vector<char>(first.text.begin(), first.text.end()));
      for (const Message& told : world_.told(std::move(message))) {
        Unpacking from(told);
        const auto id = from.value<GlobalId>();
        const std::vector<char> text = from.array<char>();
        if (id < first.id) first = {id, {text.begin(), text.end()}};
      }
    }
    on_first(world_.ranks(), [&] { require_sound(first); });
  }

  std::string fastest() override {
    Fastest all = fastest_of(world_.part());
    if (single_rank()) return all.text;
    Message message;
    put_value(message, all.speed);
    put_array(message, std::vector<char>(all.text.begin(), all.text.end()));
    for (const Message& told : world_.told(std::move(message))) {
      Unpacking from(told);
      const auto speed = from.value<Speed>();
      const std::vector<char> text = from.array<char>();
      if (Faster{}(all.speed, speed).id != all.speed.id) all = {speed, {text.begin(), text.end()}};
    }
    return all.text;
  }

  Frame frame() override {
    look_at_places();
    foresee();
    return world_.of_whole([](World& w) {
      if (!w.servos.empty()) place_servos(w);  // parts steer them, and velocities are of a step
      return Sim::frame(w, nullptr).frame;
    });
  }
  FrameOutput frame_output(const FrameWish& wish) override {
    look_at_places();
    foresee();
    World& w = world_.part();
    const int threads = w.exec.threads;
    if (single_rank()) return breccia::frame_output(Sim::frame(w, nullptr), wish, threads);
    FrameOutput output;
    at_once(world_.ranks(), [&] {
      const World* const mesh = leads(world_.ranks()) ? &world_.mesh() : nullptr;
      output = FrameOfParts(Sim::frame(w, mesh), wish, *world_.ranks(), threads).output();
    });
    return output;
  }
  std::vector<Fact> facts() override {
    look_at_places();
    return world_.of_whole([this](const World& w) {
      std::vector<Fact> facts;
      sim_.add_model(w, facts);
      world_.add_facts(facts);
      sim_.add_findings(w, facts, spent_);
      return facts;
    });
  }
  std::vector<StateArray> arrays(const std::string& name, Wanted where) override {
    StateArrays arrays(name, where);
    Sim::add_arrays(world_.part(), arrays);
    return std::move(arrays.found);
  }
  void add_forces(const OwnForces& own) override { Sim::add_forces(world_.part(), own); }
  double book_forces(const OwnForces& own) override { return Sim::book_forces(world_.part(), own); }
  Index force_numbers() const override { return Sim::force_numbers; }
  Index force_items() const override { return Sim::force_items(world_.part()); }
  std::vector<Table> tables() override {
    look_at_places();
    if constexpr (requires(const World& w, const Sim& sim) { sim.tables(w); })
      return world_.of_whole([this](const World& w) { return sim_.tables(w); });
    return {};
  }

  std::unique_ptr<Method> snapshot() override {
    return world_.apart([this] { return std::unique_ptr<Method>(new SimMethod(*this)); });
  }
  void save(CheckpointWriter& writer) override {
    look_at_places();
    world_.with_whole([&](World& w) { each_stored(w, Saving{writer}); });
  }
  std::vector<std::string> constants() const override {
    if constexpr (requires { Sim::constants(); }) return Sim::constants();
    return {};
  }
  void load(const CheckpointReader* reader) override {
    if (!case_.stages.empty()) take_stage(reader);
    world_.renew([&](World& w) {
      const LoadCheck<World> check(w);
      each_stored(w, Loading{*reader});
      check.refuse_misfits(w);
      derive(w);
    });
    if (!world_.part().servos.empty()) world_.in_both([](World& w) { place_servos(w); });
    if (has_gravity_table()) {
      if (!single_rank())
        at_once(world_.ranks(), [&] { take_from_first(*world_.ranks(), gravity_); });
      world_.in_both([&](World& w) { set_gravity(w, gravity_); });
    }
    if constexpr (requires(World & w) { Sim::restore(w); })
      if (has_fluid(world_.part())) at_once(world_.ranks(), [&] { Sim::restore(world_.part()); });
  }

 private:
  static void require_sound(const Unsound& first) {
    if (first.id != Unsound::none) throw NumericsError(first.text);
  }
  /// Whether something spreads between steps.
  static bool has_fluid(const World& w) {
    if constexpr (requires { Sim::has_fluid(w); }) return Sim::has_fluid(w);
    return false;
  }
  /// A copy whose steps are not booked.
  SimMethod(const SimMethod& other)
      : Method(),
        world_(other.world_),
        sim_(other.sim_),
        probes_(other.probes_),
        lagging_(other.lagging_),
        case_(other.case_),
        now_(other.now_),
        gravity_(other.gravity_),
        spent_(other.spent_) {
    world_.forget_timers();
  }

  template <class Model>
  static World made(const Config& config, const Model& model, const Exec& where) {
    World w = Sim::made(config_at(config, {}), model, where);
    w.servos.resize(Sim::servos_of(config));
    for (std::size_t k = 1; k < config.stages.size();
         ++k) {  // whether each can be, before any runs
      StageProgress later;
      later.index = static_cast<std::int32_t>(k);
      configure(w, config_at(config, later));
    }
    if (config.stages.size() > 1) configure(w, config_at(config, {}));
    return w;
  }

  /// Rigid bodies get the velocities of the step to come, by which theirs now are known.
  void foresee() {
    if constexpr (requires(World & w) { foresee_motions(w); })
      at_once(world_.ranks(), [&] { foresee_motions(world_.part()); });
  }
  /// Of all ranks, with what they have booked, on rank 0.
  Energies energies_of_all() {
    foresee();
    World& w = world_.part();
    Energies all = held_later(w)();
    if (single_rank()) return all;
    Message message;
    put_value(message, all);
    put_value(message, std::exchange(w.ledger, {}));  // rank 0 keeps what has been booked
    all = {};
    for (const Message& told : world_.told(std::move(message))) {
      Unpacking from(told);
      all = all + from.value<Energies>();
      world_.ledger().add(from.value<Ledger>());
    }
    return all;
  }
  /// On rank 0.
  std::vector<double> read_now(const std::vector<ProbeConfig>& probes) {
    foresee();
    World& w = world_.part();
    if (single_rank()) return read_later(w, probes)();
    std::vector<double> values;
    Message message;
    for (const ProbeConfig& p : probes) put_value(message, read_own(w, p));
    std::vector<Readings> all(probes.size());
    for (const Message& told : world_.told(std::move(message))) {
      Unpacking from(told);
      for (Readings& readings : all) readings = readings + from.value<Readings>();
    }
    for (std::size_t i = 0; i < all.size(); ++i) values.push_back(all[i].reduced(probes[i].reduce));
    return values;
  }
  bool has_plates() const {
    bool any = false;
    each_servo(now_, [&](const ServoConfig& servo, std::size_t) { any |= servo.is_plate(); });
    return any;
  }
  /// Every rank finds the same velocities from what all of them push with.
  void correct_all_servos(const std::vector<ServoReading>& more) {
    if (slows(now_)) share_by_rest();
    std::vector<ServoReading> sums = read_servos(world_.part(), now_);
    for (std::size_t k = 0; k < more.size(); ++k) sums[k] = sums[k] + more[k];
    if (!single_rank())
      at_once(world_.ranks(), [&] {
        for (ServoReading& sum : sums) {
          ServoReading all;
          for (const ServoReading& own : from_each(*world_.ranks(), sum)) all = all + own;
          sum = all;
        }
      });
    correct_servos(world_.part(), now_, sums);
  }
  /// Servos that are slowed learn from time to time how far from rest the model is.
  void share_by_rest() {
    constexpr std::int64_t every = 10 * servo_every;
    if (steps() % every != 0) return;
    const EnergyBalance e = energy();
    double share = e.elastic > 0.0 ? e.kinetic / e.elastic : 0.0;
    if (!single_rank()) at_once(world_.ranks(), [&] { take_from_first(*world_.ranks(), share); });
    each_servo(now_, [&](const ServoConfig& servo, std::size_t k) {
      if (servo.slow > 0.0)
        world_.part().servos[k].share = share > servo.slow ? servo.slow / share : 1.0;
    });
  }
  /// Work of gravity is the way along it: where gravity changes, the ledger counts it from here on.
  /// The velocity of a table holds until the next of each servo_every steps, as it is in the middle
  /// of their kicks, each of which counts from half a step before it to half a step after it.
  void change_gravity() {
    const std::int64_t lasts = servo_every - steps() % servo_every;  // first to last kick
    const double middle = time() + 0.5 * static_cast<double>(lasts - 1) * world_.part().next_dt;
    gravity_ = (1.0 / now_.time.mass_scaling) * now_.gravity.at(middle - now_.gravity_begin);
    const auto change = gravity_ - world_.part().given->gravity;
    if (dot(change, change) > 0.0)
      booked([&] { world_.in_both([&](World& w) { set_gravity(w, gravity_); }); });
  }
  /// Counts the energy that a change of the model between two steps puts in as work. What cracks
  /// have spent stays spent: links tell it by their law, which may be another one now.
  template <class Change>
  void booked(const Change& change) {
    const Energies before = energies_of_all();
    change();
    const Energies after = energies_of_all();
    if (!leads(world_.ranks())) return;
    const auto balance = [this](const Energies& all) {
      Ledger ledger = world_.ledger();
      return Sim::balance(ledger, all, steps());
    };
    const EnergyBalance was = balance(before), is = balance(after);
    const double spent = spent_.add(was.fracture - is.fracture, before, after);
    world_.ledger().start_potential.add(was.missing() - (is.missing() + spent));
  }
  /// The stage that a checkpoint is in, on all ranks, and the case as it is then.
  void take_stage(const CheckpointReader* reader) {
    StageProgress now;
    on_first(world_.ranks(), [&] {
      now = reader->value<StageProgress>("stage");
      if (now.index < 0 || static_cast<std::size_t>(now.index) >= case_.stages.size())
        throw CheckpointError("the checkpoint's section stage leads to no stage of the case");
    });
    if (!single_rank()) at_once(world_.ranks(), [&] { take_from_first(*world_.ranks(), now); });
    now_ = config_at(case_, now);
    world_.in_both([&](World& w) {
      w.stage = now;
      configure(w, now_);
      open_around_removed(w);
    });
  }

  template <class Visit>
  void each_stored(World& w, const Visit& visit) {
    if (!case_.stages.empty()) {
      visit("stage", w.stage);
      spent_.each_stored(visit);
    }
    for (std::size_t k = 0; k < w.servos.size(); ++k)
      visit("servos." + std::to_string(k), w.servos[k]);
    visit("step", w.step);
    visit("time", w.time);
    visit("last_dt", w.last_dt);
    visit("next_dt", w.next_dt);
    visit("searches", w.searches);
    visit("ledger", w.ledger);
    lagging_.each_stored(visit);
    if (has_gravity_table()) visit("gravity", gravity_);
    Sim::each_stored(w, visit);
  }

  bool has_gravity_table() const {
    return case_.gravity.is_table() ||
           std::any_of(case_.stages.begin(), case_.stages.end(),
                       [](const auto& stage) { return stage.gravity.is_table(); });
  }
  /// Parts of ranks lead to copies, too: only the whole is looked at.
  void look_at_places() const {
    if (single_rank()) require_places(world_.part());
  }
  bool single_rank() const { return world_.ranks() == nullptr; }

  SharedWorld<World> world_;
  Sim sim_;
  double rounding_;  ///< energy of a step's  [J]
  std::vector<ProbeConfig> probes_;
  LaggingProbes lagging_;
  Config case_;
  Config now_;                                  ///< as it is in the present stage
  decltype(Config{}.gravity.value) gravity_{};  ///< as it acts now  [m/s2]
  SpentOnCracks spent_;
};

}  // namespace breccia
