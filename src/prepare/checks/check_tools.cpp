#include "prepare/checks/check_tools.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/round_numbers.hpp"
#include "prepare/checks/outlines.hpp"

namespace breccia::prepare {
namespace {

/// How far two boxes are from each other along the axis along which they are furthest.  [m]
double apart_by(const Bounds& a, const Bounds& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    most = std::max({most, a.low[k] - b.high[k], b.low[k] - a.high[k]});
  return most;
}

/// Whether a support takes all of the body that it is on.
template <class Region>
bool takes_all(const Region& region, const Bounds& body) {
  if (region.outside || region.radius > 0.0 || !region.polygon.empty()) return false;
  if constexpr (requires { region.edges; }) {
    if (!region.edges.empty()) return false;
  } else {
    if (!region.faces.empty()) return false;
  }
  const Vec3 low = fdem_shared::to_space(region.min), high = fdem_shared::to_space(region.max);
  for (int k = 0; k < (
                          requires { region.min.z; } ? 3 : 2);
       ++k)
    if (fdem_shared::part_of(low, k) > body.low[at(k)] ||
        fdem_shared::part_of(high, k) < body.high[at(k)])
      return false;
  return true;
}

/// Whether something moves it, at the start or later.
template <class Support>
bool is_led(const Support& s) {
  using fdem_shared::squared;
  return s.is_free() || s.servo.is_on() || s.velocity.is_table() || s.spin.is_table() ||
         squared(s.velocity.value) > 0.0 || squared(s.spin.value) > 0.0;
}

template <class Config>
std::vector<std::string> tools_apart(const Config& config, const std::string& folder) {
  const std::vector<Outline> outlines = outlines_of(config, &folder);
  std::vector<std::string> doubts;
  for (const auto& s : config.supports) {
    bool moves = is_led(s);
    for (const auto& stage : config.stages)
      for (const auto& change : stage.supports) moves |= change.name == s.name && is_led(change);
    const auto own = std::find_if(outlines.begin(), outlines.end(),
                                  [&](const Outline& o) { return o.name == s.region.on; });
    if (!moves || own == outlines.end() || own->in_another || !own->bounds ||
        !takes_all(s.region, *own->bounds))
      continue;
    const Outline* nearest = nullptr;
    double least = no_limit;
    for (const Outline& other : outlines) {
      if (&other == &*own || other.in_another) continue;
      const double away = other.bounds ? apart_by(*own->bounds, *other.bounds) : 0.0;
      if (away >= least) continue;
      least = away;
      nearest = &other;
    }
    if (nearest != nullptr && least > 1e-9)
      doubts.push_back(
          fmt::format("support.{}.on: {}, which it holds as a whole, touches no body at the start; "
                      "{} is nearest, {} away",
                      s.name, own->name, nearest->name, length_text(least)));
  }
  return doubts;
}

}  // namespace

std::vector<std::string> doubtful_tools(const fdem::Config& config, const std::string& folder) {
  return tools_apart(config, folder);
}
std::vector<std::string> doubtful_tools(const fdem3::Config& config, const std::string& folder) {
  return tools_apart(config, folder);
}

}  // namespace breccia::prepare
