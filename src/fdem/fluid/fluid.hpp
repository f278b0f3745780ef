#pragma once
// Fluid in cracks of triangles: fdem_shared/fluid/fluid.hpp, and gas.

#include <vector>

#include "fdem/shape.hpp"
#include "fdem_shared/sides_now.hpp"

namespace breccia::fdem {

using EdgeNow = fdem_shared::SideNow<Shape>;

/// A crack as it is open now.
struct OpenLine {
  double length;   ///< of its middle line  [m]
  double opening;  ///< in its middle  [m]
  double extent() const { return length; }
};
OpenLine opened(const CrackSide& crack, const EdgeNow& a, const EdgeNow& b);
fdem_shared::LineCell cell_of(const FlowCase& flow, const CrackSide& crack, const OpenLine& now);
void tell_cracks(World& part, const Buffer<Index>& joints, Buffer<CrackSide>& told);

/// Cracks that are broken or open now, of the whole mesh, by their first edges. All ranks get all.
std::vector<CrackSide> open_cracks(World& part);

/// Lets fluid spread to where it is at the time of the world: from then on it presses there. Its
/// pressure is asked for in each step. All ranks call it at the same steps.
void spread_fluid(World& part);
/// After loading a checkpoint: to where it was when it spread last.
void restore_fluid(World& part);

/// Lets a fluid that flows go on to the time of the world, by the openings of cracks now, and lists
/// what it presses on. All ranks call it in each step.
void flow_on(World& part);

/// Lists the loaded edges that are here, those that fluid presses on, too.
void list_loaded(World& w);

/// Volume per thickness of the holes of a source now, and of the cracks that its gas has filled.
/// All ranks call it.  [m2]
double gas_volume(World& part, const FluidSource& source);
/// Keeps in a source where the walls of its holes are at the start.
void note_walls(const World& part, FluidSource& source);

/// Length that a fluid has filled, and the volume of it, per unit thickness, of the whole mesh.
/// @param load  index into Config::loads
fdem_shared::FilledPart filled_part(const World& whole, std::size_t load);

}  // namespace breccia::fdem
