#pragma once
// Fluid in cracks: which edges it presses on, of a world and on ranks.

#include <vector>

#include "domain/domain.hpp"
#include "fdem/fluid/spreading.hpp"
#include "fdem/world.hpp"

namespace breccia::fdem {

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
void list_loaded_edges(World& w);

/// Length that a fluid has filled, and the volume of it, per unit thickness.
struct FilledPart {
  double length = 0.0;  ///<  [m]
  double volume = 0.0;  ///<  [m2]
};
/// Of the whole mesh. @param load  index into Config::loads
FilledPart filled_part(const World& whole, std::size_t load);

}  // namespace breccia::fdem
