#pragma once
// Tetrahedra, joined across faces, by the words of fdem_shared/shape.hpp.

#include "core/region.hpp"
#include "fdem3/world.hpp"
#include "fdem_shared/fluid/flow.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem3 {

struct Shape {
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

  // Set-up (fdem3/setup).
  struct AtStart {
    ShapeGradients reference;
    double mass;  ///< of a corner  [kg]
    double edge;  ///< of the regular tetrahedron as large  [m]
  };
  static AtStart at_start(const TetrahedronNodes& nodes, double density, std::size_t number);
  /// Supports of this stage: the place in Case::holds of each tetrahedron of the whole mesh, -1:
  /// free.
  static std::vector<Index> prescribe(World& w, const Config& config);
  static constexpr const char *side_words = "faces", *named_word = "surface";
  static const std::string& named_sides(const RegionConfig& region) { return region.faces; }
  static auto& side_sets(const Model& model) { return model.face_sets; }
  static auto& sides_of_set(const Model::FaceSet& set) { return set.faces; }
  /// Whether a point lies in the forms of a region besides its box.
  static bool is_within(const RegionConfig& region, const Vec3& x) {
    return (!(region.radius > 0.0) || in_round(region.center, region.radius, region.around, x)) &&
           (region.polygon.empty() || in_polygon(region.polygon, seen_along(region.around, x)));
  }
  static bool is_plain(const RegionConfig& region) {
    return region.polygon.empty() && (region.around.empty() || !(region.radius > 0.0));
  }

  // Ranks (fdem3/ranks.cpp).

  /// Costs on one core, in units of some 10 ns (bench/notes/cpu.md).
  static constexpr fdem_shared::Costs costs{
      .element = 8, .end_of_joint = 4, .end_of_couple = 6, .tied_corner = 3};
  /// Waking joints look at tetrahedra that nothing ties yet.
  static bool needs_all_ghosts(const World& w) { return w.given->extrinsic; }
  /// Calls visit(forces) with the forces of all joints, as many as there are joints.
  template <class Visit>
  static void with_joint_forces(World& w, const Visit& visit) {
    visit(w.joints.force);
  }
  static void drop_joint_forces(Joints& j) { j.force.resize(0); }
  static void forget_mesh_for_kernels(World& w) {
    w.node_vertex.clear();
    w.side_across.clear();
  }
  static void derive_part(World& w, Space);
  static void take_common(World& w, Communicator& ranks);
  static void collect_common(const World& part, World& whole) {
    whole.fluid = part.fluid;
    whole.bolts = part.bolts;
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
