#include "fdem3/servos.hpp"

#include "fdem3/shape.hpp"
#include "fdem3/stepping/launches.hpp"
#include "fdem_shared/servo_forces.hpp"

namespace breccia::fdem3 {

/// Of a tetrahedron whose corners are at x with the velocities v: the forces on them.
struct ElasticForces {
  View<const Index> material;
  View<const ElasticTetrahedron> laws;
  View<const ShapeGradients> shape;
  View<const double> viscosity;

  BR_HD void on_corners(Index t, const Vec3 (&x)[4], const Vec3 (&v)[4], Vec3 (&on)[4]) const {
    const ShapeGradients g = shape[t];
    const Deformation d = deformation(g, x);
    const double eta = viscosity[t];
    const Sym3 rate = eta > 0.0 ? deformation_rate(g, d, v) : Sym3{};
    corner_forces(g, g.volume(), laws[material[t]].piola(d, eta, rate), on);
  }
};
inline ElasticForces elastic_forces(World& w) {
  return {laws_of(w), w.given->laws.view(), std::as_const(w.tetrahedra.shape).view(),
          std::as_const(w.tetrahedra.viscosity).view()};
}

inline CoupleForces pressing_couples(World& w) {
  return couple_kernel(w);
}
template <class Visit>
void with_couples(World& w, const Visit& visit) {
  visit(couple_kernel(w));
}

/// Couples of a kernel, on the host.
inline void run_couples_elsewhere(const World& w, const CoupleForces& couples, Index count) {
  for_each_run(w.exec, count, 64, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) couples.slow(i);
  });
}

}  // namespace breccia::fdem3

namespace breccia::fdem_shared {

template std::vector<ServoReading> read_servos(fdem3::World&, const fdem3::Config&);
template void correct_servos(fdem3::World&, const fdem3::Config&, const std::vector<ServoReading>&);
template void place_servos(fdem3::World&);

}  // namespace breccia::fdem_shared
