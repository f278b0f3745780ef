#pragma once
// Kernels of each tetrahedron by itself: its sum of forces, corners that move as one.

#include "core/incidence.hpp"
#include "fdem3/contact/couples.hpp"
#include "fdem3/elements/motion.hpp"
#include "fdem3/joints/joints.hpp"
#include "fdem_shared/bundles.hpp"
#include "math/records.hpp"

namespace breccia::fdem3 {

/// Internal force of the tetrahedron, plus its joints by face, plus its couples by the partners'
/// global ids: no order of memory, threads or ranks changes a bit.
/// @tparam bedded  whether some rock is stiffer in one direction than in others
template <bool bedded>
struct ElementForcesOf {
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
    R shape[9];
    R viscosity;
    Indices<R> material;
    Index couples, couples_end;  ///< of the first tetrahedron, and of the last
    FaceJoints faces[width_of<R>];
  };
  BR_HD void set(const StepTime& now) { span = now.last_dt; }
  /// All but forces of joints and couples.
  template <class R>
  BR_HD void load_early(Index t, Loaded<R>& loaded) const {
    for (Index i = 0; i < width_of<R>; ++i)
      for (int k = 0; k < 4; ++k) loaded.faces[i].at[k] = read_now(&faces[t + i].at[k]);
    loaded.material = load_indices_now<R>(material, t);
    loaded.viscosity = load_now<R>(viscosity, t);
    loaded.couples = read_now(&couples.starts[t]);
    loaded.couples_end = read_now(&couples.starts[t + width_of<R>]);
    loaded.nodes.read(nodes, t);
    if constexpr (width_of<R> == 1) {
      const ShapeGradients own = shape[t];
      __builtin_memcpy(loaded.shape, &own, sizeof own);
    } else {
      gather_odd(shape, consecutive<R>(t), loaded.shape);
    }
    loaded.nodes.wait();
  }
  template <class R>
  BR_HD void load_late(Index, Loaded<R>&) const {}
  /// Tetrahedron t, or t and its neighbours in a pack.
  template <class R>
  BR_HD void update(Index t, const Loaded<R>& loaded) const {
    R numbers[12];
    deform(t, loaded, numbers);
    if constexpr (width_of<R> == 1) {
      Corners sum;
      __builtin_memcpy(&sum, numbers, sizeof sum);
      add_pairs(loaded.faces[0], loaded.couples, loaded.couples_end, sum);
      __builtin_memcpy(numbers, &sum, sizeof sum);
      fdem_shared::Columns<double, Corners>::write(force, t, numbers);
    } else {
      store_records(force, t, numbers);
      for (Index i = 0; i < width_of<R>; ++i) {
        Corners sum = force[t + i];
        const bool touches = loaded.couples < loaded.couples_end;
        add_pairs(loaded.faces[i], touches ? couples.starts[t + i] : 0,
                  touches ? couples.starts[t + i + 1] : 0, sum);
        force[t + i] = sum;
      }
    }
  }
  BR_HD void operator()(Index t) const { run_at<double>(*this, t); }

 private:
  /// Internal forces on the corners, and the work of viscosity.
  template <class R>
  BR_HD void deform(Index t, const Loaded<R>& loaded, R (&force_on)[12]) const {
    Vec3Of<R> x[4], v[4], sum[4];
    for (int k = 0; k < 4; ++k) {
      const R* c = loaded.nodes.numbers + 6 * k;
      x[k] = {c[0], c[1], c[2]};
      v[k] = {c[3], c[4], c[5]};
    }
    ShapeGradientsOf<R> g;
    for (int k = 0; k < 3; ++k)
      g.of[k] = {loaded.shape[3 * k], loaded.shape[3 * k + 1], loaded.shape[3 * k + 2]};
    const R volume = g.volume(), eta = loaded.viscosity;
    const DeformationOf<R> d = deformation(g, x);
    Sym3Of<R> rate{};
    const auto flows = eta > 0.0;
    if (any(flows)) {
      rate = deformation_rate(g, d, v);
      const R before = load<R>(viscous_work, t);
      const R spent = span * (eta * contract(rate, rate) * d.jacobian * volume);
      breccia::store(viscous_work, t, select(flows, before + spent, before));
    }
    R law[bedded ? 16 : 8];
    gather_records(laws, loaded.material, law);
    const ElasticTetrahedronOf<R> elastic{
        law[0], law[1], {law[2], law[3], law[4], law[5], law[6], law[7]}};
    Mat3Of<R> piola = elastic.piola(d, eta, rate);
    if constexpr (bedded) add_planes(law, d.gradient, piola);
    corner_forces(g, volume, piola, sum);
    for (int k = 0; k < 4; ++k) {
      force_on[3 * k] = sum[k].x;
      force_on[3 * k + 1] = sum[k].y;
      force_on[3 * k + 2] = sum[k].z;
    }
  }
  /// Share of the planes of a law; nothing, to the bit, where it has none.
  template <class R>
  BR_HD static void add_planes(const R (&law)[16], const Mat3Of<R>& f, Mat3Of<R>& piola) {
    const PlanesOf<R> planes{{law[8], law[9], law[10]}, law[11], law[12], law[13], {}, {}};
    const auto any_here = dot(planes.across, planes.across) > 0.0;
    if (!any(any_here)) return;
    const Mat3Of<R> more = planes.piola(f);
    piola.a = select(any_here, piola.a + more.a, piola.a);
    piola.b = select(any_here, piola.b + more.b, piola.b);
    piola.c = select(any_here, piola.c + more.c, piola.c);
  }
  /// Adds the forces of joints, by face, and of couples [from, to) of the list.
  BR_HD void add_pairs(const FaceJoints& own, Index from, Index to, Corners& sum) const {
    for (int k = 0; k < 4; ++k) add_joint(own.at[k], k, sum);
    for (Index c = from; c < to; ++c) {
      const Entry entry = couples.entries[c];
      const CoupleForce& f = couple_force[pair_of(entry)];
      const Corners& mine = side_of(entry) == 0 ? f.on_a : f.on_b;
      for (int k = 0; k < 4; ++k) sum.at[k] += mine.at[k];
    }
  }
  /// Adds the forces of the joint on face k.
  BR_HD void add_joint(Index entry, int k, Corners& sum) const {
    if (entry < 0) return;
    const Index joint = pair_of(entry);
    const JointForce& f = joint_force[joint];
    const bool on_a = side_of(entry) == 0;
    const int first = turn[joint];
    for (int i = 0; i < 3; ++i) {
      Vec3& here = sum.at[corner_of_face(k, i)];  // known when it is compiled: `sum` in registers
      if (on_a)
        here += f.at[(first + 3 - i) % 3];
      else
        here -= f.at[i];
    }
  }
};

using ElementForces = ElementForcesOf<false>;
using BeddedForces = ElementForcesOf<true>;

using fdem_shared::Bundles;
using BundleForces = fdem_shared::BundleForces<Corners>;

}  // namespace breccia::fdem3
