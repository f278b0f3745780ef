#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "api/field.hpp"
#include "api/guard.hpp"
#include "io/case/suggestion.hpp"
#include "run/machine/exec_choice.hpp"
#include "run/method/method.hpp"

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
  Case of;
  std::unique_ptr<breccia::Method> method;

  /// To the first step at or past `end`; false if stop() ended it before.
  bool advance(const breccia::StopAt& end, const std::function<bool()>& stop, std::int64_t every) {
    const auto reached = [&] { return method->time() >= end.time || method->steps() >= end.step; };
    std::int64_t next_question = method->steps() + every;
    try {
      while (!reached()) {
        const std::int64_t next_look = (method->steps() / verify_every + 1) * verify_every;
        breccia::StopAt next{end.time, std::min(end.step, next_look)};
        if (stop) next.step = std::min(next.step, next_question);
        method->advance(next);
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
        return std::make_unique<State>(State{of, make_method(read, exec, nullptr)});
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

std::vector<Field> Simulation::fields() const {
  std::vector<Field> fields;
  for (breccia::StateArray& array : state_->method->arrays(""))
    fields.push_back(field_of(std::move(array)));
  return fields;
}

Field Simulation::field(const std::string& name) const {
  return guarded([&] {
    if (!name.empty())
      if (auto found = state_->method->arrays(name); !found.empty())
        return field_of(std::move(found.front()));
    std::set<std::string> names;
    for (const breccia::StateArray& array : state_->method->arrays("")) names.insert(array.name);
    throw breccia::InputError(fmt::format("{:?} is no field of the simulation{}", name,
                                          breccia::suggestion(name, names)));
    return Field{};
  });
}

}  // namespace br
