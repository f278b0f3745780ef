#pragma once
// Parts that the methods of triangles and of tetrahedra share.

#include <string>
#include <vector>

#include "exec/buffer.hpp"
#include "exec/error.hpp"

namespace breccia {

/// An array of another length than its neighbours'.
template <class T>
struct Loose {
  const char* name;
  Buffer<T>& array;
  template <class Visit>
  void each_field(Visit&& field) {
    const Index built = array.size();
    field(name, "SI", array);
    if (array.size() != built)
      throw CheckpointError(std::string("the checkpoint's section ") + name +
                            " is not as long as the case's");
  }
};

/// How many states of servos a run of a case keeps whose supports alone have servos.
template <class Config>
std::size_t servos_of_supports(const Config& config) {
  bool any = false;
  for (const auto& support : config.supports) any |= support.servo.is_on();
  for (const auto& stage : config.stages)
    for (const auto& support : stage.supports) any |= support.servo.is_on();
  return any ? config.supports.size() : 0;
}
/// Servos of supports that a stage gives another task, by name.
template <class Config>
std::vector<std::size_t> changed_supports(const Config& config, std::size_t stage) {
  std::vector<std::size_t> changed;
  for (std::size_t s = 0; s < config.supports.size(); ++s)
    for (const auto& change : config.stages[stage].supports)
      if (change.name == config.supports[s].name) changed.push_back(s);
  return changed;
}

}  // namespace breccia
