#pragma once
// Fluid in cracks of tetrahedra: fdem_shared/fluid/fluid.hpp.

#include "fdem3/shape.hpp"
#include "fdem_shared/sides_now.hpp"

namespace breccia::fdem3 {

using FaceNow = fdem_shared::SideNow<Shape>;

/// A crack as it is open now.
struct OpenFace {
  double edge[3];  ///< of its middle surface, in the order of face b's  [m]
  double area;     ///< of it  [m2]
  double opening;  ///< in the mean  [m]
  double extent() const { return area; }
};
OpenFace opened(const CrackSide& crack, const FaceNow& a, const FaceNow& b);
fdem_shared::FaceCell cell_of(const FlowCase& flow, const CrackSide& crack, const OpenFace& now);
void tell_cracks(World& part, const Buffer<Index>& joints, Buffer<CrackSide>& told);

/// Lets fluid spread to where it is at the time of the world: from then on it presses there. All
/// ranks call it at the same steps.
void spread_fluid(World& part);
/// After loading a checkpoint: to where it was when it spread last.
void restore_fluid(World& part);

/// Lets a fluid that flows go on to the time of the world, by the openings of cracks now, and lists
/// what it presses on. All ranks call it in each step.
void flow_on(World& part);

/// Lists the loaded faces that are here, those that fluid presses on, too.
void list_loaded(World& w);

/// Volume of the holes of a source now, and of the cracks that its gas has filled. All ranks
/// call it.  [m3]
double gas_volume(World& part, const FluidSource& source);
/// Keeps in a source where the walls of its holes are at the start.
void note_walls(const World& part, FluidSource& source);

/// Area that a fluid has filled, and the volume of it, of the whole mesh.
/// @param load  index into Config::loads
fdem_shared::FilledPart filled_part(const World& whole, std::size_t load);

}  // namespace breccia::fdem3
