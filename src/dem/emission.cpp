#include "dem/emission.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/on_host.hpp"

namespace breccia::dem {

std::vector<EmissionEvent> emission(const World& w) {
  const OnHost elements(w.elements, w.exec.space);
  const auto& state = elements->state;
  std::vector<Break> breaks;
  double slowest = 1e300;  // wave of a chain of such links  [m/s]
  w.each_set([&](const auto& set) {
    using Set = std::remove_cvref_t<decltype(set)>;
    if constexpr (Set::kind == LinkKind::concrete || Set::kind == LinkKind::parallel) {
      const OnHost links(set.arrays(), w.exec.space);
      with_number(w.exec.precision, [&](auto number) {
        const auto is_broken = links->template broken<decltype(number)>();
        for (Index i = 0; i < links->size(); ++i) {
          const double spent = links->broke.data()[i], seen = links->seen_broken.data()[i];
          if (!is_broken(i) || !(spent > 0.0)) continue;
          const ElementState& a = state.data()[links->a.data()[i]];
          const ElementState& b = state.data()[links->b.data()[i]];
          const Vec3 way = b.position - a.position;
          const double distance = norm(way);
          if (!(distance > 0.0)) continue;
          const Vec3 n = (1.0 / distance) * way;
          const double mass = elements->mass.data()[links->a.data()[i]];
          slowest = std::min(
              slowest, links->length.data()[i] * std::sqrt(links->stiffness.data()[i] / mass));
          const double size =
              links->length.data()[i] * std::sqrt(2.0 * links->stiffness.data()[i] * spent);
          breaks.push_back({seen < 0.0 ? w.time : seen,
                            a.position + (a.radius / (a.radius + b.radius)) * way,
                            {size * n.x * n.x, size * n.y * n.y, size * n.z * n.z, size * n.y * n.z,
                             size * n.x * n.z, size * n.x * n.y},
                            spent});
        }
      });
    }
  });
  const EmissionConfig& asked = w.given->emission;
  const double distance = asked.distance > 0.0 ? asked.distance : 4.0 * w.given->mean_radius;
  if (!(distance > 0.0)) return {};
  return events_of(breaks, distance, asked.window > 0.0 ? asked.window : distance / slowest);
}

}  // namespace breccia::dem
