#include "fdem/servos.hpp"

#include "fdem/shape.hpp"
#include "fdem/stepping/launches.hpp"
#include "fdem_shared/servo_forces.hpp"

namespace breccia::fdem {

/// Of a triangle whose corners are at x with the velocities v: the force on one of them.
struct ElasticForces {
  View<const Index> law;
  View<const ElasticTriangle> laws;
  View<const Mat2> shape_inverse;
  View<const double> viscosity;

  BR_HD Vec2 on_corner(Index t, int corner, const Vec2 (&x)[3], const Vec2 (&v)[3]) const {
    Vec2 on[3];
    corner_forces(laws[law[t]].stress(deformation(shape_inverse[t], x, v), viscosity[t]), x, on);
    return on[corner];
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

}  // namespace breccia::fdem

namespace breccia::fdem_shared {

template std::vector<ServoReading> read_servos(fdem::World&, const fdem::Config&);
template void correct_servos(fdem::World&, const fdem::Config&, const std::vector<ServoReading>&);
template void place_servos(fdem::World&);

}  // namespace breccia::fdem_shared
