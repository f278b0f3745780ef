// Extrinsic joints of triangles: fdem_shared/insertion.hpp.

#include "fdem_shared/insertion.hpp"

#include "fdem/joints/insertion_kernels.hpp"
#include "fdem/shape.hpp"

namespace breccia::fdem {

void wake_joints(World& w) {
  fdem_shared::insert_mesh_joints(w);
}

void derive_bundles(World& w) {
  fdem_shared::tie_corners(w, true, {});
}

}  // namespace breccia::fdem
