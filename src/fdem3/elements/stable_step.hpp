#pragma once
// The stable step of a tetrahedron.

#include "fdem3/elements/element_kernels.hpp"
#include "fdem3/elements/loads.hpp"
#include "fdem_shared/stable_parts.hpp"

namespace breccia::fdem3 {

/// Gershgorin's bound: every eigenfrequency is at most the largest sum of a row's |stiffness| over
/// its mass (docs/theory-fdem3.md, 4). Contact counts at exposed faces of tetrahedra that another
/// one is near to, and of those so fast that they might pass what is near between two evaluations.
struct StableStep {
  View<const TetrahedronNodes> nodes;
  View<const Index> material, law_of;
  View<const ElasticTetrahedron> laws;
  View<const ShapeGradients> shape;
  View<const double> viscosity, mass;
  View<const ContactPair> contacts;
  Index materials;
  View<const FaceJoints> faces;
  View<const std::uint8_t> exposed;
  View<const JointBond> bonds;
  View<const Index> bond_of;
  View<const FaceShape> joint_shape;
  View<const double> joint_length;
  View<const JointStage> stage;
  View<const Index> hold;
  View<const Hold> holds;
  View<const FaceDashpots> dashpots;  ///< empty: nothing absorbs
  IncidenceView couples;
  View<const Index> couple_a, couple_b;
  View<const fdem_shared::CouplePhase> phase;
  View<const Index> joint_a, joint_b;  ///< faces of the joints
  int evaluate_every;                  ///< steps from one evaluation to the next

  using Parts = fdem_shared::StepParts;  ///< of the largest row sum

  BR_HD double operator()(Index t) const { return parts(t).step; }

  /// Step of tetrahedron t if another body were near each of its faces.
  BR_HD Parts parts_pressed(Index t) const {
    Vec3 x[4];
    places(nodes[t], x);
    return parts(t, x, exposed[t]);
  }
  BR_HD Parts parts(Index t) const {
    Vec3 x[4], v[4];
    split(nodes[t], x, v);
    const int open = exposed[t];
    if (is_loose(t)) return parts(t, x, open);
    return fdem_shared::parts_until_next([&, this](int pressed) { return parts(t, x, pressed); },
                                         open == 0 || is_near(t, x) ? open : 0, open, v,
                                         evaluate_every,
                                         [&, this] { return near_reach(shape[t]); });
  }
  /// The rows of its corners, held ones too, whatever they move with.
  /// @param longest  no step until the next evaluation is longer  [s]
  BR_HD void list(Index t, double longest, fdem_shared::Pressed where, Parts (&corner)[4]) const {
    Vec3 x[4], v[4];
    split(nodes[t], x, v);
    int pressed = where == fdem_shared::Pressed::nowhere ? 0 : exposed[t];
    if (pressed != 0 && where == fdem_shared::Pressed::soon && !is_loose(t) && !is_near(t, x))
      pressed = fdem_shared::pressed_until_next(0, pressed, v, evaluate_every * longest,
                                                [&, this] { return near_reach(shape[t]); });
    const Form form(*this, t, x, pressed);
    for (int i = 0; i < 4; ++i) corner[i] = form.row(*this, t, i);
  }
  /// Whether a corner goes where it is told, whatever its mass.
  BR_HD bool is_held(Index t, int corner) const {
    return hold[t] >= 0 && holds[hold[t]].fixed_at(corner) == 7 && holds[hold[t]].loose == 0;
  }
  /// Whether it is a part of a rigid body that forces move: only what it meets is stiff. Contact
  /// counts wherever it is exposed: else nothing bounds the step of a body at rest.
  BR_HD bool is_loose(Index t) const { return hold[t] >= 0 && holds[hold[t]].loose != 0; }

 private:
  /// Whether another tetrahedron is near. Searches list all pairs that may come as near as the sum
  /// of both reaches before the next search.
  BR_HD bool is_near(Index t, const Vec3 (&x)[4]) const {
    const double reach = near_reach(shape[t]);
    const auto near = [&, this](Index other) {
      Vec3 y[4];
      places(nodes[other], y);
      return !boxes_apart(x, y, reach + near_reach(shape[other]));
    };
    for (int k = 0; k < 4; ++k) {  // also before a search lists it
      const Index entry = faces[t].at[k];
      if (entry < 0 || !is_parted(stage[pair_of(entry)])) continue;
      if (near((side_of(entry) == 0 ? joint_b : joint_a)[pair_of(entry)] / 4)) return true;
    }
    const Index last = couples.last(t);
    for (Index c = couples.first(t); c < last; ++c) {
      const Index couple = pair_of(couples.entries[c]);
      if (phase[couple] == fdem_shared::CouplePhase::waits) continue;
      if (near(side_of(couples.entries[c]) == 0 ? couple_b[couple] : couple_a[couple])) return true;
    }
    return false;
  }

  /// A tetrahedron as it stands now, and what its faces add to the rows of its corners.
  struct Form {
    Target target;
    Parts of_faces[4];
    BR_HD Form(const StableStep& s, Index t, const Vec3 (&x)[4], int pressed)
        : target(Target::of(x)) {
      for (int k = 0; k < 4; ++k) s.add_face(t, k, x, (pressed >> k & 1) != 0, of_faces);
    }
    BR_HD Parts row(const StableStep& s, Index t, int i) const {
      const ElasticTetrahedron& law = s.laws[s.law_of[t]];
      Parts p = of_faces[i];
      if (!s.is_loose(t))
        fdem_shared::add_element<3>(p, target.slope, i, {1.0, target.six_volumes / 6.0},
                                    law.bound_lambda(), law.bound_shear(), s.viscosity[t]);
      return p;
    }
  };
  /// @param pressed  bits of the faces whose contact counts
  BR_HD Parts parts(Index t, const Vec3 (&x)[4], int pressed) const {
    const Form form(*this, t, x, pressed);
    Parts largest;
    for (int i = 0; i < 4; ++i) {
      if (is_held(t, i)) continue;
      Parts p = form.row(*this, t, i);
      p.finish(mass[t]);
      if (p.step < largest.step) largest = p;
    }
    return largest;
  }
  /// A live joint adds 2 p_f A/(3 h) to each row of its nodes, a softened one a quarter more (by
  /// its corners); an exposed face 4 k_n A/3 times at most 1.366; an absorbing one a third of its
  /// area times its impedance.
  BR_HD void add_face(Index t, int k, const Vec3 (&x)[4], bool pressed, Parts (&corner)[4]) const {
    double joint = 0.0, contact = 0.0, absorbed = 0.0;
    const Index entry = faces[t].at[k];
    if (entry >= 0 && is_live(stage[pair_of(entry)])) {
      const Index i = pair_of(entry);
      const double share = stage[i] == JointStage::softened ? 1.0 / 3.0 + corner_share : 1.0 / 3.0;
      joint = 2.0 * share * bonds[bond_of[i]].stiffness * joint_shape[i].area() / joint_length[i];
    }
    const bool absorbs = dashpots.size > 0 && dashpots[t].at[k] > 0.0;
    if (pressed || absorbs) {
      const Vec3 p = x[corner_of_face(k, 0)];
      const double area =
          0.5 * norm(cross(x[corner_of_face(k, 1)] - p, x[corner_of_face(k, 2)] - p));
      if (pressed) {
        const ContactPair& pair = contacts[material[t] * materials + material[t]];
        contact = 4.0 / 3.0 * (1.366 * pair.penalty + pair.tangential) * area;
      }
      if (absorbs) absorbed = area / 3.0 * dashpots[t].at[k];
    }
    for (int i = 0; i < 3; ++i) {
      Parts& p = corner[corner_of_face(k, i)];
      p.joint += joint;
      p.contact += contact;
      p.absorbed += absorbed;
    }
  }
};

}  // namespace breccia::fdem3
