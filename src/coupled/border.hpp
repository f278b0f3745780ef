#pragma once
// Forces between spheres and tetrahedra on ranks (docs/theory-coupled.md, 4): every rank holds
// the lists of near faces, touches and bonds, and copies of all spheres and tetrahedra that these
// lead to. All ranks evaluate all of it, with equal bits; each adds up for its own items.

#include "coupled/bonds.hpp"
#include "domain/halo.hpp"

namespace breccia::coupled {

struct World;

/// A sphere as the owner sends it.
struct BorderSphere {
  dem::ElementState state;
  Quaternion orientation;
  std::int32_t material;
  std::uint32_t fixed;
};
/// A tetrahedron as the owner sends it.
struct BorderSolid {
  fdem3::TetrahedronNodes nodes;
  Index material;
  std::int16_t body;
  std::uint16_t exposed;
};

/// Copies of the items of the border, one for each row of World::rows and World::around. Empty on
/// one rank, which reads its worlds.
struct Border {
  Halo of_spheres, of_solids;         ///< other ranks' items, by row
  Buffer<BorderSphere> sphere_items;  ///< as sent
  Buffer<BorderSolid> solid_items;    ///< as sent
  Buffer<Index> sphere_here;          ///< place in this rank's world, -1: another one owns it
  Buffer<Index> solid_here;           ///< likewise
  Buffer<dem::ElementState> spheres;  ///< now
  Buffer<Quaternion> orientation;     ///< now
  Buffer<std::int16_t> sphere_material;
  Buffer<std::uint8_t> fixed;             ///< bits of dem::Fixed
  Buffer<fdem3::TetrahedronNodes> nodes;  ///< now
  Buffer<Index> material;
  Buffer<std::int16_t> body;
  Buffer<std::uint8_t> exposed;
  Buffer<BallBond> tie;        ///< the bonds, with rows for numbers
  Buffer<Index> face;          ///< 4 row + k of each near face
  std::int64_t sharings = -1;  ///< how often items had been shared out when it was made

  template <class Visit>
  void each_array(Visit&& visit) {
    const auto each = [&](auto&... arrays) { (visit(arrays), ...); };
    each(sphere_items, solid_items, sphere_here, solid_here, spheres, orientation, sphere_material,
         fixed, nodes, material, body, exposed, tie, face);
  }
};

/// Both kinds of items as kernels see them: of the worlds, or of the border. Rows, bonds and faces
/// lead to places in these arrays.
struct Meeting {
  View<const dem::ElementState> spheres;
  View<const Quaternion> orientation;
  View<const std::int16_t> sphere_material;
  View<const std::uint8_t> fixed;
  View<const fdem3::TetrahedronNodes> nodes;
  View<const Index> material;
  View<const std::int16_t> body;
  View<const std::uint8_t> exposed;
  View<const BallBond> tie;
  View<const Index> face;        ///< 4 t + k
  View<const Index> solid_here;  ///< of each row of `around`: its place in the world, or -1
};
Meeting meeting(const World& w);

/// Makes the border of the lists. Every rank calls it.
/// @param spheres  number of the sphere of each row
void make_border(World& w, const Buffer<Index>& spheres);

/// Copies follow the owners. Every rank calls it.
void follow_owners(World& w);

}  // namespace breccia::coupled
