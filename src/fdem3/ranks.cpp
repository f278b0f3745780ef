#include "fdem3/ranks.hpp"

#include "fdem3/fluid/fluid.hpp"
#include "fdem3/relations.hpp"
#include "fdem_shared/fluid/ranks.hpp"
#include "fdem_shared/migration.hpp"

namespace breccia::fdem3 {

void ShapeOfRanks::take_common(World& w, Communicator& ranks) {
  fdem_shared::take_fluid(ranks, *w.given, w.fluid);
  fdem_shared::take_gas(ranks, w.fluid.gas);
  fdem_shared::take_bolts(ranks, *w.given, w.bolts);
}

void ShapeOfRanks::derive_part(World& w, Space) {
  if (w.given->extrinsic) {
    w.stress.resize(w.tetrahedra.size());
    w.overshoot.resize(w.joints.size());
  }
  list_loaded(w);
}

}  // namespace breccia::fdem3

namespace breccia::fdem_shared {

template fdem3::World share_out(fdem3::World&, Communicator&, const DomainConfig&, Space);
template fdem3::World share_parts(fdem3::World, const std::vector<std::uint8_t>&, Communicator&,
                                  const DomainConfig&, Space);
template void migrate(fdem3::World&);
template void rebalance(fdem3::World&);
template void collect(fdem3::World&, fdem3::World&);
template void drop_state(fdem3::World&);

}  // namespace breccia::fdem_shared
