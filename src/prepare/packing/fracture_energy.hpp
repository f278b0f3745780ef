#pragma once
// From the fracture energy G_F of a material to the opening at which its links break.

#include "dem/setup/config.hpp"
#include "dem/setup/model.hpp"

namespace breccia::prepare {

/// The packing of a body, as a specimen of its own can have it.
struct PackedLike {
  double radius;       ///< mean  [m]
  double size_ratio;   ///< largest over smallest radius  [-]
  double compactness;  ///< [-]
  double range;        ///< gamma_int  [-]
};

/// Energy that a notched cube of 600 elements spends until it has parted, over its ligament:
/// fracture, sliding and plastic moments. Mean of three packings; short, so that it does not snap
/// back.  [J/m2]
/// @param rupture_opening  u_2 of its links  [m]
double notched_cube_energy(const dem::MaterialConfig& material, const dem::ContactConfig& contact,
                           const PackedLike& packed, double rupture_opening);

/// u_2 for which that energy is the material's fracture_energy: two tests and a secant, since the
/// energy grows linearly with u_2.  [m]
/// @param longest  length of the longest link of the body  [m]
/// @throws InputError  naming the largest elements, or the least energy, if links would have to
/// break before they soften
double rupture_opening(const dem::MaterialConfig& material, const dem::ContactConfig& contact,
                       const PackedLike& packed, double longest, const std::string& body);

/// Steps of one element that finding an opening takes, over all its tests.
/// @param density  elements in a cubic metre of the body  [1/m3]
double fracture_energy_steps(double density);

}  // namespace breccia::prepare
