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
  const std::vector<StepOfElement> before = stable_steps(w);
  std::vector<double> step, bears, mass;
  for (const StepOfElement& of : before) {
    step.push_back(of.step);
    bears.push_back(of.bears);
  }
  copy_to(mass, e.mass);
  given.added_mass = add_mass(given.time.added_mass, step, bears, mass);
  if (given.added_mass.elements == 0) return;
  copy_to(e.mass, mass);
  const auto least = [](const std::vector<StepOfElement>& of) {
    return std::min_element(of.begin(), of.end(),
                            [](const auto& a, const auto& b) { return a.step < b.step; })
        ->step;
  };
  given.added_mass.longer = least(stable_steps(w)) / least(before);
}

}  // namespace breccia::fdem_shared
