#include "fdem/ranks.hpp"

#include "fdem/fluid/cavity.hpp"
#include "fdem/relations.hpp"
#include "fdem_shared/migration.hpp"

namespace breccia::fdem {

namespace {

/// The items of an array that all ranks have with one length, as rank 0 has them.
template <class Item>
void take_items(Communicator& ranks, Buffer<Item>& items) {
  Message message;
  put_bytes(message, reinterpret_cast<const std::uint8_t*>(items.data()),
            at(items.size()) * sizeof(Item));
  message = ranks.from_first(std::move(message));
  __builtin_memcpy(items.data(), message.data(), message.size());
}

}  // namespace

void Shape::take_common(World& w, Communicator& ranks) {
  take_from_first(ranks, w.fluid.time);
  if (!w.given->bolts.empty()) {
    take_from_first(ranks, w.bolts.time);
    take_items(ranks, w.bolts.nodes);
  }
  if (has_gas(w)) take_items(ranks, w.fluid.gas);
  if (!w.given->flow.on) return;
  take_from_first(ranks, w.fluid.injected);
  take_from_first(ranks, w.fluid.released);
  take_from_first(ranks, w.fluid.pressure);
  BR_ASSERT(w.fluid.volume.size() > 0);
  take_items(ranks, w.fluid.volume);
}

void Shape::derive_part(World& w, Space space) {
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
  list_loaded_edges(w);
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
