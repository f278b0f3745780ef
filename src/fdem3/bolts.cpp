// Bolts in tetrahedra: fdem_shared/bolts/bolts.hpp.

#include "fdem3/fluid/fluid.hpp"
#include "fdem3/shape.hpp"
#include "fdem_shared/bolts/pulling.hpp"

namespace breccia::fdem_shared {

template void pull_bolts(fdem3::World&);
template std::vector<BoltRowOf<Vec3>> bolt_rows(const fdem3::World&);
template std::vector<BoltSegmentOf<Vec3>> bolt_segments(const fdem3::World&);
template std::optional<Readings> read_bolt(const fdem3::World&, const ProbeConfig&);
template std::vector<BoltEnergy> bolt_energies(const fdem3::World&);

}  // namespace breccia::fdem_shared
