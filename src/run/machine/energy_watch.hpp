#pragma once
// A run whose energies do not add up is no result.

#include <cstdint>
#include <string>

#include "core/case_config.hpp"
#include "core/energy.hpp"

namespace breccia {

/// Judges the rows of the history by their error_relative: what is missing over the largest energy
/// or work so far. A row alone says nothing: at the start of a load both are as small as what the
/// scheme rounds (15 % of 4e-10 J in the first row of a bending test that ends at 1 J), and such an
/// error fades. One that stays for `patience` rows, a fortieth of the usual 1000, or to the end of
/// the case, does not. Rows that call for a warning are counted anew when the largest energy has
/// doubled: what is missing of the energies at the start of a load is little of those that follow.
/// The limit that ends a run counts anew when the error has faded by a tenth: what the first touch
/// of a servo's wall has missed stays, while energies grow beyond it. Energies below 1e-14 J, a
/// body at rest, are not judged; nor is less than the mean of what a step has moved, the largest
/// energy over the number of steps: after n steps that is a share of 1/n, and of no weight beyond
/// 1/stop and 1/warn steps.
class EnergyWatch {
 public:
  static constexpr std::int64_t patience = 25;  ///< rows
  static constexpr double faded = 0.9;          ///< of the error with which rows were counted  [-]

  /// Rows in succession above a limit; part of the record's state.
  struct Rows {
    std::int64_t above_warn = 0, above_stop = 0;
    double largest = 0.0;  ///< energy or work, where the count of above_warn began  [J]
  };

  explicit EnergyWatch(const EnergyConfig& limits) : limits_(limits) {}
  /// @param began  as began() of the run before
  EnergyWatch(const EnergyConfig& limits, const Rows& rows, double began)
      : limits_(limits), rows_(rows), began_(began) {}

  /// Whether a row calls for a warning. @throws NumericsError if the run must end, or if an energy
  /// is too large to be summed
  bool look(const EnergyBalance& energy, std::int64_t step, double time);
  /// Whether the end of a case calls for a warning that its rows have not given; one row is
  /// enough. @throws NumericsError if the case has failed
  bool judge_end(const EnergyBalance& energy, std::int64_t step, double time) const;

  /// Whether contacts have given out more than they took up, for the first time beyond `excess` of
  /// the largest energy.
  bool contacts_gave(const EnergyBalance& energy);
  static constexpr double excess = 0.01;  ///<  [-]

  const Rows& rows() const { return rows_; }
  /// Error of the row with which the count of above_stop began.  [-]
  double began() const { return began_; }

 private:
  EnergyConfig limits_;
  Rows rows_;
  double began_ = 0.0;
  bool gave_ = false;
};

/// The largest kinetic energy of a run over the largest work done on it: small if it was
/// quasi-static. A body that breaks throws pieces, and then it is not.
struct KineticShare {
  double kinetic = 0.0, work = 0.0;  ///< the largest so far; work with the energy at the start  [J]

  void look(const EnergyBalance& energy);
  double value() const { return work > 0.0 ? kinetic / work : 0.0; }
};

/// Whether all of them are numbers.
bool is_finite(const EnergyBalance& energy);
/// @throws NumericsError if one is none
void require_numbers(const EnergyBalance& energy);

}  // namespace breccia
