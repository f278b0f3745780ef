#pragma once
// Triangles, joined along edges, by the words of fdem_shared/shape.hpp.

#include "fdem/ranks_shape.hpp"
#include "fdem/setup/shape.hpp"
#include "fdem/world.hpp"
#include "fdem_shared/fluid/flow.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem {

/// Where a triangle counts as being.  [m]
inline Vec3 centroid(const TriangleNodes& nodes) {
  const Vec2 sum = nodes.at[0].position + nodes.at[1].position + nodes.at[2].position;
  return {sum.x / 3.0, sum.y / 3.0, 0.0};
}

struct Shape : ShapeOfSetUp, ShapeOfRanks {
  using Elements = Triangles;
  using Nodes = TriangleNodes;
  using CornersOfElement = Corners;
  using Vector = Vec2;
  using Law = ElasticTriangle;
  using Kick = fdem::Kick;
  using Motion = fdem::Motion;
  using Move = fdem::MoveTriangles;
  using Hold = fdem::Hold;
  using Stage = JointStage;
  using ContactPair = fdem::ContactPair;
  using Reference = Mat2;  ///< of an element at the start
  using Sides = EdgeJoints;
  using Dashpots = EdgeDashpots;
  using LoadedSide = LoadedEdge;
  using Crack = CrackSide;
  using FlowCell = fdem_shared::LineCell;
  static constexpr int dimension = 2;
  static constexpr Index corners = 3;
  static constexpr Index side_free = edge_free, side_bonded = edge_bonded;
  static constexpr const char *element = "triangle", *size_word = "area";
  static constexpr const char *elements_word = "triangles", *force_unit = "N/m";
  static constexpr const char *side_a_word = "edge_a", *side_b_word = "edge_b";
  static constexpr const char *absorbing_sides = "absorbing edges", *port_words = "vertices";

  // Members by the names that both methods share; of a constant world they are constant.
  template <class World>
  static auto& elements(World& w) {
    return w.triangles;
  }
  template <class World>
  static auto& sides(World& w) {
    return w.edges;
  }
  template <class Joints>
  static auto& side_a(Joints& j) {
    return j.edge_a;
  }
  template <class Joints>
  static auto& side_b(Joints& j) {
    return j.edge_b;
  }
  template <class Elements>
  static auto& reference(Elements& e) {
    return e.shape_inverse;
  }
  template <class Model>
  static auto& corners_of(Model& model) {
    return model.triangle;
  }
  static auto& loaded_sides(World& w) { return w.loaded_edges; }
  static View<const Index> laws(const World& w) { return laws_of(w); }
  static constexpr bool drops_separated = false;  ///< fdem_shared/separated.hpp
  BR_HD static double near(const Mat2& reference) { return near_reach(reference); }

  /// Corner k of a side, 0 to dimension - 1, and the side that a corner does not lie on.
  BR_HD static Index corner_of_side(Index side, Index k) { return (side + k) % 3; }
  BR_HD static Index side_opposite(Index corner) { return (corner + 1) % 3; }
  static Index corner_opposite(Index side) { return (side + 2) % 3; }

  // Contact: all sides press.
  static View<const std::uint8_t> exposed_sides(const World&) { return {}; }
  static void note_exposed(World&) {}

  /// A vertex has about three corners on the side of a body, and its modulus as stiffness.  [N/m2]
  BR_HD static double corner_stiffness(const ElasticTriangle& law, const Mat2&) {
    return (law.lambda + 2.0 * law.shear + law.bend) / 3.0;
  }
  /// A third of 3 p L (1/H + 1/H), one edge of an equilateral triangle against another: of each
  /// corner of a body.  [N/m2]
  BR_HD static double pressed_corner(double penalty, const Mat2&) { return 2.3 * penalty; }

  /// Whether rows of other methods come to those of corners, one element at a time.
  static bool meets_spheres(const World&) { return false; }
  /// Of what a support holds as a whole.
  static bool contact_alone_presses(const World& w) { return w.triangles.external.size() == 0; }

  /// Present size over that at the start, and the square of a length that no corner may cover in a
  /// step.
  struct Size {
    double left;     ///<  [-]
    double squared;  ///<  [m2]
  };
  BR_HD static Size size_of(const TriangleNodes& n, const Mat2& shape_inverse) {
    const Vec2& x = n.at[0].position;
    const double twice = cross(n.at[1].position - x, n.at[2].position - x);
    return {twice * determinant(shape_inverse), twice};
  }

  /// Whether a held element has been taken out of the model.
  BR_HD static bool is_gone(const Hold& hold) { return hold.gone != 0; }
};

}  // namespace breccia::fdem

template <>
struct breccia::fdem_shared::ShapeOfWorld<breccia::fdem::World> {
  using Shape = fdem::Shape;
};
