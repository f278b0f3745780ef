#include "core/probe.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/case_config.hpp"

namespace breccia {
namespace {

std::string allowed(unsigned of) {
  std::string all;
  for (const std::string& word : quantity_words(of).words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

bool is_history_column(const std::string& name) {
  return std::find(std::begin(history_columns), std::end(history_columns), name) !=
         std::end(history_columns);
}

}  // namespace

std::vector<std::string> probe_problems(const ProbeConfig& p, Bearer of, std::size_t axes) {
  using Kind = Quantity::Kind;
  std::vector<std::string> problems;
  const std::string where = "probe." + p.name;
  const auto add = [&](const std::string& text) { problems.push_back(where + text); };
  if (is_history_column(p.name))
    add(".name: history.csv has a column of this name already; take another");
  const NamedQuantity& named = quantity_named(p.quantity);
  const Kind kind = named.quantity.kind;
  if ((named.of & of) == 0) {
    if (of == in_plane && named.quantity.axis >= 0)
      add(".quantity = \"" + p.quantity + "\"" +
          (p.quantity == ProbeConfig{}.quantity ? " (taken if none is given)" : "") +
          " has a z, which a plane case lacks; allowed: " + allowed(of));
    else
      add(".quantity = \"" + p.quantity + "\" is none " +
          (of == of_wall    ? "of a wall"
           : of == of_bolt  ? "of a bolt"
           : of == in_space ? "of spheres"
           : of == in_solid ? "of tetrahedra"
                            : "of a plane case") +
          "; allowed: " + allowed(of));
    return problems;
  }
  if (axes == 0) axes = of == in_plane ? 2 : 3;
  const auto length = [&](const char* key, const std::vector<double>& value) {
    if (!value.empty() && value.size() != axes)
      add(std::string(".") + key + ": a point has " + std::to_string(axes) + " coordinates");
  };
  length("min", p.min);
  length("max", p.max);
  length("about", p.about);
  for (std::size_t k = 0; k < p.min.size() && k < p.max.size(); ++k)
    if (!(p.min[k] < p.max[k])) {
      add(": min must be below max");
      break;
    }
  if (of == of_wall && !(p.min.empty() && p.max.empty()))
    add(".min: a wall is read as a whole; leave min and max out");
  if (!p.about.empty() && kind != Kind::torque && kind != Kind::angular_momentum)
    add(".about is a point for torque and angular_momentum; " + p.quantity + " has none");
  const bool stress_of_spheres = of == in_space && kind == Kind::stress;
  if (stress_of_spheres && (p.min.empty() || p.max.empty()))
    add(": the stress of spheres is that of a box; give min and max");
  const auto endless = [](const std::vector<double>& corner) {
    return std::any_of(corner.begin(), corner.end(), [](double x) { return std::isinf(x); });
  };
  if (stress_of_spheres && (endless(p.min) || endless(p.max)))
    add(": the stress of spheres is a mean over a box; give it ends on all sides");
  if (stress_of_spheres && !p.on.empty())
    add(".on: the stress of spheres is of all that is in the box; leave on out, or in a case of "
        "both "
        "methods give \"spheres\"");
  if ((stress_of_spheres || kind == Kind::strain) && p.reduce != "mean")
    add(".reduce = \"" + p.reduce + "\": " + p.quantity +
        " of a region is one value; leave it out");
  if (kind == Kind::stress && p.reduce == "sum")
    add(".reduce = \"sum\": stresses do not add up; allowed: mean, min, max");
  if (of == of_wall && p.reduce != "mean" && p.reduce != "sum")
    add(".reduce = \"" + p.reduce + "\": a wall has one value; leave the key out");
  return problems;
}

}  // namespace breccia
