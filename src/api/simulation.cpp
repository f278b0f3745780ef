#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "api/field.hpp"
#include "api/guard.hpp"
#include "exec/device.hpp"
#include "io/case/suggestion.hpp"
#include "run/machine/exec_choice.hpp"
#include "run/method/method.hpp"
#include "run/stage_control.hpp"

namespace br {
namespace {

/// Steps from one look at the numbers to the next, as in a run of the program.
constexpr std::int64_t verify_every = 1000;

/// The error with step and time, where a law that met it knew none.
[[noreturn]] void throw_located(const breccia::Method& method, const breccia::Error& error) {
  const std::string text = error.what();
  if (text.starts_with("step ")) throw Error(error.exit_code(), text);
  throw Error(error.exit_code(),
              fmt::format("step {}, t = {:.6e} s: {}", method.steps(), method.time(), text));
}

}  // namespace

struct Simulation::State {
  /// A force of the caller's.
  struct Term {
    ForceLaw law;
    breccia::OwnForces now;  ///< that act now
    double work = 0.0;       ///<  [J; in 2D J/m]
  };

  Case of;
  std::unique_ptr<breccia::Method> method;
  breccia::StageControl stages;
  std::vector<Term> terms;
  bool asking = false;  ///< a law is being asked

  State(const Case& read, std::unique_ptr<breccia::Method> made)
      : of(read),
        method(std::move(made)),
        stages(*method, read.read().read.common().probes, "", nullptr) {}

  Field field(const std::string& name, breccia::Wanted where) const;
  /// Lets a force act in the step to come.
  void ask(Term& term) {
    const auto each = static_cast<std::size_t>(method->force_numbers());
    std::vector<double> numbers(each * term.now.items.size());
    asking = true;
    try {
      term.law(numbers);
    } catch (...) {
      asking = false;
      throw;
    }
    asking = false;
    refuse_misfits(term, numbers, each);
    term.now.numbers = std::move(numbers);
    method->add_forces(term.now);
    term.work += method->book_forces(term.now);
  }
  static void refuse_misfits(const Term& term, const std::vector<double>& numbers,
                             std::size_t each) {
    if (numbers.size() != each * term.now.items.size())
      throw breccia::InputError(fmt::format("a force of your own has {} numbers for {} items of {}",
                                            numbers.size(), term.now.items.size(), each));
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (!std::isfinite(numbers[i]))
        throw breccia::InputError(
            fmt::format("a force of your own is not finite on item {}", term.now.items[i / each]));
  }
  void take_steps(breccia::StopAt stop) {
    if (asking) throw breccia::InputError("a force of your own cannot take steps");
    if (!terms.empty()) stop.step = std::min(stop.step, method->steps() + 1);
    method->advance(stop);
    for (Term& term : terms) {
      term.work += method->book_forces(term.now);
      std::fill(term.now.numbers.begin(), term.now.numbers.end(), 0.0);
    }
    for (Term& term : terms) ask(term);
    stages.look();
  }
  /// To the first step at or past `end`; false if stop() ended it before.
  bool advance(const breccia::StopAt& end, const std::function<bool()>& stop, std::int64_t every) {
    const auto reached = [&] {
      return method->time() >= end.time || method->steps() >= end.step || stages.finished();
    };
    std::int64_t next_question = method->steps() + every;
    try {
      while (!reached()) {
        const std::int64_t next_look = (method->steps() / verify_every + 1) * verify_every;
        breccia::StopAt next{end.time, std::min(end.step, next_look)};
        if (stop) next.step = std::min(next.step, next_question);
        take_steps(stages.limited(next));
        if (method->steps() % verify_every == 0) method->verify();
        if (!stop || method->steps() < next_question) continue;
        if (stop()) return false;
        next_question = method->steps() + every;
      }
    } catch (const breccia::NumericsError& error) {
      throw_located(*method, error);
    } catch (const breccia::Error& error) {
      throw Error(error.exit_code(), error.what());
    }
    return true;
  }
};

Simulation::Simulation(const Case& of, const Options& options)
    : state_(guarded([&] {
        const breccia::Case& read = of.read().read;
        if (!options.allow_scripts) refuse_scripts(read);
        const breccia::Exec exec = breccia::exec_on(options.device, options.threads, nullptr);
        return std::make_unique<State>(of, make_method(read, exec, nullptr));
      })) {
  guarded([&] { state_->method->verify(); });
}
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;
Simulation::~Simulation() = default;

void Simulation::step(std::int64_t count) {
  breccia::StopAt end;
  end.step = state_->method->steps() + count;
  state_->advance(end, {}, count);
}

bool Simulation::run(double until, const std::function<bool()>& stop, std::int64_t every) {
  breccia::StopAt end;
  end.time = until;
  const bool reached = state_->advance(end, stop, std::max<std::int64_t>(every, 1));
  guarded([&] { state_->method->verify(); });
  return reached;
}

double Simulation::time() const {
  return state_->method->time();
}
std::int64_t Simulation::steps() const {
  return state_->method->steps();
}
double Simulation::time_step() const {
  return state_->method->time_step();
}
std::vector<std::string> Simulation::warnings() const {
  return state_->method->warnings();
}

std::map<std::string, double> Simulation::energies() const {
  return guarded([&]() -> std::map<std::string, double> {
    const breccia::EnergyBalance e = state_->method->energy();
    return {{"kinetic", e.kinetic},   {"elastic", e.elastic},
            {"fracture", e.fracture}, {"plastic", e.plastic},
            {"friction", e.friction}, {"damping", e.damping},
            {"contact", e.contact},   {"work", e.work},
            {"start", e.start},       {"error_relative", e.error_relative}};
  });
}

std::map<std::string, double> Simulation::probes() const {
  return guarded([&] {
    std::map<std::string, double> values;
    const std::vector<double> read = state_->method->probes();
    const auto& probes = state_->of.read().read.common().probes;
    for (std::size_t i = 0; i < probes.size(); ++i) values[probes[i].name] = read[i];
    return values;
  });
}

std::map<std::string, double> Simulation::facts() const {
  return guarded([&] {
    std::map<std::string, double> facts;
    for (const breccia::Fact& fact : state_->method->facts()) facts[fact.path] = fact.value;
    return facts;
  });
}

std::string Simulation::hash() const {
  return guarded([&] { return fmt::format("{:016x}", state_->method->state_hash()); });
}

std::vector<Stage> Simulation::stages() const {
  std::vector<Stage> all;
  for (const breccia::StageRecord& s : state_->stages.records())
    all.push_back({s.name, s.begin, s.end, s.ended_by});
  return all;
}

int Simulation::add_force(std::vector<std::int64_t> items, ForceLaw law) {
  return guarded([&] {
    if (state_->asking) throw breccia::InputError("a force of your own cannot add another");
    State::Term term{std::move(law), {}, 0.0};
    const std::int64_t count = state_->method->force_items();
    for (const std::int64_t item : items) {
      if (item < 0 || item >= count)
        throw breccia::InputError(
            fmt::format("a force of your own acts on item {}, there are 0 to {}", item, count - 1));
      term.now.items.push_back(static_cast<breccia::Index>(item));
    }
    state_->ask(term);
    state_->terms.push_back(std::move(term));
    return static_cast<int>(state_->terms.size()) - 1;
  });
}
double Simulation::work_of_force(int number) const {
  return state_->terms.at(static_cast<std::size_t>(number)).work;
}
std::int64_t Simulation::items() const {
  return state_->method->force_items();
}

std::vector<Field> Simulation::fields() const {
  std::vector<Field> fields;
  for (breccia::StateArray& array : state_->method->arrays(""))
    fields.push_back(field_of(std::move(array)));
  return fields;
}

Field Simulation::field(const std::string& name) const {
  return state_->field(name, breccia::Wanted::on_host);
}
Field Simulation::field_there(const std::string& name) const {
  Field field = state_->field(name, breccia::Wanted::where_they_lie);
  if (field.gpu >= 0) guarded([] { breccia::wait_for_device(); });
  return field;
}
Field Simulation::State::field(const std::string& name, breccia::Wanted where) const {
  return guarded([&] {
    if (!name.empty())
      if (auto found = method->arrays(name, where); !found.empty())
        return field_of(std::move(found.front()));
    std::set<std::string> names;
    for (const breccia::StateArray& array : method->arrays("")) names.insert(array.name);
    throw breccia::InputError(fmt::format("{:?} is no field of the simulation{}", name,
                                          breccia::suggestion(name, names)));
    return Field{};
  });
}

}  // namespace br
