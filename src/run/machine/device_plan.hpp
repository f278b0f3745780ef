#pragma once
// How much memory a model takes on a GPU, known before anything is put there.

#include <cstddef>

#include "coupled/setup/model.hpp"
#include "dem/setup/model.hpp"
#include "fdem/setup/model.hpp"
#include "fdem3/setup/model.hpp"

namespace breccia {

/// Most memory of a run's arrays while nothing touches yet, search included.  [B]
std::size_t device_bytes(const dem::Model& model);
std::size_t device_bytes(const fdem::Model& model);
std::size_t device_bytes(const fdem3::Model& model);
inline std::size_t device_bytes(const coupled::Model& model) {
  return device_bytes(model.spheres) + device_bytes(model.tetrahedra);
}

/// Says how much a run will take of the GPU in use. @throws DeviceError if it has not that much
/// free
void plan_device(std::size_t bytes, bool quiet);

}  // namespace breccia
