#pragma once
// Links at the start: which elements are joined, and how far the interaction range reaches.

#include <functional>
#include <string>
#include <vector>

#include "dem/setup/config.hpp"
#include "dem/setup/model.hpp"

namespace breccia::prepare {

/// How elements of a body are joined at the start; one a body, in the order of the case.
struct BodyLinks {
  enum class Kind {
    none,    ///< grains and single elements
    range,   ///< every pair in range
    facets,  ///< particles of one tetrahedron, by link_facets
    bars     ///< neighbours along a bar, and the elements of `host` around them
  } kind = Kind::none;
  dem::LinkKind link = dem::LinkKind::concrete;  ///< what joins pairs in range
  std::int16_t material = 0;                     ///< of the links within the body
  int host = -1;                                 ///< body that the bars reinforce
  std::int16_t interface = 0;                    ///< material of the links between bars and host
  bool of_file = false;                          ///< its elements are read, not packed
  /// Which places of the host stay: bars are bonded to elements there. Empty: all.
  std::function<bool(const Vec3&)> within{};
};

/// The least number of interface links an element of a bar has, if its host has that many elements.
inline constexpr int least_interface_links = 4;

/// Links the model (docs/theory.md, links at the start). Two elements of a concrete body, or one of
/// a bar and one of its host, are linked when their distance is at most gamma_int (Ri + Rj); a
/// bar's element with fewer than four such partners is linked to the four of least distance / (Ri +
/// Rj). gamma_int >= 1, so that elements that overlap are linked. It is config.range, or the one
/// that gives the wanted number of links as nearly as the packing allows. Sets links (sorted by a,
/// then b; a < b) and interaction_range.
///
/// @param threads  any number of them gives the same links
/// @throws InputError if no gamma_int in [1, 3] gives the wanted number
void link_elements(dem::Model& model, const std::vector<BodyLinks>& bodies,
                   const dem::LinksConfig& config, int threads = 1);

/// Overlaps that would push from the first step on, because no link makes them stress-free: one
/// sentence for every two bodies (or one, for grains), naming the deepest pair. Empty: none.
std::vector<std::string> free_overlaps(const dem::Model& model,
                                       const std::vector<BodyLinks>& bodies, int threads = 1);

/// Takes out links, and the facets that they have. A bond between elements that overlap stays,
/// parted: a contact in its place would push with an overlap that the packing put there.
void drop_links(dem::Model& model, const std::function<bool(const dem::Model::Link&)>& gone);

}  // namespace breccia::prepare
