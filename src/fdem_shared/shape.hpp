#pragma once
// The shape of elements, which tells both finite-discrete methods apart: triangles joined along
// edges (fdem), tetrahedra joined across faces (fdem3). The text that both share is written once,
// in this folder, over a world's shape: fdem/shape.hpp and fdem3/shape.hpp. Edges and faces are
// `sides` there, and element t has as many of them as corners: corner k is node corners t + k, side
// k is corners t + k.

#include <vector>

#include "exec/buffer.hpp"
#include "math/vec.hpp"
#include "math/vec2.hpp"

namespace breccia::fdem_shared {

/// The shape of a world's elements: each method specialises it.
template <class World>
struct ShapeOfWorld;
template <class World>
using ShapeOf = typename ShapeOfWorld<World>::Shape;

/// Work that one item gives to its rank; only ratios matter.  [-]
struct Costs {
  std::int64_t element, end_of_joint, end_of_couple, tied_corner;
};

/// A vector of the plane, or of space, in space.
BR_HD inline Vec3 to_space(const Vec2& v) {
  return {v.x, v.y, 0.0};
}
BR_HD inline Vec3 to_space(const Vec2Of<float>& v) {
  return to_space(converted<double>(v));
}
BR_HD inline Vec3 to_space(const Vec3& v) {
  return v;
}
/// Vector of the method (plane or space) from one in space.
template <class Vector>
BR_HD Vector from_space(const Vec3& v);
template <>
BR_HD inline Vec2 from_space<Vec2>(const Vec3& v) {
  return {v.x, v.y};
}
template <>
BR_HD inline Vec3 from_space<Vec3>(const Vec3& v) {
  return v;
}

/// Component of a vector, to read or to write.
BR_HD inline double& part_of(Vec2& v, int axis) {
  return axis == 0 ? v.x : v.y;
}
BR_HD inline double& part_of(Vec3& v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}
BR_HD inline double part_of(const Vec2& v, int axis) {
  return axis == 0 ? v.x : v.y;
}
BR_HD inline double part_of(const Vec3& v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// Component of arm x force; in the plane it has one.
BR_HD inline double moment(const Vec2& arm, const Vec2& force, int) {
  return cross(arm, force);
}
BR_HD inline double moment(const Vec3& arm, const Vec3& force, int axis) {
  return part_of(cross(arm, force), axis);
}

/// The components that bits 0, 1, 2 hold, and the others as they are.
BR_HD inline Vec2 held_parts(int bits, const Vec2& given, const Vec2& other) {
  return {(bits & 1) != 0 ? given.x : other.x, (bits & 2) != 0 ? given.y : other.y};
}
BR_HD inline Vec3 held_parts(int bits, const Vec3& given, const Vec3& other) {
  return {(bits & 1) != 0 ? given.x : other.x, (bits & 2) != 0 ? given.y : other.y,
          (bits & 4) != 0 ? given.z : other.z};
}

/// Whether an element has been taken out of the model.
/// @param hold  its place in Case::holds, -1: free
template <class Shape, class Hold>
BR_HD bool is_gone(const View<const Hold>& holds, Index hold) {
  return hold >= 0 && Shape::is_gone(holds[hold]);
}

/// Whether a joint has a side on an element that has been taken out.
/// @param gone  1: of each element of this world that has been; empty: none has
template <class World, class Joints>
bool is_beside_gone(const Joints& joints, Index i, const std::vector<std::uint8_t>& gone) {
  using Shape = ShapeOf<World>;
  const auto is_out = [&](Index side) {
    return gone[static_cast<std::size_t>(side / Shape::corners)] != 0;
  };
  return !gone.empty() &&
         (is_out(Shape::side_a(joints).data()[i]) || is_out(Shape::side_b(joints).data()[i]));
}

/// The vertex of each node, where kernels can read it.
template <class World>
View<const Index> node_vertices(World& w) {
  if (static_cast<std::size_t>(w.node_vertex.size()) != w.vertex.size())
    copy_to(w.node_vertex, w.vertex);
  return std::as_const(w.node_vertex).view();
}

}  // namespace breccia::fdem_shared
