#pragma once
// A model on the host, ready to be set up: elements and the links they start with.

#include <string>
#include <vector>

#include "exec/plain_vector.hpp"
#include "exec/types.hpp"
#include "math/vec.hpp"

namespace breccia::dem {

/// Kind of a bond that two elements have from the start.
enum class LinkKind : std::uint8_t { concrete, steel, interface, parallel, ldpm };
inline constexpr std::size_t link_kinds = 5;

/// A case's model, made by prepare and made a world by dem/setup. Element i has global id i.
struct Model {
  std::vector<std::string> groups;     ///< names of the bodies
  PlainVector<std::int16_t> group;     ///< of each element, index into groups
  PlainVector<std::int16_t> material;  ///< of each element, index into Config::materials
  PlainVector<double> radius;          ///<  [m]
  PlainVector<double> mass;            ///<  [kg]
  PlainVector<double> inertia;         ///<  [kg m2]
  PlainVector<Vec3> position;          ///<  [m]
  PlainVector<Vec3> velocity;          ///<  [m/s]
  PlainVector<Vec3> spin;              ///<  [rad/s]

  /// Elements a < b, stress-free at their distance in `position`.
  struct Link {
    Index a, b;
    LinkKind kind;
    std::int16_t material;  ///< law of the link: the concrete's, steel's or interface's material
    double share = 1.0;     ///< of a concrete link: its section over pi min(R_a, R_b)^2  [-]
    Index facet = -1;       ///< of a link of LDPM: index into facets
    bool parted = false;    ///< of concrete and parallel bonds: broken from the start, by a cut
    double strength = 1.0;  ///< of a concrete link: factor on its strengths (fabric "faces")  [-]
  };
  PlainVector<Link> links;  ///< sorted by a, then b

  /// Of LDPM, between elements a < b, in a tetrahedron with c and d (docs/theory-ldpm.md).
  struct Facet {
    Index a, b, c, d;
    Vec3 center;  ///<  [m]
    double area;  ///< projected across the edge  [m2]
  };
  PlainVector<Facet> facets;  ///< in the order of their links, one each

  PlainVector<Index> bar_previous;  ///< neighbour of a bar's element along its bar, -1 elsewhere
  PlainVector<Index> bar_next;      ///< likewise, towards the other end

  std::vector<std::vector<Vec3>> wall_meshes;  ///< of each wall from an STL file: corners of its
                                               ///< triangles, three each, as in the file  [m]

  double interaction_range = 0.0;  ///< gamma_int that was used  [-]

  /// A body of concrete as its links have it, measured when it was built.
  struct Bulk {
    double factor = 1.0;                ///< on the stiffness of its concrete links  [-]
    double rupture_opening = 0.0;       ///< u_2 of its links; 0: by their softening  [m]
    double young = 0.0, poisson = 0.0;  ///< with that factor; 0: not measured  [Pa, -]
    double packed_young = 0.0, packed_poisson = 0.0;  ///< as packed, all sections alike  [Pa, -]
  };
  std::vector<Bulk> bulk;  ///< of each body; empty: nothing measured, factors of 1

  Bulk bulk_of(Index element) const {
    return bulk.empty() ? Bulk{}
                        : bulk[static_cast<std::size_t>(group[static_cast<std::size_t>(element)])];
  }

  Index size() const { return static_cast<Index>(position.size()); }
};

}  // namespace breccia::dem
