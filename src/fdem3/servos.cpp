#include "fdem3/servos.hpp"

#include "fdem3/shape.hpp"
#include "fdem3/stepping/launches.hpp"
#include "fdem_shared/servo_forces.hpp"

namespace breccia::fdem3 {

inline CoupleForces pressing_couples(World& w) {
  return couple_kernel(w);
}

}  // namespace breccia::fdem3

namespace breccia::fdem_shared {

template std::vector<ServoReading> read_servos(fdem3::World&, const fdem3::Config&);
template void correct_servos(fdem3::World&, const fdem3::Config&, const std::vector<ServoReading>&);
template void place_servos(fdem3::World&);

}  // namespace breccia::fdem_shared
