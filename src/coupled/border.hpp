#pragma once
// Forces between spheres and tetrahedra on ranks (docs/theory-coupled.md, 4): every rank holds
// the lists of near faces, touches and bonds of all. In a step it evaluates those of its own
// spheres, and of others that its own tetrahedra meet: two ranks do so with equal bits, and each
// adds up for its own items. Searches and files need all states: see tell_states().

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
  Halo of_spheres, of_solids;                  ///< other ranks' items, by row: all of them
  Halo near_spheres, near_solids;              ///< those that this rank evaluates
  std::vector<int> sphere_owner, solid_owner;  ///< ranks of the rows
  Buffer<Index> rows, touches, bonds, solids;  ///< evaluated here; `solids`: rows of World::around
  Buffer<BorderSphere> sphere_items;           ///< as sent
  Buffer<BorderSolid> solid_items;             ///< as sent
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
    each(rows, touches, bonds, solids, sphere_items, solid_items, sphere_here, solid_here, spheres,
         orientation, sphere_material, fixed, nodes, material, body, exposed, tie, face);
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

/// A kernel for the items of a list.
template <class Kernel>
struct OfList {
  static constexpr const char* name = Kernel::name;
  Kernel kernel;
  View<const Index> list;
  BR_HD void operator()(Index i) const { kernel(list[i]); }
};

/// Makes the border of the lists. Every rank calls it.
/// @param spheres  number of the sphere of each row
void make_border(World& w, const Buffer<Index>& spheres);

/// Chooses what this rank evaluates, of World::rows. Every rank calls it.
/// @param spheres  as of make_border
void share_out_between(World& w, const Buffer<Index>& spheres);

/// Copies that this rank evaluates follow their owners. Every rank calls it.
void follow_owners(World& w);
/// All copies do.
void follow_all_owners(World& w);

/// Gives all ranks the states of all touches, faces and bonds: each keeps up only what it
/// evaluates. Before a search, when items may have changed hands already; every rank calls it.
void tell_states(World& w);
/// That, and all copies as they are now: after steps. Every rank calls it.
void make_whole(World& w);

}  // namespace breccia::coupled
