#pragma once
// The common motion of elements that ranks share.

#include "core/drift.hpp"
#include "domain/domain.hpp"
#include "domain/together.hpp"

namespace breccia {

/// Common motion of the elements of all ranks. @param own  that of this rank
inline CommonMotion of_all_ranks(const Domain& domain, const CommonMotion& own) {
  if (domain.single_rank()) return own;
  CommonMotion all;
  for (const CommonMotion& of_rank : from_each(*domain.ranks, own)) all = all + of_rank;
  return all;
}

/// The partition as it lies at a time: it moves with the elements.
/// @param velocity  of their drift since the time up to which the domain counts it  [m/s]
inline Partition partition_at(const Domain& domain, const Vec3& velocity, double time) {
  Partition partition = domain.partition;
  if (domain.single_rank()) return partition;
  partition.move(domain.drifted + (time - domain.drifted_until) * velocity);
  return partition;
}

}  // namespace breccia
