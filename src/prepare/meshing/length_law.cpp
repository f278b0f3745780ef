#include "prepare/meshing/length_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exec/error.hpp"
#include "math/constants.hpp"

namespace breccia::prepare {

double normal_of(const Random& random, std::uint64_t item, std::uint32_t draw) {
  const double u = random.uniform(item, draw), v = random.uniform(item, draw + 1);
  return std::sqrt(-2.0 * std::log(1.0 - u)) * std::cos(2.0 * pi * v);
}

double LengthLaw::drawn(const Random& random, std::uint64_t item) const {
  constexpr std::uint32_t tries = 1000;
  for (std::uint32_t k = 0; k < tries; ++k) {
    const double l = once(random, item, 10 + 2 * k);
    if (l > 0.0 && l >= least && (most == 0.0 || l <= most)) return l;
  }
  throw InputError("no length between least and most was drawn in 1000 tries");
}

double LengthLaw::once(const Random& random, std::uint64_t item, std::uint32_t draw) const {
  const double u = random.uniform(item, draw);
  if (law == "exponential") return -mean * std::log(1.0 - u);
  if (law == "lognormal") {
    const double ratio = deviation / mean;
    const double square = std::log(1.0 + ratio * ratio);
    return mean * std::exp(std::sqrt(square) * normal_of(random, item, draw) - 0.5 * square);
  }
  if (law == "power") {
    const double power = 1.0 - exponent;
    if (std::abs(power) < 1e-9) return least * std::pow(most / least, u);
    const double low = std::pow(least, power), high = std::pow(most, power);
    return std::clamp(std::pow(low + u * (high - low), 1.0 / power), least, most);
  }
  return mean;
}

double LengthLaw::longest() const {
  return most > 0.0 ? most : law == "constant" ? mean : 10.0 * mean;
}

std::vector<std::string> LengthLaw::problems(const std::string& word) const {
  std::vector<std::string> found;
  const auto require = [&](bool holds, const std::string& text) {
    if (!holds) found.push_back(text);
  };
  if (law == "power") {
    require(least > 0.0 && most > least,
            fmt::format(".{}_law: a power law needs 0 < least < most", word));
    return found;
  }
  require(mean > 0.0, fmt::format(".{} must be above 0", word));
  require(law != "lognormal" || deviation > 0.0,
          fmt::format(".{0}_deviation must be above 0 where {0}_law is lognormal", word));
  require(most == 0.0 || most > least, ".most must be above least");
  require(law != "constant" || (mean >= least && (most == 0.0 || mean <= most)),
          fmt::format(".{} lies outside least and most", word));
  return found;
}

}  // namespace breccia::prepare
