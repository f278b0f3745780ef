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
      add(fmt::format("{}.material = \"{}\" is not a material; there are: {}", path, b.material,
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
    if (b.shape == "rebar") check_rebar(path, b);
  }

  void check_rebar(const std::string& path, const BodyConfig& b) {
    const BodyConfig* host = find(config_.bodies, b.rebar.in);
    if (host == nullptr || host->shape != "box")
      add(fmt::format("{}.rebar.in = \"{}\" is not a box body; there are: {}", path, b.rebar.in,
                      names_of(config_.bodies)));
    const MaterialConfig* bond = find(config_.materials, b.rebar.interface_law);
    if (bond == nullptr || bond->law != "interface")
      add(fmt::format(
          "{}.rebar.interface = \"{}\" is not a material of law interface; there are: {}", path,
          b.rebar.interface_law, names_of(config_.materials)));
  }

  struct Extent {
    Vec3 low, high;
  };
  static Extent extent(const BodyConfig& b) {
    Vec3 half = 0.5 * b.size;
    if (b.shape == "sphere" || b.shape == "element") half = {b.radius, b.radius, b.radius};
    if (b.shape == "cylinder") half = {b.radius, b.radius, 0.5 * b.length};
    return {b.center - half, b.center + half};
  }
  static bool round(const BodyConfig& b) { return b.shape == "sphere" || b.shape == "element"; }
  /// True only if the shapes surely share space: a sphere against what its box touches is measured.
  static bool overlap(const BodyConfig& a, const BodyConfig& b) {
    if (round(b) && !round(a)) return overlap(b, a);
    if (round(a) && round(b))
      return norm(b.center - a.center) < (a.radius + b.radius) * (1.0 - 1e-9);
    const Extent p = extent(a), q = extent(b);
    if (round(a) && b.shape == "box") {
      const auto beyond = [](double x, double low, double high) {
        return x < low ? low - x : x > high ? x - high : 0.0;
      };
      const Vec3 gap{beyond(a.center.x, q.low.x, q.high.x), beyond(a.center.y, q.low.y, q.high.y),
                     beyond(a.center.z, q.low.z, q.high.z)};
      return norm(gap) < a.radius * (1.0 - 1e-9);
    }
    if (a.shape != "box" || b.shape != "box") return false;  // elements are compared after packing
    const double slack = 1e-9 * norm(p.high - p.low);
    return p.low.x < q.high.x - slack && q.low.x < p.high.x - slack && p.low.y < q.high.y - slack &&
           q.low.y < p.high.y - slack && p.low.z < q.high.z - slack && q.low.z < p.high.z - slack;
  }
  void check_overlaps() {
    for (std::size_t i = 0; i < config_.bodies.size(); ++i)
      for (std::size_t j = i + 1; j < config_.bodies.size(); ++j) {
        const BodyConfig &a = config_.bodies[i], &b = config_.bodies[j];
        if (a.shape == "rebar" || b.shape == "rebar" || a.shape == "file" || b.shape == "file")
          continue;
        if (overlap(a, b))
          add(fmt::format("body.{} and body.{} overlap at the start; move one of them", a.name,
                          b.name));
      }
  }

  void check(const SupportConfig& s) {
    static const std::set<std::string> words{"x", "y", "z", "spin_x", "spin_y", "spin_z", "all"};
    if (!s.on.empty() && find(config_.bodies, s.on) == nullptr)
      add(fmt::format("support.{}.on = \"{}\" is not a body; there are: {}", s.name, s.on,
                      names_of(config_.bodies)));
    for (const std::string& word : s.fix)
      if (!words.contains(word))
        add(fmt::format(
            "support.{}.fix: \"{}\" is no degree of freedom; allowed are x, y, z, spin_x, spin_y, "
            "spin_z, all",
            s.name, word));
    if (!(s.min.x <= s.max.x && s.min.y <= s.max.y && s.min.z <= s.max.z))
      add("support." + s.name + ": min must not be above max");
  }

  void check(const ProbeConfig& p) {
    if (p.on.empty() || find(config_.bodies, p.on) != nullptr ||
        find(config_.supports, p.on) != nullptr)
      return;
    add(fmt::format("probe.{}.on = \"{}\" is neither a body ({}) nor a support ({})", p.name, p.on,
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
