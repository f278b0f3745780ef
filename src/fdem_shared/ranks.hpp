#pragma once
// A mesh shared out among ranks: owner computes (docs/theory-domain.md).
//
// Each rank's World holds the elements whose centroids it owns and ghosts of all others that these
// may touch, are joined with, or move with as one, in ascending order of their global ids, so that
// every sum keeps its order. Joints and couples with an owned element are evaluated on each rank
// that owns one of theirs, with equal history. Vertices keep their numbers in the whole mesh.
//
// Written in migration.hpp and ghosts.hpp; made for each method in ranks.cpp, stepping/ghosts.cpp.

#include "domain/domain.hpp"

namespace breccia::fdem_shared {

/// Makes a rank's part of a world. Every rank calls it with the world that the case builds, on the
/// host; rank 0's state is shared out, the others' is dropped. Stores mesh-wide data in
/// `whole.mesh`.
/// @param space  of the part
template <class World>
World share_out(World& whole, Communicator& ranks, const DomainConfig& config,
                Space space = Space::host);
/// Shares out where each rank has made its own part, on the host: the elements that `own` marks
/// and ghosts of those across their sides. Ids, vertices and joint_number are those of the whole
/// mesh, and so are the parameters, holds, marks of vertices and bundles. Couples are yet to be
/// found.
template <class World>
World share_parts(World part, const std::vector<std::uint8_t>& own, Communicator& ranks,
                  const DomainConfig& config, Space space);

/// Shares elements out anew, if some have left the buffer since it was done last, with all that
/// they own (Lukas 2014, 3.5); first moves the borders if loads have become uneven (section 4).
/// Only before a search, which finds the couples of new ghosts.
template <class World>
void migrate(World& w);
/// Between two steps: elements are shared out anew if some ranks take longer than others, so that
/// these take less. Pairs go with their elements; the next search comes when it would have come.
template <class World>
void rebalance(World& w);

/// After the elements have moved: active ghosts follow their owners. Meanwhile ranks vote on a
/// search.
template <class World>
void start_ghosts(World& w);
template <class World>
void finish_ghosts(World& w);
/// And now all of them: a search is due.
template <class World>
void refresh_ghosts(World& w);

/// After a search: selects the ghosts that are active until the next one.
template <class World>
void select_active_ghosts(World& w);

/// Brings the state of all ranks together in `whole` on rank 0; it may lack couple lists and sums,
/// which the observers do not read. Every rank calls it.
template <class World>
void collect(World& part, World& whole);

/// Gives up a world's state and keeps what follows from the case.
template <class World>
void drop_state(World& w);

}  // namespace breccia::fdem_shared
