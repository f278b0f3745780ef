#pragma once
// A body of law ldpm, and the links of its facets.

#include <set>
#include <utility>

#include "dem/setup/model.hpp"
#include "prepare/ldpm/mesh_file.hpp"
#include "prepare/ldpm/particles.hpp"
#include "prepare/ldpm/tessellation.hpp"

namespace breccia::prepare {

MixDesign mix_of(const dem::MaterialConfig& material);

/// Particles and facets of a body, relative to its centre.
struct LdpmBody {
  std::vector<Vec3> position;  ///<  [m]
  std::vector<double> radius;  ///< of contacts: that of a ball like the cell, or less  [m]
  std::vector<LdpmCell> cells;
  std::vector<LdpmFacet> facets;
};

/// Radii are such that only particles of one edge overlap. Cells fill the body, bars or not.
/// @throws InputError if an edge is so long that the law cannot soften: 0.99 l_t or more
LdpmBody ldpm_body(const Container& container, const dem::MaterialConfig& material,
                   const Random& random, const std::vector<Capsule>& bars = {});
/// The body of a mesh that was read, with its facets or, if it has none, those of its diameters:
/// then surface particles have 1.1 of the mix's `smallest`.
LdpmBody ldpm_body(const LdpmMesh& mesh, const dem::MaterialConfig& material);

/// Reduces the radii of particles that overlap without a common facet until they touch.
/// @param edges  pairs with one, the lower number first
void part_strangers(const std::vector<Vec3>& position,
                    const std::set<std::pair<Index, Index>>& edges, std::vector<double>& radius);

/// Adds a link for each of the model's facets, whose ends may have changed their order; links and
/// facets are sorted by ends.
void link_facets(dem::Model& model);

}  // namespace breccia::prepare
