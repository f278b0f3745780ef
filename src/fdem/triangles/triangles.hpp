#pragma once
// Arrays of deformable triangles.

#include "exec/buffer.hpp"
#include "fdem/laws/elastic_triangle.hpp"

namespace breccia::fdem {

/// A corner of a triangle. Every triangle owns its three: what ties coincident ones are joints,
/// bonds, or nothing. The position is at the time of the step, the velocity half a step earlier.
struct NodeState {
  Vec2 position;  ///<  [m]
  Vec2 velocity;  ///<  [m/s]
};

/// The corners of a triangle, counter-clockwise. Corner k of triangle t is node 3 t + k.
struct TriangleNodes {
  NodeState at[3];
};

/// One vector for each corner.
template <class Number>
struct CornerVectors {
  Vec2Of<Number> at[3];
};
using Corners = CornerVectors<double>;

/// Deformable triangles, three nodes each. One item for each triangle, ghosts included; who writes
/// it, in brackets, in the words of World. Constant: written by set-up; all of it moves with its
/// triangle between ranks.
struct Triangles {
  /// Others read the fields that each_field visits, no more: host_copy() makes no other array.
  static constexpr bool is_arrays_alone = true;

  Buffer<GlobalId> id;          ///< number of the triangle, kept for ever  [-]  (constant)
  Buffer<std::int16_t> group;   ///< body it belongs to  [-]  (constant)
  Buffer<Index> material;       ///< index into the case's materials  [-]  (constant)
  Buffer<TriangleNodes> nodes;  ///< positions and velocities  (move)
  Buffer<Mat2> shape_inverse;   ///< of the reference edges as columns  [1/m]  (constant)
  Buffer<double> mass;          ///< of each corner, per unit thickness  [kg/m]  (constant)
  Buffer<double> viscosity;     ///< eta  [Pa s]  (constant)
  Buffer<Corners> force;        ///< sum of all that acts now  [N/m]  (sums, loads, bundles)
  Buffer<Corners> external;     ///< the part of it by loads; empty: no loads  [N/m]  (loads)
  Buffer<Index> hold;           ///< index into Case::holds, -1: free  [-]  (stage)
  Buffer<double> viscous_work;  ///< taken out by viscosity so far  [J/m]  (sums)
  Buffer<double> damping_work;  ///< taken out by local damping so far  [J/m]  (move)
  Buffer<double> load_work;     ///< put in by loads and prescribed motion  [J/m]  (move)

  template <class Visit>
  void each_field(Visit&& field) {
    field("id", "-", id);
    field("group", "-", group);
    field("material", "-", material);
    field("nodes", "SI", nodes);
    field("shape_inverse", "1/m", shape_inverse);
    field("mass", "kg/m", mass);
    field("viscosity", "Pa s", viscosity);
    field("force", "N/m", force);
    field("hold", "-", hold);
    field("viscous_work", "J/m", viscous_work);
    field("damping_work", "J/m", damping_work);
    field("load_work", "J/m", load_work);
  }
  Index size() const { return id.size(); }
};

/// The nodes of all triangles by number: 3 t + k.
BR_HD inline View<const NodeState> by_number(const View<const TriangleNodes>& nodes) {
  View<const NodeState> view;
  view.data = nodes.data == nullptr ? nullptr : nodes.data[0].at;
  view.size = 3 * nodes.size;
  view.space = nodes.space;
  return view;
}

/// Corners of a triangle by component.
template <class R>
struct CornersOf {
  Vec2Of<R> x[3], v[3];

  BR_HD explicit CornersOf(const R (&c)[12]) {
    for (int k = 0; k < 3; ++k) {
      x[k] = {c[4 * k], c[4 * k + 1]};
      v[k] = {c[4 * k + 2], c[4 * k + 3]};
    }
  }
};

BR_HD inline void split(const TriangleNodes& nodes, Vec2 (&x)[3], Vec2 (&v)[3]) {
  for (int k = 0; k < 3; ++k) {
    x[k] = nodes.at[k].position;
    v[k] = nodes.at[k].velocity;
  }
}

}  // namespace breccia::fdem
