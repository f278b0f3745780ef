#pragma once
// How fast ranks are: what an element costs is estimated, and the processors of one machine differ.

#include <cstdint>

#include "domain/communicator.hpp"

namespace breccia {

/// Time that ranks have spent on their own work in steps since the last re-partition, without
/// waiting. Equal on all ranks.
struct Spent {
  double mean = 0.0, most = 0.0;  ///< of a rank; 0: not measured  [s]
  double sharing = 0.0;           ///< on sharing elements out, last time  [s]

  /// True if waiting for the slowest rank exceeds `imbalance` of the mean work and, in total, twice
  /// the cost of a re-partition.
  bool is_uneven(double imbalance) const {
    constexpr double noise = 5e-3;  // what is shorter is not relied on  [s]
    const double lost = most - mean;
    return mean > noise && lost > imbalance * mean && lost > 2.0 * sharing;
  }
};

/// A rank's pace: how long it takes for what it owns, over what the mean rank does. Whether its
/// processor is slow or its elements cost more than estimated, it should own fewer.
class Pace {
 public:
  static constexpr std::int64_t unit = 64;  ///< that of the mean rank

  /// Between these two the rank takes steps.
  void resume(const Communicator& ranks) { resumed_ = ranks.worked(); }
  void pause(const Communicator& ranks) {
    worked_ = worked(ranks);
    resumed_ = -1.0;
  }

  /// Every rank calls it.
  Spent spent(Communicator& ranks) const;

  /// Takes up how the rank has fared since elements were shared out, where that was long enough.
  /// Every rank calls it, before they are again.
  /// @param load  estimated, that it has had since then  [-]
  void measure(Communicator& ranks, std::int64_t load);
  /// Elements have been shared out.
  /// @param seconds  that it took, or 0 if it will not take as long another time
  void begin_again(const Communicator& ranks, double seconds);

  /// A weight times the pace of this rank: equal sums of weights take equal times.
  std::int64_t weighed(std::int64_t weight) const { return weight * pace_; }

 private:
  double worked(const Communicator& ranks) const {
    return resumed_ < 0.0 ? worked_ : worked_ + (ranks.worked() - resumed_);
  }

  std::int64_t pace_ = unit;
  double worked_ = 0.0;    ///< since elements were shared out last, up to the last pause  [s]
  double resumed_ = -1.0;  ///< worked() of the ranks then; negative: paused  [s]
  double sharing_ = 0.0;
};

}  // namespace breccia
