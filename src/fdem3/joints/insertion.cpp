// Extrinsic joints of tetrahedra: fdem_shared/insertion.hpp.

#include "fdem_shared/insertion.hpp"

#include "fdem3/joints/insertion_kernels.hpp"
#include "fdem3/shape.hpp"

namespace breccia::fdem3 {

void wake_joints(World& w) {
  fdem_shared::insert_mesh_joints(w);
}

void derive_bundles(World& w) {
  fdem_shared::tie_corners(w, true, {});
}

}  // namespace breccia::fdem3
