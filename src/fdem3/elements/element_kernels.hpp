#pragma once
// Kernels of each tetrahedron by itself: its sum of forces, corners that move as one.

#include "core/incidence.hpp"
#include "fdem3/contact/couples.hpp"
#include "fdem3/elements/motion.hpp"
#include "fdem3/joints/joints.hpp"
#include "fdem_shared/bundles.hpp"

namespace breccia::fdem3 {

/// Internal force of the tetrahedron, plus its joints by face, plus its couples by the partners'
/// global ids: no order of memory, threads or ranks changes a bit.
struct ElementForces {
  static constexpr const char* name = "fdem3.elements";
  double span;  ///< time that the forces of this moment act  [s]
  View<const TetrahedronNodes> nodes;
  View<const Index> material;
  View<const ElasticTetrahedron> laws;
  View<const ShapeGradients> shape;
  View<const double> viscosity;
  View<const FaceJoints> faces;
  View<const std::uint8_t> turn;  ///< of the joints
  View<const JointForce> joint_force;
  IncidenceView couples;
  View<const CoupleForce> couple_force;
  View<Corners> force;
  View<double> viscous_work;

  template <class R>
  struct Loaded {
    fdem_shared::Columns<R, TetrahedronNodes> nodes;
    ShapeGradients shape;
    double viscosity;
    Index material, couples, couples_end;
    FaceJoints faces;
  };
  BR_HD void set(const StepTime& now) { span = now.last_dt; }
  /// All but forces of joints and couples.
  BR_HD void load_early(Index t, Loaded<double>& loaded) const {
    for (int k = 0; k < 4; ++k) loaded.faces.at[k] = read_now(&faces[t].at[k]);
    loaded.material = read_now(&material[t]);
    loaded.viscosity = read_now(&viscosity[t]);
    loaded.couples = read_now(&couples.starts[t]);
    loaded.couples_end = read_now(&couples.starts[t + 1]);
    loaded.nodes.read(nodes, t);
    loaded.shape = shape[t];
    loaded.nodes.wait();
  }
  BR_HD void load_late(Index, Loaded<double>&) const {}
  BR_HD void update(Index t, const Loaded<double>& loaded) const {
    Corners sum;
    deform(t, loaded, sum.at);
    for (int k = 0; k < 4; ++k) add_joint(loaded.faces.at[k], k, sum);
    for (Index c = loaded.couples; c < loaded.couples_end; ++c) {
      const Entry entry = couples.entries[c];
      const CoupleForce& f = couple_force[pair_of(entry)];
      const Corners& mine = side_of(entry) == 0 ? f.on_a : f.on_b;
      for (int k = 0; k < 4; ++k) sum.at[k] += mine.at[k];
    }
    double numbers[sizeof sum / sizeof(double)];
    __builtin_memcpy(numbers, &sum, sizeof sum);
    fdem_shared::Columns<double, Corners>::write(force, t, numbers);
  }
  BR_HD void operator()(Index t) const { run_at<double>(*this, t); }

 private:
  /// Internal forces on the corners, and the work of viscosity.
  BR_HD void deform(Index t, const Loaded<double>& loaded, Vec3 (&sum)[4]) const {
    TetrahedronNodes own;
    __builtin_memcpy(&own, loaded.nodes.numbers, sizeof own);
    Vec3 x[4], v[4];
    split(own, x, v);
    const ShapeGradients& g = loaded.shape;
    const double volume = g.volume(), eta = loaded.viscosity;
    const Deformation d = deformation(g, x);
    Sym3 rate{};
    if (eta > 0.0) {
      rate = deformation_rate(g, d, v);
      viscous_work[t] += span * (eta * contract(rate, rate) * d.jacobian * volume);
    }
    corner_forces(g, volume, laws[loaded.material].piola(d, eta, rate), sum);
  }
  /// Adds the forces of the joint on face k.
  BR_HD void add_joint(Index entry, int k, Corners& sum) const {
    if (entry < 0) return;
    const Index joint = pair_of(entry);
    const JointForce& f = joint_force[joint];
    const bool on_a = side_of(entry) == 0;
    const int first = turn[joint];
    for (int i = 0; i < 3; ++i) {
      const int corner = corner_of_face(k, on_a ? (first + 3 - i) % 3 : i);
      if (on_a)
        sum.at[corner] += f.at[i];
      else
        sum.at[corner] -= f.at[i];
    }
  }
};

using fdem_shared::Bundles;
using BundleForces = fdem_shared::BundleForces<Corners>;

}  // namespace breccia::fdem3
