#pragma once
// Forces on faces, and velocities and forces that follow a table over time.

#include "fdem3/elements/tetrahedra.hpp"
#include "fdem_shared/over_time.hpp"

namespace breccia::fdem3 {

using fdem_shared::LoadKind;
using AmplitudeOf3 = fdem_shared::AmplitudeOf<Vec3>;
using LoadLaw = fdem_shared::LoadLawOf<Vec3>;
using PrescribedMotion = fdem_shared::PrescribedMotionOf<Vec3>;

/// A loaded face.
struct LoadedFace {
  Index tetrahedron;
  std::int16_t face;
  std::int16_t load;  ///< index into the laws
  double share;       ///< of the load's faces, by area at the start; of a fluid: filled part  [-]
  /// rho c_p and rho c_s of its tetrahedron  [Pa s/m]; of a bolt: x and y of what it pulls with [N]
  double impedance_p, impedance_s;
  double pull_z = 0.0;  ///<  [N]

  static LoadedFace of(Index number, std::int16_t load, double share) {
    return {number / 4, static_cast<std::int16_t>(number % 4), load, share, 0.0, 0.0};
  }
  /// A face that a bolt pulls at. @param pull  of its whole, shared out evenly  [N]
  static LoadedFace pulled(Index number, std::int16_t load, double share, const Vec3& pull) {
    return {number / 4, static_cast<std::int16_t>(number % 4), load, share, pull.x, pull.y, pull.z};
  }
  Index number() const { return 4 * tetrahedron + face; }
  Index& element() { return tetrahedron; }
  Index element() const { return tetrahedron; }
  BR_HD Vec3 pull() const { return {impedance_p, impedance_s, pull_z}; }
};

/// Adds the loads of one tetrahedron's faces, a third to each corner.
struct LoadForces {
  static constexpr const char* name = "fdem3.loads";
  View<const Index> starts;  ///< first loaded face of each loaded tetrahedron, and the end
  View<const LoadedFace> faces;
  View<const LoadLaw> laws;
  View<const TetrahedronNodes> nodes;
  View<Corners> external, force;

  BR_HD void set(const StepTime&) {}
  BR_HD void operator()(Index i) const {
    const Index t = faces[starts[i]].tetrahedron;
    Corners sum{};
    for (Index f = starts[i]; f < starts[i + 1]; ++f) add(faces[f], nodes[t], sum);
    external[t] = sum;
    for (int k = 0; k < 4; ++k) force[t].at[k] += sum.at[k];
  }

 private:
  BR_HD void add(const LoadedFace& face, const TetrahedronNodes& n, Corners& sum) const {
    int corner[3];
    for (int k = 0; k < 3; ++k) corner[k] = corner_of_face(face.face, k);
    const Vec3& p = n.at[corner[0]].position;
    const Vec3 outward = 0.5 * cross(n.at[corner[1]].position - p, n.at[corner[2]].position - p);
    const LoadLaw& law = laws[face.load];
    if (law.kind == LoadKind::absorbing) {
      const double area = norm(outward), third = area * law.factor.x / 3.0;
      const Vec3 normal = (1.0 / area) * outward;
      for (const int k : corner) {
        // t = -rho (c_p n n + c_s (1 - n n)) v (Lysmer and Kuhlemeyer 1969)
        const Vec3& v = n.at[k].velocity;
        const Vec3 straight = dot(v, normal) * normal;
        sum.at[k] -= third * (face.impedance_p * straight + face.impedance_s * (v - straight));
      }
      return;
    }
    const Vec3 whole = law.kind == LoadKind::pressure   ? -law.pressure * outward
                       : law.kind == LoadKind::fluid    ? (-law.pressure * face.share) * outward
                       : law.kind == LoadKind::traction ? norm(outward) * law.traction
                       : law.kind == LoadKind::bolt     ? face.share * face.pull()
                                                        : face.share * law.force;
    const Vec3 third{law.factor.x / 3.0 * whole.x, law.factor.y / 3.0 * whole.y,
                     law.factor.z / 3.0 * whole.z};
    for (const int k : corner) sum.at[k] += third;
  }
};

/// Impedance rho c_p of absorbing faces of a tetrahedron, times their largest factor; 0 elsewhere.
struct FaceDashpots {
  double at[4] = {0.0, 0.0, 0.0, 0.0};  ///<  [Pa s/m]
};

}  // namespace breccia::fdem3
