#include "prepare/check_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "exec/error.hpp"

namespace breccia::dem {
namespace {

class Check {
 public:
  explicit Check(const Config& config) : config_(config) {}

  void run() {
    if (config_.bodies.empty())
      add("body: the case has no elements; at least one [[body]] is needed");
    for (const MaterialConfig& m : config_.materials) check(m);
    for (const BodyConfig& b : config_.bodies) check(b);
    check_overlaps();
    for (const WallConfig& w : config_.walls)
      if (!(norm(w.normal) > 0.0))
        add("wall." + w.name + ".normal has length 0; it must point somewhere");
    for (const SupportConfig& s : config_.supports) check(s);
    for (const ProbeConfig& p : config_.probes) check(p);
    if (problems_.empty()) return;
    std::string text = fmt::format("{} problem{} in the case; nothing was run.", problems_.size(),
                                   problems_.size() == 1 ? "" : "s");
    for (const std::string& problem : problems_) text += "\n  " + problem;
    throw InputError(text);
  }

 private:
  void add(const std::string& problem) { problems_.push_back(problem); }

  template <class Items>
  static std::string names_of(const Items& items) {
    std::string text;
    for (const auto& item : items) text += (text.empty() ? "" : ", ") + item.name;
    return text.empty() ? "none" : text;
  }
  template <class Items>
  static auto find(const Items& items, const std::string& name) {
    const auto found =
        std::find_if(items.begin(), items.end(), [&](const auto& i) { return i.name == name; });
    return found == items.end() ? nullptr : &*found;
  }

  void check(const MaterialConfig& m) {
    const std::string path = "material." + m.name;
    if (m.law == "concrete" && m.poisson > 1.0 / m.alpha)
      add(
          fmt::format("{}.poisson = {} is above 1 / alpha = {:.4g}: links would have a negative "
                      "shear stiffness",
                      path, m.poisson, 1.0 / m.alpha));
    if (m.law == "interface" && m.bond == "mc90" && !(m.slip1 <= m.slip2 && m.slip2 < m.slip3))
      add(fmt::format("{}: slip1 <= slip2 < slip3 must hold (they are {}, {}, {} m)", path, m.slip1,
                      m.slip2, m.slip3));
  }

  void check(const BodyConfig& b) {
    const std::string path = "body." + b.name;
    const MaterialConfig* material = find(config_.materials, b.material);
    if (material == nullptr)
      add(fmt::format("{}.material = {:?} is not a material; there are: {}", path, b.material,
                      names_of(config_.materials)));
    else if (b.shape == "rebar" && material->law != "steel")
      add(fmt::format("{}: bars need a material of law steel, {} has {}", path, b.material,
                      material->law));
    else if (b.shape != "rebar" && material->law != "concrete" && material->law != "grain")
      add(fmt::format("{}: elements need a material of law concrete or grain, {} has {}", path,
                      b.material, material->law));
    const bool packed = b.shape == "box" || b.shape == "sphere" || b.shape == "cylinder";
    if (packed && b.pack.count < 1)
      add(path + ".pack.count is missing: how many elements fill the body?");
    if (b.shape == "box" && !(b.size.x > 0.0 && b.size.y > 0.0 && b.size.z > 0.0))
      add(path + ".size needs three lengths above 0");
    if ((b.shape == "sphere" || b.shape == "cylinder" || b.shape == "element") && !(b.radius > 0.0))
      add(path + ".radius must be above 0");
    if (b.shape == "cylinder" && !(b.length > 0.0)) add(path + ".length must be above 0");
    if (b.shape == "file" && b.file.empty()) add(path + ".file is missing: a CSV of x,y,z,radius");
    if (b.shape == "file" && material != nullptr && material->law == "concrete" &&
        !(b.bulk_volume() > 0.0))
      add(path +
          ".volume is missing: spheres of concrete do not fill space, so their mass is density "
          "times the volume that they stand for; give volume in m3, or the size of a box");
    if (b.shape == "rebar") check_rebar(path, b);
  }

  void check_rebar(const std::string& path, const BodyConfig& b) {
    const BodyConfig* host = find(config_.bodies, b.rebar.in);
    if (host == nullptr || host->shape != "box")
      add(fmt::format("{}.rebar.in = {:?} is not a box body; there are: {}", path, b.rebar.in,
                      names_of(config_.bodies)));
    const MaterialConfig* bond = find(config_.materials, b.rebar.interface_law);
    if (bond == nullptr || bond->law != "interface")
      add(fmt::format("{}.rebar.interface = {:?} is not a material of law interface; there are: {}",
                      path, b.rebar.interface_law, names_of(config_.materials)));
  }

  /// The distance of x from an interval; 0 inside.  [m]
  static double beyond(double x, double low, double high) {
    return x < low ? low - x : x > high ? x - high : 0.0;
  }
  static bool round(const BodyConfig& b) { return b.shape == "sphere" || b.shape == "element"; }
  static bool has_shape(const BodyConfig& b) {
    return round(b) || b.shape == "box" || b.shape == "cylinder";
  }
  /// Half of the height of a box or cylinder.  [m]
  static double half_height(const BodyConfig& b) {
    return 0.5 * (b.shape == "box" ? b.size.z : b.length);
  }
  /// The space between two upright bodies, each a rectangle or a disc times a height, or between
  /// one of them and a ball; below 0 they share space by so much.  [m]
  static double gap(const BodyConfig& a, const BodyConfig& b) {
    if (round(b) && !round(a)) return gap(b, a);
    const Vec3 apart = b.center - a.center;
    if (round(b)) return norm(apart) - a.radius - b.radius;
    // In the plane: corners of rectangles are sharp, so a disc's radius is taken off last.
    const double half_x =
        (a.shape == "box" ? 0.5 * a.size.x : 0.0) + (b.shape == "box" ? 0.5 * b.size.x : 0.0);
    const double half_y =
        (a.shape == "box" ? 0.5 * a.size.y : 0.0) + (b.shape == "box" ? 0.5 * b.size.y : 0.0);
    const double dx = beyond(apart.x, -half_x, half_x), dy = beyond(apart.y, -half_y, half_y);
    const double across = std::sqrt(dx * dx + dy * dy);
    const double disc_b = b.shape == "cylinder" ? b.radius : 0.0;
    if (round(a)) {
      const double aside = std::max(across - disc_b, 0.0);
      const double above = beyond(apart.z, -half_height(b), half_height(b));
      return std::sqrt(aside * aside + above * above) - a.radius;
    }
    const double along = std::abs(apart.z) - half_height(a) - half_height(b);
    if (a.shape == "box" && b.shape == "box")
      return std::max({std::abs(apart.x) - half_x, std::abs(apart.y) - half_y, along});
    const double disc_a = a.shape == "cylinder" ? a.radius : 0.0;
    return std::max(across - disc_a - disc_b, along);
  }
  static double extent(const BodyConfig& b) {
    return norm(b.size) + b.radius + b.length + norm(b.center);
  }
  void check_overlaps() {
    for (std::size_t i = 0; i < config_.bodies.size(); ++i)
      for (std::size_t j = i + 1; j < config_.bodies.size(); ++j) {
        const BodyConfig &a = config_.bodies[i], &b = config_.bodies[j];
        // Bars lie in their host; the spheres of a file are compared when they have been read.
        if (!has_shape(a) || !has_shape(b)) continue;
        if (gap(a, b) < -1e-9 * (extent(a) + extent(b)))
          add(fmt::format("body.{} and body.{} overlap at the start; move one of them", a.name,
                          b.name));
      }
  }

  void check(const SupportConfig& s) {
    static const std::set<std::string> words{"x", "y", "z", "spin_x", "spin_y", "spin_z", "all"};
    if (find(config_.bodies, s.name) != nullptr)
      add(fmt::format("support.{0} and body.{0} have one name; a probe could not tell them apart",
                      s.name));
    if (!s.on.empty() && find(config_.bodies, s.on) == nullptr)
      add(fmt::format("support.{}.on = {:?} is not a body; there are: {}", s.name, s.on,
                      names_of(config_.bodies)));
    for (const std::string& word : s.fix)
      if (!words.contains(word))
        add(fmt::format(
            "support.{}.fix: {:?} is no degree of freedom; allowed are x, y, z, spin_x, spin_y, "
            "spin_z, all",
            s.name, word));
    if (!(s.min.x <= s.max.x && s.min.y <= s.max.y && s.min.z <= s.max.z))
      add("support." + s.name + ": min must not be above max");
  }

  void check(const ProbeConfig& p) {
    if (p.on.empty() || find(config_.bodies, p.on) != nullptr ||
        find(config_.supports, p.on) != nullptr)
      return;
    add(fmt::format("probe.{}.on = {:?} is neither a body ({}) nor a support ({})", p.name, p.on,
                    names_of(config_.bodies), names_of(config_.supports)));
  }

  const Config& config_;
  std::vector<std::string> problems_;
};

}  // namespace

void check_case(const Config& config) {
  Check(config).run();
}

}  // namespace breccia::dem
