#include "run/machine/fast_motion.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/round_numbers.hpp"

namespace breccia {
namespace {

template <class Value>
double largest(const OverTime<Value>& velocity) {
  double most = velocity.is_table() ? 0.0 : norm(velocity.value);
  for (const Value& row : velocity.values) most = std::max(most, norm(row));
  return most;
}

/// Keys of velocities that are too high, as sentences.
class TooFast {
 public:
  explicit TooFast(const Forecast& expected) : expected_(expected) {}

  /// @param path  of the part of a case, or of a stage, with a dot behind it
  template <class Part>
  void add(const Part& part, const std::string& path) {
    if constexpr (requires { part.bodies; })
      for (const auto& body : part.bodies) look(path + "body." + body.name, norm(body.velocity));
    for (const auto& support : part.supports)
      look(path + "support." + support.name, largest(support.velocity));
    if constexpr (requires { part.walls; })
      for (const auto& wall : part.walls) look(path + "wall." + wall.name, largest(wall.velocity));
  }
  template <class Config>
  void add_with_stages(const Config& config) {
    add(config, "");
    for (const auto& stage : config.stages) add(stage, "stage." + stage.name + ".");
  }
  std::vector<std::string> sentences;

 private:
  void look(const std::string& what, double speed) {
    const double way = speed * expected_.step, size = expected_.least;
    if (!(size > 0.0) || !(way > size)) return;
    sentences.push_back(fmt::format(
        "{}.velocity: with {:g} m/s it goes {} in a step of {}, further than the {} of the "
        "smallest element, {}: it passes others unseen, or ends deep inside of them; {:.4g} m/s, "
        "or "
        "time.max_step = \"{}\", is a tenth of that",
        what, speed, length_text(way), time_text(expected_.step), expected_.least_name,
        length_text(size), 0.1 * size / expected_.step, time_text(0.1 * size / speed)));
  }

  const Forecast& expected_;
};

template <class Config>
std::vector<std::string> of_one_method(const Config& config, const Forecast& expected) {
  TooFast found(expected);
  found.add_with_stages(config);
  return found.sentences;
}

}  // namespace

std::vector<std::string> too_fast(const dem::Config& config, const Forecast& expected) {
  return of_one_method(config, expected);
}
std::vector<std::string> too_fast(const fdem::Config& config, const Forecast& expected) {
  return of_one_method(config, expected);
}
std::vector<std::string> too_fast(const fdem3::Config& config, const Forecast& expected) {
  return of_one_method(config, expected);
}
std::vector<std::string> too_fast(const coupled::Config& config, const Forecast& expected) {
  TooFast found(expected);
  found.add(config.spheres, "spheres.");
  found.add(config.tetrahedra, "tetrahedra.");
  for (const coupled::StageConfig& stage : config.stages) {
    found.add(stage.spheres, "stage." + stage.name + ".spheres.");
    found.add(stage.tetrahedra, "stage." + stage.name + ".tetrahedra.");
  }
  return found.sentences;
}

}  // namespace breccia
