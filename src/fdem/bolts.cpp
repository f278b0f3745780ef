// Bolts in triangles: fdem_shared/bolts/bolts.hpp.

#include "fdem/fluid/fluid.hpp"
#include "fdem/shape.hpp"
#include "fdem_shared/bolts/pulling.hpp"

namespace breccia::fdem_shared {

template void pull_bolts(fdem::World&);
template std::vector<BoltRowOf<Vec2>> bolt_rows(const fdem::World&);
template std::vector<BoltSegmentOf<Vec2>> bolt_segments(const fdem::World&);
template std::optional<Readings> read_bolt(const fdem::World&, const ProbeConfig&);
template std::vector<BoltEnergy> bolt_energies(const fdem::World&);

}  // namespace breccia::fdem_shared
