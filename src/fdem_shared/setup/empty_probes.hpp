#pragma once
// Probes whose box holds nothing of a mesh: they read 0 without a word.

#include <algorithm>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "core/case_config.hpp"
#include "core/gauge.hpp"
#include "core/on_host.hpp"
#include "core/quantity.hpp"
#include "fdem_shared/setup/weight.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// The corner of a mesh that is nearest to a box.
template <class Vector>
struct NearestCorner {
  double distance = std::numeric_limits<double>::max();  ///< 0: the box holds it  [m]
  Vector at{};                                           ///< [m]

  void see(const ReadBox& box, const Vector& corner) {
    const Vec3 x = to_space(corner);
    const auto beyond = [](double low, double value, double high) {
      return std::max({0.0, low - value, value - high});
    };
    const double away =
        norm(Vec3{beyond(box.min.x, x.x, box.max.x), beyond(box.min.y, x.y, box.max.y),
                  beyond(box.min.z, x.z, box.max.z)});
    if (away >= distance) return;
    distance = away;
    at = corner;
  }
};

/// Boxes between the corners of a mesh, or between the middles of its elements if stress is read.
template <class World, class Config>
void look_for_empty_probes(const World& w, const Config& config, std::vector<std::string>& found) {
  using Shape = ShapeOf<World>;
  using Vector = typename Shape::Vector;
  using Kind = Quantity::Kind;
  for (const ProbeConfig& p : config.probes) {
    if (p.min.empty() && p.max.empty()) continue;
    const Kind kind = quantity_named(p.quantity).quantity.kind;
    const bool stress = kind == Kind::stress;
    const bool corners = kind == Kind::position || kind == Kind::displacement ||
                         kind == Kind::velocity || kind == Kind::speed || kind == Kind::force ||
                         kind == Kind::strain || kind == Kind::kinetic;
    if (!stress && !corners) continue;
    std::vector<std::uint8_t> taken;  // corners of the set that it names, by number
    for (const auto& set : w.given->sets) {
      if (set.name != p.on) continue;
      taken.assign(static_cast<std::size_t>(Shape::corners * Shape::elements(w).size()), 0);
      for (const auto corner : set.nodes) taken[static_cast<std::size_t>(corner)] = 1;
    }
    const ReadBox box(p.min, p.max);
    NearestCorner<Vector> nearest;
    const auto& all = Shape::elements(w).nodes;
    const OnHost<std::remove_cvref_t<decltype(all)>> nodes(all, w.exec.space);
    for (Index t = 0; t < all.size() && nearest.distance > 0.0; ++t) {
      Vector middle{};
      bool any = taken.empty();
      for (Index k = 0; k < Shape::corners; ++k) {
        const Vector& x = nodes->data()[t].at[k].position;
        middle = middle + (1.0 / Shape::corners) * x;
        const bool mine =
            taken.empty() || taken[static_cast<std::size_t>(Shape::corners * t + k)] != 0;
        any = any || mine;
        if (mine && !stress) nearest.see(box, x);
      }
      if (any && stress) nearest.see(box, middle);
    }
    if (nearest.distance == 0.0 || nearest.distance == NearestCorner<Vector>().distance) continue;
    found.push_back("probe." + p.name + ": its box holds no " +
                    (stress ? "middle of an element" : "corner") +
                    " of the mesh at the start, and it reads 0; the nearest is at (" +
                    numbers_of(nearest.at) + ") m");
  }
}

}  // namespace breccia::fdem_shared
