#pragma once
// Mass for the elements whose stable steps are the shortest: time.added_mass.

#include <algorithm>
#include <vector>

#include "core/added_mass.hpp"
#include "fdem_shared/observe.hpp"
#include "fdem_shared/setup/writable.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// Makes the elements heavier that rule the step, as far as time.added_mass allows.
template <class World>
void add_mass_to_ruling(World& w) {
  auto& given = set_up(w);
  if (!(given.time.added_mass > 0.0)) return;
  auto& e = ShapeOf<World>::elements(w);
  const std::vector<double> before = stable_steps(w);
  std::vector<double> mass;
  copy_to(mass, e.mass);
  given.added_mass = add_mass(given.time.added_mass, before, mass);
  if (given.added_mass.elements == 0) return;
  copy_to(e.mass, mass);
  const std::vector<double> after = stable_steps(w);
  given.added_mass.longer = *std::min_element(after.begin(), after.end()) /
                            *std::min_element(before.begin(), before.end());
}

}  // namespace breccia::fdem_shared
