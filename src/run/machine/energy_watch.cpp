#include "run/machine/energy_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exec/error.hpp"

namespace breccia {
namespace {

/// Energy or work that error_relative refers to; 0 if nothing is missing.  [J]
double largest_of(const EnergyBalance& energy) {
  return energy.error_relative > 0.0 ? std::fabs(energy.missing()) / energy.error_relative : 0.0;
}

/// Sums of energies are rounded by 5e-20 J a term (ExactSum): what is missing of less than this
/// much is that.  [J]
constexpr double judged_from = 1e-14;

/// The missing energy of a row over the largest energy or work so far; 0 of a body at rest, and of
/// less than one step moves in the mean: velocities and works lie half a step from positions, so
/// that much of a load that has just begun is not known.
double judged(const EnergyBalance& energy, std::int64_t step) {
  const double of_one_step = 1.0 / static_cast<double>(std::max<std::int64_t>(step, 1));
  const bool unknown = largest_of(energy) < judged_from || energy.error_relative <= of_one_step;
  return unknown ? 0.0 : energy.error_relative;
}

std::string moment(std::int64_t step, double time) {
  return fmt::format("step {}, t = {:.6e} s: ", step, time);
}

[[noreturn]] void refuse(const EnergyBalance& energy, double limit, std::int64_t step,
                         double time) {
  throw NumericsError(fmt::format(
      "{}{:.3g} J of {:.3g} J are missing ({:.2g} of the largest energy or work so far; "
      "energy.stop = {}): a smaller time.safety, or a load that grows more slowly, may help",
      moment(step, time), std::fabs(energy.missing()), largest_of(energy), energy.error_relative,
      limit));
}

}  // namespace

bool is_finite(const EnergyBalance& e) {
  for (const double joules : {e.kinetic, e.elastic, e.fracture, e.plastic, e.friction, e.damping,
                              e.contact, e.work, e.start, e.error_relative})
    if (!std::isfinite(joules)) return false;
  return true;
}

void require_numbers(const EnergyBalance& energy) {
  if (!is_finite(energy))
    throw NumericsError(
        "an energy of an element, link or contact is no number, or beyond "
        "9.2e18 J, the most that can be summed");
}

bool EnergyWatch::look(const EnergyBalance& energy, std::int64_t step, double time) {
  require_numbers(energy);
  const double error = judged(energy, step);
  if (!(limits_.stop > 0.0 && error > limits_.stop)) {
    rows_.above_stop = 0;
  } else if (rows_.above_stop == 0 || error <= faded * began_) {
    rows_.above_stop = 1;
    began_ = error;
  } else {
    ++rows_.above_stop;
  }
  if (rows_.above_stop >= patience) refuse(energy, limits_.stop, step, time);
  const double largest = largest_of(energy);
  if (largest >= 2.0 * rows_.largest && rows_.above_warn < patience) {
    rows_.largest = largest;
    rows_.above_warn = 0;
  }
  rows_.above_warn = limits_.warn > 0.0 && error > limits_.warn ? rows_.above_warn + 1 : 0;
  return rows_.above_warn == patience;
}

void KineticShare::look(const EnergyBalance& energy) {
  kinetic = std::max(kinetic, energy.kinetic);
  work = std::max(work, energy.work + energy.start);
}

bool EnergyWatch::contacts_gave(const EnergyBalance& energy) {
  if (gave_ || !(energy.contact < 0.0) || !(energy.contact_relative > excess)) return false;
  gave_ = true;
  return true;
}

bool EnergyWatch::judge_end(const EnergyBalance& energy, std::int64_t step, double time) const {
  if (limits_.stop > 0.0 && judged(energy, step) > limits_.stop)
    refuse(energy, limits_.stop, step, time);
  return limits_.warn > 0.0 && judged(energy, step) > limits_.warn && rows_.above_warn < patience;
}

}  // namespace breccia
