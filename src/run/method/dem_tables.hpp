#pragma once
// Lists that a DEM run leaves as it ends: pieces, broken links, contacts.

#include <vector>

#include "dem/world.hpp"
#include "run/method/method.hpp"

namespace breccia {

/// fragments: pieces that links hold together, the heaviest first, with place and velocity;
/// broken_links: where they are, which way they pointed, and when a row of the history first found
/// them broken; contacts: those that press, with their
/// forces.
/// @param w  all of it
std::vector<Table> dem_tables(const dem::World& w);

}  // namespace breccia
