#include "prepare/checks/check_in_situ.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/round_numbers.hpp"
#include "prepare/checks/in_situ.hpp"
#include "prepare/checks/outlines.hpp"
#include "prepare/checks/round_borders.hpp"
#include "prepare/checks/takes_place.hpp"

namespace breccia::prepare {
namespace {

std::string place_text(double x) {
  return x < 0.0 ? "-" + length_text(-x) : x > 0.0 ? length_text(x) : "0 m";
}
constexpr const char* axis_words[] = {"x", "y", "z"};

template <class Config>
class Borders {
 public:
  Borders(const Config& config, const std::string& folder)
      : config_(config), outlines_(outlines_of(config, &folder)) {}

  std::vector<std::string> doubts() {
    if (!config_.in_situ.any() || !find_box()) return {};
    for (std::size_t axis = 0; axis < axes; ++axis) look_for_pull(axis);
    for (std::size_t axis = 0; axis < axes; ++axis)
      for (const bool high : {false, true}) look_at(axis, high);
    return found_;
  }

 private:
  static constexpr std::size_t axes = std::is_same_v<Config, fdem::Config> ? 2 : 3;
  static constexpr int steps = 16;  ///< points along each direction of a side

  bool find_box() {
    box_ = {{no_limit, no_limit, no_limit}, {-no_limit, -no_limit, -no_limit}};
    for (const Outline& o : outlines_) {
      if (o.in_another) continue;
      if (!o.bounds) return false;
      for (std::size_t k = 0; k < 3; ++k) {
        box_.low[k] = std::min(box_.low[k], o.bounds->low[k]);
        box_.high[k] = std::max(box_.high[k], o.bounds->high[k]);
      }
    }
    for (std::size_t k = 0; k < axes; ++k) size_ = std::max(size_, box_.high[k] - box_.low[k]);
    for (int corner = 0; corner < 8; ++corner) {
      Vec3 x;
      for (std::size_t k = 0; k < 3; ++k)
        fdem_shared::part_of(x, static_cast<int>(k)) =
            (corner >> k & 1) != 0 ? box_.high[k] : box_.low[k];
      for (std::size_t k = 0; k < axes; ++k) {
        const double s = stress_across(config_.in_situ, x, k);
        largest_ = std::max(largest_, std::abs(s));
        pull_[k] = std::max(pull_[k], s);
      }
    }
    return size_ > 0.0 && size_ < no_limit;
  }

  void look_for_pull(std::size_t axis) {
    if (!(pull_[axis] > 0.01 * largest_)) return;
    const std::string key = key_across(config_.in_situ, axis);
    const std::string pull = stress_text(pull_[axis]);
    if (key.ends_with("_slope"))
      found_.push_back(
          fmt::format("{}: the stress at the start pulls with up to {} (tension is "
                      "positive); rock under pressure has negative values",
                      key, pull));
    else
      found_.push_back(
          fmt::format("{}: the stress at the start pulls with {} (tension is "
                      "positive); rock under that pressure has \"-{}\"",
                      key, pull, pull));
  }

  /// One side of the box, along an axis.
  void look_at(std::size_t axis, bool high) {
    const double plane = high ? box_.high[axis] : box_.low[axis];
    Side side;
    const std::size_t u = (axis + 1) % axes, v = axes == 3 ? (axis + 2) % axes : 2;
    for (int i = 0; i < steps; ++i)
      for (int j = 0; j < (axes == 3 ? steps : 1); ++j) {
        Vec3 x;
        const auto put = [&](std::size_t k, double value) {
          fdem_shared::part_of(x, static_cast<int>(k)) = value;
        };
        put(axis, plane);
        put(u, box_.low[u] + (i + 0.5) / steps * (box_.high[u] - box_.low[u]));
        if (axes == 3) put(v, box_.low[v] + (j + 0.5) / steps * (box_.high[v] - box_.low[v]));
        look_at(x, axis, high, side);
      }
    tell(axis, plane, side);
  }

  struct Side {
    int points = 0, free = 0;
    double stress = 0.0;  ///< the largest in size that nothing bears  [Pa]
    std::string body;
    bool absorbs = false;
    std::string load;  ///< a pressure of another size
    double pressure = 0.0, wanted = 0.0;
  };

  void look_at(const Vec3& x, std::size_t axis, bool high, Side& side) {
    const Outline* const body = body_at(x, axis, high);
    if (body == nullptr) return;
    ++side.points;
    const double stress = stress_across(config_.in_situ, x, axis), slack = 1e-6 * size_;
    if (std::abs(stress) <= 1e-3 * largest_) return;
    for (const auto& s : config_.supports) {
      const bool holds = s.is_free() || s.servo.is_on() ||
                         std::count(s.fix.begin(), s.fix.end(), axis_words[axis]) > 0;
      if (holds && reaches(s.region, body->name, outlines_, x, slack)) return;
    }
    bool loaded = false, other = false;
    double pressure = 0.0;
    std::string name;
    for (const auto& load : config_.loads) {
      if (!load.dug_by.empty() || !reaches(load.region, body->name, outlines_, x, slack)) continue;
      if (load.kind == "absorbing") {
        side.absorbs = true;
        continue;
      }
      loaded = true;
      if (load.kind != "pressure") other = true;
      pressure += first_pressure(load);
      name = load.name;
    }
    if (loaded) {
      if (other || std::abs(pressure + stress) <= 0.05 * std::abs(stress)) return;
      if (std::abs(stress) < std::abs(side.wanted)) return;
      side.load = name;
      side.pressure = pressure;
      side.wanted = -stress;
      return;
    }
    ++side.free;
    if (std::abs(stress) < std::abs(side.stress)) return;
    side.stress = stress;
    side.body = body->name;
  }

  /// The body of which a side passes through a point of the box; null: none, or it is round.
  const Outline* body_at(const Vec3& x, std::size_t axis, bool high) const {
    const double at[] = {x.x, x.y, x.z}, slack = 1e-6 * size_;
    for (std::size_t i = 0; i < outlines_.size(); ++i) {
      const Outline& o = outlines_[i];
      if (o.in_another || !o.bounds) continue;
      bool within = std::abs((high ? o.bounds->high : o.bounds->low)[axis] - at[axis]) <= slack;
      for (std::size_t k = 0; k < axes; ++k)
        within = within && (k == axis || (at[k] >= o.bounds->low[k] && at[k] <= o.bounds->high[k]));
      if (within && is_box(i)) return &o;
    }
    return nullptr;
  }
  bool is_box(std::size_t i) const {
    const std::string& shape = config_.bodies[i].shape;
    if constexpr (requires { config_.bodies[i].is_turned(); })
      if (config_.bodies[i].is_turned()) return false;
    return shape == "plate" || shape == "beam" || shape == "box";
  }

  void tell(std::size_t axis, double plane, const Side& side) {
    const std::string key = key_across(config_.in_situ, axis), word = axis_words[axis];
    if (50 * side.free > side.points) {
      const std::string share =
          side.free == side.points
              ? "the side"
              : fmt::format("{:.0f} % of the side", 100.0 * side.free / side.points);
      found_.push_back(fmt::format(
          "{}: nothing bears the stress at the start, {}, on {} {} = {} of {}: it {} from the "
          "first step on{}; a support with fix = [\"{}\"] there holds it, or a load of kind "
          "\"pressure\" with pressure = \"{}\"",
          key, stress_text(side.stress), share, word, place_text(plane), side.body,
          side.stress < 0.0 ? "expands" : "shrinks",
          side.absorbs ? " (an absorbing load takes waves up and bears no stress)" : "", word,
          stress_text(-side.stress)));
    }
    if (!side.load.empty())
      found_.push_back(fmt::format(
          "load.{}.pressure: it presses the side {} = {} with {} at the start, and the stress in "
          "situ there is {}: the side moves from the first step on, unless the pressure is {}",
          side.load, word, place_text(plane), stress_text(side.pressure), stress_text(-side.wanted),
          stress_text(side.wanted)));
  }

  const Config& config_;
  std::vector<Outline> outlines_;
  Bounds box_;
  double size_ = 0.0, largest_ = 0.0;
  double pull_[3] = {};
  std::vector<std::string> found_;
};

/// The largest pressure along the axes at a place.  [Pa]
template <class InSitu>
double pressure_at(const InSitu& in_situ, const Vec3& x) {
  constexpr std::size_t axes = std::is_same_v<InSitu, fdem::InSituConfig> ? 2 : 3;
  double most = 0.0;
  for (std::size_t k = 0; k < axes; ++k) most = std::max(most, -stress_across(in_situ, x, k));
  return most;
}

/// The largest pressure at the start in the middle of each body of a material; graded stress in
/// bodies whose middle only a file tells is left out.  [Pa]
template <class Config>
double pressure_in(const Config& config, const std::string& material) {
  const std::vector<Outline> outlines = outlines_of(config, nullptr);
  double most = 0.0;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    if (config.bodies[i].material != material) continue;
    Vec3 middle = fdem_shared::to_space(config.bodies[i].center);
    const bool known = outlines[i].bounds || config.bodies[i].shape == "part";
    if (!known && config.in_situ.graded()) continue;
    if (const auto& b = outlines[i].bounds; b && config.bodies[i].shape != "part")
      middle = {0.5 * (b->low[0] + b->high[0]), 0.5 * (b->low[1] + b->high[1]),
                0.5 * (b->low[2] + b->high[2])};
    most = std::max(most, pressure_at(config.in_situ, middle));
  }
  return most;
}

/// Under a pressure p that stays while elements deform, those of a shear modulus G < p turn inside
/// out: p works wherever their sides turn, and G resists that. A core that bears 2.5 MPa (nu =
/// 0.25) stays at rest with young = 6 MPa, G = 2.4 MPa, and buckles with 5.5 MPa.
template <class Config>
std::vector<std::string> too_soft(const Config& config) {
  std::vector<std::string> problems;
  if (!config.in_situ.any()) return problems;
  for (const auto& m : config.materials) {
    const double pressure = pressure_in(config, m.name);
    double young = m.young, share = 1.0;
    const auto look = [&](const std::string& key) {
      const double needed = 2.0 * (1.0 + m.poisson) * share * pressure;
      if (young > needed || !(needed > 0.0)) return false;
      problems.push_back(fmt::format(
          "{}.young = {} is too soft for the pressure in situ that {} bears, {}: elements whose "
          "shear modulus young / (2 (1 + poisson)) is not above it turn inside out, "
          "whatever the step; it needs more than {}, and 20 times the pressure is soft enough for "
          "a "
          "core that is dug slowly",
          key, stress_text(young), m.name, stress_text(share * pressure), stress_text(needed)));
      return true;
    };
    if (look("material." + m.name)) continue;
    for (const auto& stage : config.stages) {
      const auto change =
          std::find_if(stage.materials.begin(), stage.materials.end(),
                       [&](const auto& of_stage) { return of_stage.name == m.name; });
      if (change == stage.materials.end()) continue;
      if (change->young > 0.0) young = change->young;
      if (change->in_situ >= 0.0) share = change->in_situ;
      if (look("stage." + stage.name + ".material." + m.name)) break;
    }
  }
  return problems;
}

}  // namespace

std::vector<std::string> soft_problems(const fdem::Config& config) {
  return too_soft(config);
}
std::vector<std::string> soft_problems(const fdem3::Config& config) {
  return too_soft(config);
}

std::vector<std::string> doubtful_in_situ(const fdem::Config& config, const std::string& folder) {
  std::vector<std::string> doubts = Borders<fdem::Config>(config, folder).doubts();
  for (std::string& more : doubtful_round_borders(config, folder))
    doubts.push_back(std::move(more));
  return doubts;
}
std::vector<std::string> doubtful_in_situ(const fdem3::Config& config, const std::string& folder) {
  std::vector<std::string> doubts = Borders<fdem3::Config>(config, folder).doubts();
  for (std::string& more : doubtful_round_borders(config, folder))
    doubts.push_back(std::move(more));
  return doubts;
}

}  // namespace breccia::prepare
