#include "dem/setup/supports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/most_names.hpp"
#include "core/region.hpp"
#include "dem/setup/config.hpp"
#include "exec/error.hpp"
#include "exec/filling.hpp"

namespace breccia::dem {
namespace {

constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

std::uint8_t fixed_bits(const SupportConfig& support) {
  static const std::map<std::string, int> words{
      {"x", fixed_x},           {"y", fixed_y},           {"z", fixed_z}, {"spin_x", fixed_spin_x},
      {"spin_y", fixed_spin_y}, {"spin_z", fixed_spin_z}, {"all", 63}};
  int bits = 0;
  for (const std::string& word : support.fix) {
    const auto found = words.find(word);
    if (found == words.end())
      throw InputError(
          "support " + support.name + ": '" + word +
          "' is no degree of freedom; allowed are x, y, z, spin_x, spin_y, spin_z, all");
    bits |= found->second;
  }
  return static_cast<std::uint8_t>(bits);
}

std::vector<Index> members_of(const SupportConfig& s, const Model& m, int threads) {
  const auto holds = [&](Index e) {
    if (!s.on.empty() && m.groups[static_cast<std::size_t>(m.group[at(e)])] != s.on) return false;
    const Vec3& x = m.position[at(e)];
    bool inside = x.x >= s.min.x && x.y >= s.min.y && x.z >= s.min.z && x.x <= s.max.x &&
                  x.y <= s.max.y && x.z <= s.max.z;
    if (s.radius > 0.0) inside = inside && in_round(s.center, s.radius, s.around, x);
    if (!s.polygon.empty()) inside = inside && in_polygon(s.polygon, seen_along(s.around, x));
    return inside != s.outside;
  };
  std::vector<Index> members;
  copy_to(members, numbers_where(threads, m.size(), holds));
  return members;
}

/// How far a point lies outside of a region that is a box, a cylinder or a sphere.  [m]
double distance_to(const SupportConfig& s, const Vec3& x) {
  const Vec3 beside{std::max({s.min.x - x.x, x.x - s.max.x, 0.0}),
                    std::max({s.min.y - x.y, x.y - s.max.y, 0.0}),
                    std::max({s.min.z - x.z, x.z - s.max.z, 0.0})};
  if (!(s.radius > 0.0)) return norm(beside);
  Vec3 out = x - s.center;
  if (s.around == "x") out.x = 0.0;
  if (s.around == "y") out.y = 0.0;
  if (s.around == "z") out.z = 0.0;
  return std::max(norm(beside), norm(out) - s.radius);
}

/// "; the nearest, at (x, y, z) m, is 0.001 m away and has a radius of ..."; empty where a polygon
/// or what lies outside is asked for.
std::string nearest_element(const SupportConfig& s, const Model& m) {
  if (s.outside || !s.polygon.empty()) return "";
  double least = no_limit;
  std::size_t nearest = 0;
  for (std::size_t e = 0; e < m.position.size(); ++e) {
    if (!s.on.empty() && m.groups[static_cast<std::size_t>(m.group[e])] != s.on) continue;
    if (const double away = distance_to(s, m.position[e]); away < least) {
      least = away;
      nearest = e;
    }
  }
  if (!(least < no_limit)) return "";
  const Vec3& x = m.position[nearest];
  return fmt::format(
      "; the nearest, at ({:.4g}, {:.4g}, {:.4g}) m, is {:.3g} m away (radius {:.3g} m)", x.x, x.y,
      x.z, least, m.radius[nearest]);
}

[[noreturn]] void refuse_supports(const std::vector<std::string>& problems) {
  std::string text = fmt::format("{} problem{} with the supports; nothing was run.",
                                 problems.size(), problems.size() == 1 ? "" : "s");
  for (const std::string& problem : problems) text += "\n  " + problem;
  throw InputError(text);
}

/// Gives each direction of each element to the supports that prescribe it.
class Holding {
 public:
  Holding(const Config& config, std::vector<std::vector<Index>> members, std::size_t elements,
          const std::vector<Vec3>& dashpots, const std::vector<double>& masses)
      : supports_(config.supports),
        dashpots_(dashpots),
        masses_(masses),
        walls_(config.walls.size()) {
    all_.fixed.assign(elements, fixed_none);
    all_.motion.assign(elements, -1);
    all_.members = std::move(members);
    for (const std::vector<Index>& own : all_.members)
      held_.insert(held_.end(), own.begin(), own.end());
    std::sort(held_.begin(), held_.end());
    held_.erase(std::unique(held_.begin(), held_.end()), held_.end());
    owners_.assign(held_.size(), {-1, -1, -1});
    for (std::size_t s = 0; s < supports_.size(); ++s) {
      const std::uint8_t bits = fixed_bits(supports_[s]);
      for (const Index e : all_.members[s]) hold(s, bits, static_cast<std::size_t>(e));
    }
    for (const auto& [clash, found] : clashes_) tell(clash, found);
    if (!problems_.empty()) refuse_supports(problems_);
  }

  Prescribed prescribed() {
    std::map<Owners, std::int16_t> known;  // combinations of supports that move
    for (std::size_t k = 0; k < held_.size(); ++k) {
      Owners moving = owners_[k];
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (moving[axis] >= 0 && speed(moving[axis], axis).is_zero() &&
            !is_servo(moving[axis], axis) && !rubs(moving[axis]))
          moving[axis] = -1;
      if (moving == Owners{-1, -1, -1}) continue;
      const auto next = static_cast<std::int16_t>(all_.motions.motions.size());
      const auto [entry, is_new] = known.try_emplace(moving, next);
      if (is_new) {
        all_.motions.add(motion_of(moving), is_load(moving) ? 1 : 0, friction_of(moving));
        for (std::size_t axis = 0; axis < 3; ++axis)
          if (moving[axis] >= 0 && is_servo(moving[axis], axis))
            all_.motions.servos.push_back(
                {walls_ + static_cast<std::size_t>(moving[axis]), next, static_cast<int>(axis)});
      }
      all_.motion[at(held_[k])] = entry->second;
    }
    return std::move(all_);
  }

 private:
  using Owners = std::array<int, 3>;  ///< the support that prescribes x, y, z, or -1
  struct Clash {
    int first, second;
    std::size_t axis;
    auto operator<=>(const Clash&) const = default;
  };
  struct Found {
    int elements = 0;
    std::size_t first = 0;
  };

  Owners& owners_of(std::size_t e) {
    const auto found = std::lower_bound(held_.begin(), held_.end(), static_cast<Index>(e));
    return owners_[static_cast<std::size_t>(found - held_.begin())];
  }
  const SupportConfig& support(int s) const { return supports_[static_cast<std::size_t>(s)]; }
  bool is_servo(int s, std::size_t axis) const {
    const SupportServoConfig& servo = support(s).servo;
    return servo.is_on() && servo.axis_number() == static_cast<int>(axis);
  }
  /// Of an absorbing support: its dashpot.
  ScaledAmplitude speed(int s, std::size_t axis) const {
    if (is_servo(s, axis)) return {};
    if (support(s).absorbs()) {
      const Vec3& c = dashpots_[static_cast<std::size_t>(s)];
      return {axis == 0 ? c.x : axis == 1 ? c.y : c.z, {}};
    }
    const auto given = [&](const OverTime<Vec3>& of) {
      return scaled_amplitude(of, static_cast<int>(axis), support(s).ramp, support(s).begin);
    };
    if (!support(s).pushes()) return given(support(s).velocity);
    ScaledAmplitude force = given(support(s).force);
    force.scale /= masses_[static_cast<std::size_t>(s)];
    return force;
  }
  bool is_load(const Owners& owners) const {
    return std::any_of(owners.begin(), owners.end(),
                       [&](int s) { return s >= 0 && support(s).pushes(); });
  }
  bool rubs(int s) const { return support(s).friction > 0.0; }
  double friction_of(const Owners& owners) const {
    double most = 0.0;
    for (const int s : owners)
      if (s >= 0) most = std::max(most, support(s).friction);
    return most;
  }
  /// Its elements are free, but for dashpots or a load.
  bool is_driven(int s) const { return support(s).absorbs() || support(s).pushes(); }
  bool alike(int a, int b, std::size_t axis) const {
    const ScaledAmplitude of_a = speed(a, axis), of_b = speed(b, axis);
    if (is_servo(a, axis) || is_servo(b, axis)) return a == b;
    if (is_driven(a) || is_driven(b)) return a == b;
    return of_a == of_b || (of_a.is_zero() && of_b.is_zero());
  }
  std::string motion_text(int s, std::size_t axis) const {
    if (is_servo(s, axis)) return "a servo";
    if (support(s).absorbs()) return "a dashpot";
    if (support(s).pushes()) return "a force";
    const ScaledAmplitude of = speed(s, axis);
    return fmt::format("{} m/s with a ramp of {} s",
                       of.amplitude.times.empty() ? fmt::format("{}", of.scale) : "a table of",
                       of.amplitude.ramp);
  }

  void hold(std::size_t s, std::uint8_t bits, std::size_t e) {
    const bool pushes = support(static_cast<int>(s)).pushes();
    if (pushes) bits = fixed_x | fixed_y | fixed_z;
    const int all = is_driven(static_cast<int>(s)) ? ((bits & 7) != 0 ? fixed_driven : 0) : bits;
    const int rubbed = rubs(static_cast<int>(s)) && (bits & 7) != 0 ? fixed_driven : 0;
    note_rubbed(s, bits, e);
    all_.fixed[e] = static_cast<std::uint8_t>(all_.fixed[e] | all | rubbed);
    note_mixed(s, e);
    Owners& owners = owners_of(e);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if ((bits >> axis & 1) == 0) continue;
      int& owner = owners[axis];
      const int own = static_cast<int>(s);
      if (owner < 0) owner = own;
      if (alike(owner, own, axis)) continue;
      Found& found = clashes_[{owner, own, axis}];
      if (found.elements++ == 0) found.first = e;
    }
  }

  void tell(const Clash& clash, const Found& found) {
    const SupportConfig &a = support(clash.first), &b = support(clash.second);
    problems_.push_back(fmt::format(
        "supports {} and {} both prescribe {} of {} element{} (the first is element {}): {}, and "
        "{}; supports that share elements must prescribe other directions, or the same motion",
        a.name, b.name, axis_names[clash.axis], found.elements, found.elements == 1 ? "" : "s",
        found.first, motion_text(clash.first, clash.axis), motion_text(clash.second, clash.axis)));
  }

  std::array<ScaledAmplitude, 3> motion_of(const Owners& owners) const {
    std::array<ScaledAmplitude, 3> velocity;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (owners[axis] >= 0) velocity[axis] = speed(owners[axis], axis);
    return velocity;
  }

  /// One platen alone holds an element that it rubs: the other two directions are its friction's.
  void note_rubbed(std::size_t s, int bits, std::size_t e) {
    const auto rubbing = [&](int owner) { return owner >= 0 && rubs(owner); };
    const Owners& owners = owners_of(e);
    const int own = static_cast<int>(s);
    const auto* const rough = std::find_if(owners.begin(), owners.end(), rubbing);
    if ((bits & 7) == 0 || (rough == owners.end() && !rubs(own))) return;
    const auto* const other =
        std::find_if(owners.begin(), owners.end(), [](int owner) { return owner >= 0; });
    if (other == owners.end()) return;
    tell_once(own, fmt::format("support {}: a platen with friction shares element {} with support "
                               "{}, which holds it, too",
                               support(own).name, e, support(*other).name));
  }
  void tell_once(int s, const std::string& text) {
    if (problems_.empty() || !problems_.back().starts_with("support " + support(s).name))
      problems_.push_back(text);
  }

  /// An element has dashpots, or is held.
  void note_mixed(std::size_t s, std::size_t e) {
    if ((all_.fixed[e] & fixed_driven) == 0 || (all_.fixed[e] & 63) == 0) return;
    const auto drives = [&](int owner) { return owner >= 0 && is_driven(owner); };
    const Owners& owners = owners_of(e);
    if (!drives(static_cast<int>(s)) && std::none_of(owners.begin(), owners.end(), drives)) return;
    const auto pushes = [&](int owner) { return owner >= 0 && support(owner).pushes(); };
    const bool load = std::any_of(owners.begin(), owners.end(), pushes) || supports_[s].pushes();
    const std::string text =
        fmt::format("support {}: {} shares element {} with one that holds it", supports_[s].name,
                    load ? "one with a force" : "an absorbing support", e);
    tell_once(static_cast<int>(s), text);
  }

  const std::vector<SupportConfig>& supports_;
  const std::vector<Vec3>& dashpots_;
  const std::vector<double>& masses_;
  std::size_t walls_;
  std::vector<Index> held_;     ///< elements of any support, ascending
  std::vector<Owners> owners_;  ///< of each of them
  std::map<Clash, Found> clashes_;
  std::vector<std::string> problems_;
  Prescribed all_;
};

/// x, y and z of `given` where bits 0, 1 and 2 are set, else of `own`.
Vec3 chosen(int bits, const Vec3& given, const Vec3& own) {
  return {(bits & 1) != 0 ? given.x : own.x, (bits & 2) != 0 ? given.y : own.y,
          (bits & 4) != 0 ? given.z : own.z};
}

}  // namespace

bool GivenMotions::moves(std::size_t motion) const {
  const Motion& m = motions[motion];
  for (const ServoMotion& servo : servos)
    if (static_cast<std::size_t>(servo.motion) == motion) return true;
  const auto any = [&](double scale, const AmplitudeTable& of) {
    if (scale == 0.0) return false;
    return of.first == of.end ||
           std::any_of(tables.factors.begin() + of.first, tables.factors.begin() + of.end,
                       [](double factor) { return factor != 0.0; });
  };
  return any(m.velocity.x, m.x) || any(m.velocity.y, m.y) || any(m.velocity.z, m.z);
}

std::int16_t GivenMotions::add(const std::array<ScaledAmplitude, 3>& velocity, std::int32_t load,
                               double friction) {
  if (motions.size() >=
      most_names)  // supports that share elements move in more ways than there are
    throw InputError(fmt::format("walls and supports move in more than {} ways", most_names));
  motions.push_back({{velocity[0].scale, velocity[1].scale, velocity[2].scale},
                     tables.append(velocity[0].amplitude),
                     tables.append(velocity[1].amplitude),
                     tables.append(velocity[2].amplitude),
                     load,
                     friction});
  return static_cast<std::int16_t>(motions.size() - 1);
}

Vec3 Prescribed::velocity_at_start(std::size_t element, const Vec3& own) const {
  const std::int16_t way = motion[element];
  const Vec3 given = way >= 0 ? motions.velocity(static_cast<std::size_t>(way), 0.0) : Vec3{};
  return chosen(fixed[element], given, own);
}
Vec3 Prescribed::spin_at_start(std::size_t element, const Vec3& own) const {
  return chosen(fixed[element] >> 3, {}, own);
}

std::vector<std::vector<Index>> support_members(const Config& config, const Model& model,
                                                int threads) {
  std::vector<std::vector<Index>> members;
  std::vector<std::string> problems;
  for (const SupportConfig& support : config.supports) {
    members.push_back(members_of(support, model, threads));
    if (members.back().empty())
      problems.push_back(
          "support " + support.name +
          " holds no element: a region takes those whose centres are in it, which lie a radius and "
          "more inside of a body's faces" +
          nearest_element(support, model));
  }
  if (!problems.empty()) refuse_supports(problems);
  return members;
}

std::vector<Index> tied_members(const Model& model, const std::vector<Index>& members) {
  std::vector<std::uint8_t> held(model.position.size(), 0), tied(model.position.size(), 0);
  for (const Index e : members) held[at(e)] = 1;
  for (const Model::Link& link : model.links) {
    if (link.parted || held[at(link.a)] == held[at(link.b)]) continue;
    tied[at(held[at(link.a)] != 0 ? link.a : link.b)] = 1;
  }
  std::vector<Index> found;
  for (const Index e : members)
    if (tied[at(e)] != 0) found.push_back(e);
  return found;
}

Prescribed prescribed(const Config& config, std::vector<std::vector<Index>> members,
                      std::size_t elements, const std::vector<Vec3>& dashpots,
                      const std::vector<double>& masses) {
  return Holding(config, std::move(members), elements, dashpots, masses).prescribed();
}

std::vector<Vec3> dashpots_of(const Config& config, const Model& model,
                              const std::vector<std::vector<Index>>& members) {
  std::vector<Vec3> all(config.supports.size());
  for (std::size_t s = 0; s < all.size(); ++s) {
    const SupportConfig& support = config.supports[s];
    if (!support.absorbs() || members[s].empty()) continue;
    const auto material_of = [&](Index e) {
      return static_cast<std::size_t>(model.material[static_cast<std::size_t>(e)]);
    };
    const MaterialConfig& m = config.materials[material_of(members[s].front())];
    double squares = 0.0;
    for (const Index e : members[s]) {
      const double radius = model.radius[static_cast<std::size_t>(e)];
      squares += radius * radius;
      if (config.materials[material_of(e)].name != m.name)
        throw InputError(fmt::format(
            "support {}: an absorbing face is of one material; it has elements of {} and {}",
            support.name, m.name, config.materials[material_of(e)].name));
    }
    const double density = config.time.mass_scaling * m.density, nu = m.poisson;
    const double along =
        support.wave == "bar" ? m.young : m.young * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
    const double across = m.young / (2.0 * (1.0 + nu)), share = support.area / squares;
    const double p = std::sqrt(density * along) * share, q = std::sqrt(density * across) * share;
    all[s] = {support.absorb == "x" ? p : q, support.absorb == "y" ? p : q,
              support.absorb == "z" ? p : q};
  }
  return all;
}

}  // namespace breccia::dem
