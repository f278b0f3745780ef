#include "fdem/ranks.hpp"

#include "fdem/fluid/fluid.hpp"
#include "fdem/relations.hpp"
#include "fdem_shared/fluid/ranks.hpp"
#include "fdem_shared/migration.hpp"

namespace breccia::fdem {

void ShapeOfRanks::take_common(World& w, Communicator& ranks) {
  fdem_shared::take_fluid(ranks, *w.given, w.fluid);
  fdem_shared::take_bolts(ranks, *w.given, w.bolts);
  fdem_shared::take_gas(ranks, w.fluid.gas);
}

void ShapeOfRanks::derive_part(World& w, Space space) {
  const Index joints = w.joints.size();
  std::vector<JointEnds> ends;
  ends.reserve(at(joints));
  for (Index i = 0; i < joints; ++i)
    ends.push_back(JointEnds::of(w.joints.edge_a.data()[i], w.joints.edge_b.data()[i]));
  copy_to(w.joint_ends, ends);
  if (w.given->extrinsic) {
    w.stress.resize(w.triangles.size());
    w.overshoot.resize(joints);
  }
  list_loaded(w);
  w.joint_packs.clear();
  if (space != Space::host) return;
  w.joint_packs.assign(at((joints + joint_pack - 1) / joint_pack), JointPack::inner);
  for (const Buffer<Index>* edges : {&w.joints.edge_a, &w.joints.edge_b})
    for (Index i = 0; i < joints; ++i)
      if (!w.domain.owns(edges->data()[i] / 3))
        w.joint_packs[at(i / joint_pack)] = JointPack::outer;
}

}  // namespace breccia::fdem

namespace breccia::fdem_shared {

template fdem::World share_out(fdem::World&, Communicator&, const DomainConfig&, Space);
template fdem::World share_parts(fdem::World, const std::vector<std::uint8_t>&, Communicator&,
                                 const DomainConfig&, Space);
template void migrate(fdem::World&);
template void rebalance(fdem::World&);
template void collect(fdem::World&, fdem::World&);
template void drop_state(fdem::World&);

}  // namespace breccia::fdem_shared
