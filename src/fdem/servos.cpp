#include "fdem/servos.hpp"

#include "fdem/shape.hpp"
#include "fdem/stepping/launches.hpp"
#include "fdem_shared/servo_forces.hpp"

namespace breccia::fdem {

inline CoupleForces<double> pressing_couples(World& w) {
  return couple_kernel<double>(w);
}

}  // namespace breccia::fdem

namespace breccia::fdem_shared {

template std::vector<ServoReading> read_servos(fdem::World&, const fdem::Config&);
template void correct_servos(fdem::World&, const fdem::Config&, const std::vector<ServoReading>&);
template void place_servos(fdem::World&);

}  // namespace breccia::fdem_shared
