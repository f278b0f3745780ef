#pragma once
// State of deformable tetrahedra.

#include "exec/buffer.hpp"
#include "fdem3/laws/elastic_tetrahedron.hpp"

namespace breccia::fdem3 {

/// A corner of a tetrahedron. Every tetrahedron owns its four: what ties coincident ones are
/// joints, bonds, or nothing. The position is at the time of the step, the velocity half a step
/// earlier.
struct NodeState {
  Vec3 position;  ///<  [m]
  Vec3 velocity;  ///<  [m/s]
};

/// The corners of a tetrahedron. Corner k of tetrahedron t is node 4 t + k.
struct TetrahedronNodes {
  NodeState at[4];
};

/// One vector for each corner.
struct Corners {
  Vec3 at[4];
};

/// Corner `place` (0 to 2) of face k, which lies opposite corner k: counter-clockwise seen from
/// outside. Faces 1 2 3, 0 3 2, 0 1 3, 0 2 1. Face number 4 t + k is face k of tetrahedron t.
BR_HD constexpr int corner_of_face(int face, int place) {
  constexpr unsigned corners = 1U | 2U << 2 | 3U << 4 | 0U << 6 | 3U << 8 | 2U << 10 | 0U << 12 |
                               1U << 14 | 3U << 16 | 0U << 18 | 2U << 20 | 1U << 22;
  return static_cast<int>(corners >> (2 * (3 * face + place)) & 3U);
}

/// Deformable tetrahedra, four nodes each. One item for each, ghosts included; who writes it, in
/// brackets, in the words of World. Constant: written by set-up; all of it moves with its
/// tetrahedron between ranks.
struct Tetrahedra {
  /// Others read the fields that each_field visits, no more: host_copy() makes no other array.
  static constexpr bool is_arrays_alone = true;

  Buffer<GlobalId> id;             ///< number, kept for ever  [-]  (constant)
  Buffer<std::int16_t> group;      ///< body it belongs to  [-]  (constant)
  Buffer<Index> material;          ///< index into the case's materials  [-]  (constant)
  Buffer<TetrahedronNodes> nodes;  ///< positions and velocities  (move)
  Buffer<ShapeGradients> shape;    ///< in the reference  [1/m]  (constant)
  Buffer<double> mass;             ///< of each corner  [kg]  (constant)
  Buffer<double> viscosity;        ///< eta  [Pa s]  (constant)
  Buffer<Corners> force;           ///< sum of all that acts now  [N]  (sums, loads, bundles)
  Buffer<Corners> external;        ///< the part of it by loads; empty: no loads  [N]  (loads)
  Buffer<std::uint8_t> exposed;    ///< bits of the faces that nothing joined at the last search:
                                   ///< those alone press  [-]  (search)
  Buffer<Index> hold;              ///< index into Case::holds, -1: free  [-]  (stage)
  Buffer<double> viscous_work;     ///< taken out by viscosity so far  [J]  (sums)
  Buffer<double> damping_work;     ///< taken out by local damping so far  [J]  (move)
  Buffer<double> load_work;        ///< put in by loads and prescribed motion  [J]  (move)

  template <class Visit>
  void each_field(Visit&& field) {
    field("id", "-", id);
    field("group", "-", group);
    field("material", "-", material);
    field("nodes", "SI", nodes);
    field("shape", "1/m", shape);
    field("mass", "kg", mass);
    field("viscosity", "Pa s", viscosity);
    field("force", "N", force);
    field("exposed", "-", exposed);
    field("hold", "-", hold);
    field("viscous_work", "J", viscous_work);
    field("damping_work", "J", damping_work);
    field("load_work", "J", load_work);
  }
  Index size() const { return id.size(); }
};

BR_HD inline void split(const TetrahedronNodes& nodes, Vec3 (&x)[4], Vec3 (&v)[4]) {
  for (int k = 0; k < 4; ++k) {
    x[k] = nodes.at[k].position;
    v[k] = nodes.at[k].velocity;
  }
}
BR_HD inline void places(const TetrahedronNodes& nodes, Vec3 (&x)[4]) {
  for (int k = 0; k < 4; ++k) x[k] = nodes.at[k].position;
}
BR_HD inline Vec3 centroid(const TetrahedronNodes& n) {
  return 0.25 * ((n.at[0].position + n.at[1].position) + (n.at[2].position + n.at[3].position));
}

/// The joints on the four faces of a tetrahedron: entries as of an Incidence (2 joint + side), or a
/// reason why there is none.
struct FaceJoints {
  Index at[4];
};
inline constexpr Index face_free = -1;    ///< on the border, or no law joins the two materials
inline constexpr Index face_bonded = -2;  ///< neighbours move as one body: no joint, no contact

/// How near a tetrahedron's surroundings count as near; it goes with its size at the start.  [m]
BR_HD inline double near_reach(const ShapeGradients& shape) {
  constexpr double share = 0.01;  // of its least height
  const double steepest =
      max(max(dot(shape.of[0], shape.of[0]), dot(shape.of[1], shape.of[1])),
          max(dot(shape.of[2], shape.of[2]), dot(shape.first(), shape.first())));
  return share / sqrt(steepest);
}

}  // namespace breccia::fdem3
