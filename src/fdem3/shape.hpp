#pragma once
// Tetrahedra, joined across faces, by the words of fdem_shared/shape.hpp.

#include "fdem3/ranks_shape.hpp"
#include "fdem3/setup/shape.hpp"
#include "fdem3/world.hpp"
#include "fdem_shared/fluid/flow.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem3 {

struct Shape : ShapeOfSetUp, ShapeOfRanks {
  using Elements = Tetrahedra;
  using Nodes = TetrahedronNodes;
  using CornersOfElement = Corners;
  using Vector = Vec3;
  using Law = ElasticTetrahedron;
  using Kick = fdem3::Kick;
  using Motion = fdem3::Motion;
  using Move = fdem3::MoveTetrahedra;
  using Hold = fdem3::Hold;
  using Stage = JointStage;
  using ContactPair = fdem3::ContactPair;
  using Reference = ShapeGradients;  ///< of an element at the start
  using Sides = FaceJoints;
  using Dashpots = FaceDashpots;
  using LoadedSide = LoadedFace;
  using Crack = CrackSide;
  using FlowCell = fdem_shared::FaceCell;
  static constexpr int dimension = 3;
  static constexpr Index corners = 4;
  static constexpr Index side_free = face_free, side_bonded = face_bonded;
  static constexpr const char *element = "tetrahedron", *size_word = "volume";
  static constexpr const char *elements_word = "tetrahedra", *force_unit = "N";
  static constexpr const char *side_a_word = "face_a", *side_b_word = "face_b";
  static constexpr const char *absorbing_sides = "absorbing faces", *port_words = "edges";

  // Members by the names that both methods share; of a constant world they are constant.
  template <class World>
  static auto& elements(World& w) {
    return w.tetrahedra;
  }
  template <class World>
  static auto& sides(World& w) {
    return w.faces;
  }
  template <class Joints>
  static auto& side_a(Joints& j) {
    return j.face_a;
  }
  template <class Joints>
  static auto& side_b(Joints& j) {
    return j.face_b;
  }
  template <class Elements>
  static auto& reference(Elements& e) {
    return e.shape;
  }
  template <class Model>
  static auto& corners_of(Model& model) {
    return model.tetrahedron;
  }
  static auto& loaded_sides(World& w) { return w.loaded_faces; }
  static View<const Index> laws(const World& w) { return laws_of(w); }
  static constexpr bool drops_separated = true;  ///< fdem_shared/separated.hpp
  BR_HD static double near(const ShapeGradients& reference) { return near_reach(reference); }

  /// Corner k of a side, 0 to dimension - 1, and the side that a corner does not lie on.
  BR_HD static Index corner_of_side(Index side, Index k) { return corner_of_face(side, k); }
  BR_HD static Index side_opposite(Index corner) { return corner; }
  static Index corner_opposite(Index side) { return side; }

  // Contact: sides press that nothing joins (fdem3/contact/search.cpp).
  static View<const std::uint8_t> exposed_sides(const World& w) {
    return w.tetrahedra.exposed.view();
  }
  static void note_exposed(World& w);

  /// A vertex has about six corners on the side of a body, and (lambda + 2 mu) times the size of an
  /// element as stiffness.  [N/m]
  BR_HD static double corner_stiffness(const ElasticTetrahedron& law, const ShapeGradients& shape) {
    return (law.bound_lambda() + 2.0 * law.bound_shear()) * 100.0 * near_reach(shape) / 6.0;
  }
  /// Of a face against another, 4/3 1.366 p A (elements/stable_step.hpp), for each corner of a
  /// body; A is at most the square of the size of an element.  [N/m]
  BR_HD static double pressed_corner(double penalty, const ShapeGradients& shape) {
    const double size = 100.0 * near_reach(shape);
    return 1.83 * penalty * size * size;
  }

  /// Whether rows of other methods come to those of corners, one element at a time.
  static bool meets_spheres(const World& w) { return w.meets_spheres; }
  /// Of what a support holds as a whole: no loads, no spheres.
  static bool contact_alone_presses(const World& w) {
    return w.tetrahedra.external.size() == 0 && !w.meets_spheres;
  }

  /// Present size over that at the start, and the square of a length that no corner may cover in a
  /// step.
  struct Size {
    double left;     ///<  [-]
    double squared;  ///<  [m2]
  };
  BR_HD static Size size_of(const TetrahedronNodes& n, const ShapeGradients& shape) {
    Vec3 x[4];
    places(n, x);
    const double height = 100.0 * near_reach(shape);  // the least one at the start
    return {deformation(shape, x).jacobian, height * height};
  }

  /// Whether a held element has been taken out of the model.
  BR_HD static bool is_gone(const Hold& hold) { return hold.gone != 0; }
};

}  // namespace breccia::fdem3

template <>
struct breccia::fdem_shared::ShapeOfWorld<breccia::fdem3::World> {
  using Shape = fdem3::Shape;
};
