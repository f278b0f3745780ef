#pragma once
// A case over values of its keys and seeds: its runs, and the tables and plots of what they show.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/picture/line_plot.hpp"
#include "laboratory/run_result.hpp"
#include "laboratory/side_by_side.hpp"
#include "laboratory/statistics.hpp"

namespace breccia::laboratory {

/// The values that a key takes.
struct SweepAxis {
  std::string key;
  std::vector<std::string> values;  ///< as behind --set KEY=
};

/// From "KEY=A,B,C" or "KEY=A..B:N", N values at even distances from A to B: of every number in A
/// and B, so that "[0, 0, -10]..[0, 0, -40]:4" and "10..40 m/s:4" are ranges, too. Commas within
/// brackets and quotes part no values.
/// @throws InputError if it is neither, or names a value twice
SweepAxis sweep_axis(const std::string& text);

/// One run of a sweep: a value for each axis, and a seed.
struct SweepPoint {
  std::vector<std::string> values;
  std::int64_t seed = 0;

  std::vector<std::string> overrides(const std::vector<SweepAxis>& axes) const;
  /// "velocity=10 seed=2"
  std::string name(const std::vector<SweepAxis>& axes) const;
};

/// The seeds of a sweep: the values of the axis `seed`, which is taken out of `axes`, or, without
/// one, `count` of them from `first` on.
/// @throws InputError if the axis has a value that is no whole number, or `count` is above 1 beside
/// it
std::vector<std::int64_t> sweep_seeds(std::vector<SweepAxis>& axes, std::int64_t first, int count);

/// Every combination of the axes' values, the last axis and then the seeds changing fastest.
/// @throws InputError if they are more than 10,000
std::vector<SweepPoint> sweep_points(const std::vector<SweepAxis>& axes,
                                     const std::vector<std::int64_t>& seeds);

/// The name of a folder for a run: its name, and the first digits of its digest.
std::string run_folder_name(const std::string& name, const std::string& digest);

struct SweepRow {
  SweepPoint point;
  std::string folder;
  FinishedRun run;
  std::optional<RunResult> result;  ///< of a complete run
};

/// Results of the runs of a sweep.
class SweepTable {
 public:
  /// @param measures  paths as RunResult::number takes them; none: every check, what broke, the
  ///                  peak and the last value of each probe, and the error of the ledger
  SweepTable(std::vector<SweepAxis> axes, std::vector<SweepRow> rows,
             std::vector<std::string> measures);

  /// sweep.csv: one line a run.
  std::string csv() const;
  /// sweep.md: mean and deviation over the seeds for each combination of values, then every run.
  std::string markdown(const std::string& title) const;
  /// Means over the first axis with deviations as bars, a plot a measure; without axes the values
  /// of the seeds.
  std::vector<LinePlot> plots() const;

  const std::vector<std::string>& measures() const { return measures_; }
  /// The problem of a measure that no run has, though there are results; empty: none.
  std::string unknown_measure() const;
  /// Over the seeds of each combination of the axes' values.
  struct Group {
    std::vector<std::string> values;
    std::vector<Spread> spreads;  ///< of the measures
  };
  std::vector<Group> groups() const;

 private:
  double value(const SweepRow& row, const std::string& measure) const;
  LinePlot plot_over_seeds(const std::string& measure) const;
  LinePlot plot_over_axis(std::size_t measure, const std::vector<Group>& groups) const;

  std::vector<SweepAxis> axes_;
  std::vector<SweepRow> rows_;
  std::vector<std::string> measures_;
};

}  // namespace breccia::laboratory
