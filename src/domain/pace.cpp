#include "domain/pace.hpp"

#include <algorithm>
#include <cmath>

namespace breccia {
namespace {

std::int64_t sum_over(Communicator& ranks, std::int64_t number) {
  ranks.add_up({&number, 1});
  return number;
}

}  // namespace

Spent Pace::spent(Communicator& ranks) const {
  const double own = worked(ranks);
  Spent spent;
  spent.mean = 1e-9 * static_cast<double>(sum_over(ranks, std::llround(1e9 * own))) / ranks.size();
  spent.most = -ranks.least(-own);
  spent.sharing = -ranks.least(-sharing_);
  return spent;
}

void Pace::measure(Communicator& ranks, std::int64_t load) {
  constexpr double noise = 5e-3;  // of the mean rank's work: shorter times tell little  [s]
  const double mean = spent(ranks).mean;
  const std::int64_t loads = sum_over(ranks, load);
  if (mean < noise || loads == 0 || load == 0) return;
  const double share = static_cast<double>(load) * ranks.size() / static_cast<double>(loads);
  const double pace = worked(ranks) / (mean * share);
  pace_ = std::llround(static_cast<double>(unit) * std::clamp(pace, 0.25, 4.0));
}

void Pace::begin_again(const Communicator& ranks, double seconds) {
  worked_ = 0.0;
  if (resumed_ >= 0.0) resumed_ = ranks.worked();
  sharing_ = seconds;
}

}  // namespace breccia
