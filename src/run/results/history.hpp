#pragma once
// history.csv: the energies and probes of a run over its time.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/case_config.hpp"
#include "core/energy.hpp"
#include "run/results/text_file.hpp"

namespace breccia {

/// One row of the history.
struct Sample {
  std::int64_t step = 0;
  double time = 0.0;       ///<  [s]
  double time_step = 0.0;  ///<  [s]
  EnergyBalance energy;    ///<  [J]
  std::vector<double> probes;
  std::string stage;  ///< empty: the case has none
};

/// A CSV file: names in the first line, units in the second, then a row a sample. Numbers carry 17
/// significant digits, so that reading them gives the same bits.
class History {
 public:
  /// Opens the file to append; a new one gets its two head lines. Forces, momenta and energies of a
  /// case in the plane are those of each metre of its thickness: N/m, kg/s, J/m.
  /// @param stages  whether its last column names the stage of each row
  History(const std::string& path, const std::vector<ProbeConfig>& probes, bool in_plane = false,
          bool stages = false);

  /// Rows of later steps than `step` go, of this file or another one that begins so: a run that
  /// goes on from there writes them anew.
  /// @returns the step of the last row that is left; -1: none
  static std::int64_t cut_to(const std::string& path, std::int64_t step);

  /// Value of probe number `probe` at a time, linear between the rows before and after it;
  /// nothing: no rows are so early or so late.
  static std::optional<double> probe_at(const std::string& path, std::size_t probe, double time);

  void write(const Sample& sample);
  void sync() { file_.sync(); }

 private:
  LineFile file_;
};

}  // namespace breccia
