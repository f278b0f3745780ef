#pragma once
// The interface of a method, as the outer loop calls it.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/energy.hpp"
#include "core/servo.hpp"
#include "core/stages.hpp"
#include "core/step_clock.hpp"
#include "io/checkpoint.hpp"
#include "run/frames/frame_output.hpp"
#include "run/method/own_forces.hpp"
#include "run/method/state_array.hpp"

namespace breccia {

/// A named count or number for summary.json, in a section of it ("model", "fracture", "searches",
/// ...).
struct Fact {
  std::string
      path;  ///< e.g. "model.elements", "model.links_by_kind.concrete", "fracture.broken_links"
  double value;
};

/// A table of what a run found, for DIR/<name>.csv.
struct Table {
  std::string name;
  std::vector<std::string> columns, units;
  std::vector<std::vector<double>> rows;
};

/// A running simulation, whatever its method. Of several ranks each makes the same calls; numbers,
/// frames and states come out on rank 0 alone, empty ones on the others.
class Method {
 public:
  Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;
  virtual ~Method() = default;

  /// One time step or, on a device, as many as fit a few hundredths of a second; on several ranks
  /// all of them: to the first one at or past `stop`. @throws NumericsError naming step, time and
  /// element
  virtual Advanced advance(const StopAt& stop) = 0;
  /// Corrects servos and spreads fluids, where they are due after a step. advance() does so; it is
  /// for steps that another method takes together with this one's.
  /// @param more  of each servo, what it touches of the other method; empty: nothing
  virtual void steer(const std::vector<ServoReading>& /*more*/) {}
  /// Around steps that another method takes together with this one's, on ranks: all at once.
  virtual void begin_steps() {}
  virtual void end_steps() {}
  virtual std::int64_t steps() const = 0;  ///< done so far
  virtual double time() const = 0;         ///< simulated  [s]
  virtual double time_step() const = 0;    ///< last taken; at the start the one to come  [s]
  virtual std::int64_t searches() const { return 0; }  ///< for contacts so far

  /// Doubts of set-up about a case that can be run, as sentences; on rank 0.
  virtual std::vector<std::string> warnings() { return {}; }
  /// The rule that limits the time step now, in a word; empty if the method does not tell.
  virtual std::string step_rule() { return {}; }

  /// The stages of the case, in their order.
  virtual std::vector<StageEnd> stages() const { return {}; }
  virtual StageProgress stage() const { return {}; }
  /// Notes where the run is among its stages. A stage that begins changes what it says; the state
  /// stays, and no energy moves that is not booked. Every rank calls it alike.
  virtual void set_stage(const StageProgress&) {}

  virtual EnergyBalance energy() = 0;
  /// Energy that rounding may have given a model so far: errors are not related to less. On rank 0.
  /// [J]
  virtual double rounding() const { return 0.0; }
  /// Values of the case's probes, in their order.  [SI]
  virtual std::vector<double> probes() = 0;
  /// A row of the history is written: bonds that have broken since the last one get its time.
  virtual void note_breaks() {}
  /// Numbers of a row of the history.
  struct Row {
    std::vector<double> probes;
    EnergyBalance energy;
  };
  /// Looks for numbers that went wrong, notes breaks and reads probes and energies; on a device by
  /// launches that follow each other without waiting. @throws NumericsError as verify()
  virtual Row row() {
    verify();
    note_breaks();
    Row now;
    now.probes = probes();
    now.energy = energy();
    return now;
  }
  /// Order-free hash of all element states by global id: equal on any thread or rank count.
  virtual std::uint64_t state_hash() = 0;
  /// Looks for numbers that went wrong. @throws NumericsError naming step, time and element
  virtual void verify() = 0;
  /// The element that moves fastest, as a clause; on rank 0.
  virtual std::string fastest() { return {}; }
  virtual Frame frame() = 0;
  /// The files and the picture of this moment.
  virtual FrameOutput frame_output(const FrameWish& wish) {
    return breccia::frame_output(frame(), wish, 1);
  }
  /// A copy of the state as it is now, for another thread to look at while this one goes on. Null
  /// if one must look now: on the host, on several ranks, or for want of memory.
  virtual std::unique_ptr<Method> snapshot() { return nullptr; }
  virtual std::vector<Fact> facts() = 0;
  /// Of the state as it is: the array of this name or, for an empty one, all of them without their
  /// numbers. Those of the host's memory change with each step, and stay where they are. Of one
  /// rank alone.
  virtual std::vector<StateArray> arrays(const std::string& /*name*/, Wanted = Wanted::on_host) {
    return {};
  }
  /// Lets more forces act beside all others of this moment, in the step to come. Of one rank alone.
  virtual void add_forces(const OwnForces&) {}
  /// Books half the work of forces along the last step: of those of its beginning when it has been
  /// taken, of those of its end when they have been added. Returns it.  [J; in 2D J/m]
  virtual double book_forces(const OwnForces&) { return 0.0; }
  /// Numbers of a force on an item: 3 of an element, 6 of the corners of a triangle; and items.
  virtual Index force_numbers() const { return 0; }
  virtual Index force_items() const { return 0; }
  /// Tables that the end of a run writes.
  virtual std::vector<Table> tables() { return {}; }

  /// Everything the run needs to go on, to and from a checkpoint.
  virtual void save(CheckpointWriter& writer) = 0;
  /// Sections of it that no step and no stage changes.
  virtual std::vector<std::string> constants() const { return {}; }
  /// @param reader  on ranks other than 0 it may be null
  virtual void load(const CheckpointReader* reader) = 0;
};

/// The next act of a run that has looked at a state.
enum class Then : std::uint8_t { steps, end };

/// A copy for another thread where steps go on meanwhile: at the end of a run it would take as much
/// memory as the state, and save no time.
inline std::unique_ptr<Method> snapshot_of(Method& method, Then then) {
  return then == Then::steps ? method.snapshot() : nullptr;
}

}  // namespace breccia
