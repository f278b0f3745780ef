#include "fdem/setup/starts.hpp"

#include <numeric>

#include "exec/error.hpp"

namespace breccia::fdem {

void set_up_starts(Case& given, const Config& config, const Model& model) {
  std::vector<Vec2> starts;
  for (const auto& triangle : model.triangle)
    for (const Index vertex : triangle) starts.push_back(model.point[at(vertex)]);
  bool any = given.shown.displacement;
  for (const ProbeConfig& p : config.probes) {
    const Quantity::Kind kind = quantity_named(p.quantity).quantity.kind;
    any |= kind == Quantity::Kind::displacement || kind == Quantity::Kind::strain;
    if (kind != Quantity::Kind::strain) continue;
    std::vector<Index> corners(starts.size());
    std::iota(corners.begin(), corners.end(), 0);
    for (const NodeSet& set : given.sets)
      if (set.name == p.on) corners = set.nodes;
    const ReadBox box(p.min, p.max);
    std::vector<Vec3> points;
    for (const Index n : corners)
      if (const Vec3 x{starts[at(n)].x, starts[at(n)].y, 0.0}; box.holds(x)) points.push_back(x);
    bool fits = false;
    given.strain_fits.push_back({p.name, strain_fit(points, 2, fits)});
    if (!fits)
      throw InputError("probe." + p.name +
                       ": strain needs corners that do not lie on a line; its region holds " +
                       std::to_string(points.size()));
  }
  if (any) copy_to(given.starts, starts);
}

}  // namespace breccia::fdem
