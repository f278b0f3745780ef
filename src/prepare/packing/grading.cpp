#include "prepare/packing/grading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "math/constants.hpp"

namespace breccia::prepare {
namespace {

double inverse_square(double x) {
  return 1.0 / (x * x);
}

}  // namespace

std::string Grading::problem() const {
  if (sieves.size() != passing.size() || sieves.size() < 2)
    return fmt::format(
        ".sieves has {} sizes and .passing {} shares: a grading curve needs two of each at least, "
        "and as many",
        sieves.size(), passing.size());
  if (!(sieves[0] > 0.0)) return ".sieves: sizes must be above 0";
  for (std::size_t k = 1; k < sieves.size(); ++k) {
    if (!(sieves[k] > sieves[k - 1]))
      return fmt::format(".sieves: {:.6g} m is not above {:.6g} m; sizes grow", sieves[k],
                         sieves[k - 1]);
    if (passing[k] < passing[k - 1])
      return fmt::format(
          ".passing: {:.6g} is below {:.6g}; what passes one sieve passes all larger", passing[k],
          passing[k - 1]);
  }
  if (passing.front() != 0.0 || passing.back() != 1.0)
    return fmt::format(
        ".passing goes from {:.6g} to {:.6g}: nothing passes the first sieve (0), all passes the "
        "last one (1)",
        passing.front(), passing.back());
  return "";
}

double Grading::passes(double diameter) const {
  if (diameter <= sieves.front()) return 0.0;
  if (diameter >= sieves.back()) return 1.0;
  std::size_t k = 0;
  while (diameter > sieves[k + 1]) ++k;
  return passing[k] +
         (diameter - sieves[k]) / (sieves[k + 1] - sieves[k]) * (passing[k + 1] - passing[k]);
}

Grading Grading::part(double from, double to) const {
  const double below = passes(from), share = passes(to) - below;
  Grading part{{from}, {0.0}};
  for (std::size_t k = 0; k < sieves.size(); ++k) {
    if (!(sieves[k] > from && sieves[k] < to)) continue;
    part.sieves.push_back(sieves[k]);
    part.passing.push_back((passing[k] - below) / share);
  }
  part.sieves.push_back(to);
  part.passing.push_back(1.0);
  return part;
}

double Grading::number(std::size_t k) const {
  return (passing[k + 1] - passing[k]) / (sieves[k + 1] - sieves[k]) *
         (inverse_square(sieves[k]) - inverse_square(sieves[k + 1]));
}

double Grading::mean_volume() const {
  double all = 0.0;
  for (std::size_t k = 0; k + 1 < sieves.size(); ++k) all += number(k);
  return pi / (3.0 * all);
}

double Grading::diameter_at(double share) const {
  double all = 0.0;
  for (std::size_t k = 0; k + 1 < sieves.size(); ++k) all += number(k);
  double left = share * all;
  std::size_t k = 0;
  while (k + 2 < sieves.size() && left > number(k)) left -= number(k++);
  const double here = number(k), part = here > 0.0 ? std::clamp(left / here, 0.0, 1.0) : 0.0;
  const double small = inverse_square(sieves[k]), large = inverse_square(sieves[k + 1]);
  return 1.0 / std::sqrt(small - part * (small - large));
}

}  // namespace breccia::prepare
