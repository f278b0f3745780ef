#include "fdem/servos.hpp"

#include "fdem/shape.hpp"
#include "fdem/stepping/kernel_lanes.hpp"
#include "fdem/stepping/launches.hpp"
#include "fdem_shared/servo_forces.hpp"

namespace breccia::fdem {

/// Of a triangle whose corners are at x with the velocities v: the forces on them.
struct ElasticForces {
  View<const Index> law;
  View<const ElasticTriangle> laws;
  View<const Mat2> shape_inverse;
  View<const double> viscosity;

  BR_HD void on_corners(Index t, const Vec2 (&x)[3], const Vec2 (&v)[3], Vec2 (&on)[3]) const {
    corner_forces(laws[law[t]].stress(deformation(shape_inverse[t], x, v), viscosity[t]), x, on);
  }
};
inline ElasticForces elastic_forces(World& w) {
  return {laws_of(w), w.given->laws.view(), std::as_const(w.triangles.shape_inverse).view(),
          std::as_const(w.triangles.viscosity).view()};
}

inline CoupleForces<double> pressing_couples(World& w) {
  return couple_kernel<double>(w);
}
/// Of numbers as the run stores forces.
template <class Visit>
void with_couples(World& w, const Visit& visit) {
  with_number(w.exec.precision, [&](auto number) { visit(couple_kernel<decltype(number)>(w)); });
}

/// Couples of a kernel, on the host.
template <class Couples>
void run_couples_elsewhere(const World& w, const Couples& couples, Index count) {
  for_each_run(w.exec, count, 64,
               [&](Index begin, Index end) { run_packs(w.lanes, couples, begin, end); });
}

}  // namespace breccia::fdem

namespace breccia::fdem_shared {

template std::vector<ServoReading> read_servos(fdem::World&, const fdem::Config&);
template void correct_servos(fdem::World&, const fdem::Config&, const std::vector<ServoReading>&);
template void place_servos(fdem::World&);

}  // namespace breccia::fdem_shared
