#pragma once
// Forces of spheres and tetrahedra on each other, added to those of their own kind: each item adds
// up its own, bonds first, then touches and faces, in the order of the lists.

#include "coupled/bonds.hpp"
#include "fdem3/elements/stable_step.hpp"

namespace breccia::coupled {

struct AddToSpheres {
  static constexpr const char* name = "coupled.add_to_spheres";
  View<const SphereRow> rows;
  View<const BallBondState> bonds;
  View<const SphereForce> touches;
  View<const double> mass, inertia;
  View<Vec3> force, torque;
  View<double> critical;  ///< inertia over stiffness, of all there was before  [s2]

  BR_HD void operator()(Index i) const {
    const SphereRow& row = rows[i];
    if (row.here < 0) return;
    SphereForce sum{};
    const auto add = [&sum](const SphereForce& more) {
      sum.force += more.force;
      sum.torque += more.torque;
      sum.straight += more.straight;
      sum.turning += more.turning;
    };
    for (Index b = row.bond; b < row.bond_end; ++b) add(bonds[b].force);
    for (Index t = row.touch; t < row.touch_end; ++t) add(touches[t]);
    const Index e = row.here;
    force[e] += sum.force;
    torque[e] += sum.torque;
    const double slow = max(sum.straight / mass[e], sum.turning / inertia[e]);
    // Stiffnesses add, so their critical times squared add like resistances in parallel.
    if (slow > 0.0) critical[e] = 1.0 / (1.0 / critical[e] + slow);
  }
};

/// Tetrahedra that spheres are near or tied to, and the places of both in their lists.
struct TetrahedronRows {
  Buffer<Index> tetrahedron;         ///< number
  Buffer<Index> face_starts, faces;  ///< into NearFaces
  Buffer<Index> bond_starts, bonds;  ///< into BallBonds
};

struct AddToTetrahedra {
  static constexpr const char* name = "coupled.add_to_tetrahedra";
  View<const Index> here;  ///< of each row, -1: another rank owns it
  View<const Index> face_starts, faces, bond_starts, bonds;
  View<const Index> face;
  View<const FaceForce> on_face;
  View<const Pressed> pressed;
  View<const BallBond> tie;
  View<const BallBondState> bond_state;
  fdem3::StableStep stable;
  View<fdem3::Corners> force;
  View<double> step;  ///< stable, of each row  [s]

  BR_HD void operator()(Index i) const {
    const Index t = here[i];
    if (t < 0) {
      step[i] = largest_least;
      return;
    }
    fdem3::Corners sum = force[t];
    double stiffness[4] = {};  // sums of the rows of the corners
    for (Index e = bond_starts[i]; e < bond_starts[i + 1]; ++e) {
      const BallBond& b = tie[bonds[e]];
      const BallBondState& s = bond_state[bonds[e]];
      for (int k = 0; k < 4; ++k) {
        sum.at[k] += b.share[k] * s.on_point;
        stiffness[k] += 2.0 * b.share[k] * s.force.straight;
      }
    }
    for (Index e = face_starts[i]; e < face_starts[i + 1]; ++e) {
      const Index j = faces[e];
      for (int k = 0; k < 3; ++k) {
        const int corner = fdem3::corner_of_face(face[j] % 4, k);
        sum.at[corner] += on_face[j].at[k];
        if (pressed[j].touches())
          stiffness[corner] += 2.0 * abs(pressed[j].part(k)) * pressed[j].stiffness;
      }
    }
    force[t] = sum;
    step[i] = step_with(t, stiffness);
  }

 private:
  BR_HD double step_with(Index t, const double (&stiffness)[4]) const {
    const double most = max(max(stiffness[0], stiffness[1]), max(stiffness[2], stiffness[3]));
    if (!(most > 0.0)) return largest_least;
    const fdem3::StableStep::Parts p = stable.parts(t);
    return fdem_shared::stable_step_of(p.square + most / stable.mass[t], p.viscous + p.absorbed,
                                       stable.mass[t]);
  }
};

}  // namespace breccia::coupled
