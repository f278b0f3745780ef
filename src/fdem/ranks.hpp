#pragma once
// A mesh shared out among ranks: owner computes (docs/theory-domain.md).
//
// Each rank's World holds the triangles whose centroids it owns and ghosts of all others that these
// may touch, are joined with, or move with as one, in ascending order of their global ids, so that
// every sum keeps its order. Joints and couples with an owned triangle are evaluated on each rank
// that owns one of theirs, with equal history. Vertices keep their numbers in the whole mesh.

#include "fdem/world.hpp"

namespace breccia::fdem {

/// Makes a rank's part of a world. Every rank calls it with the world that the case builds, on the
/// host; rank 0's state is shared out, the others' is dropped. Stores mesh-wide data in
/// `whole.mesh`.
/// @param space  of the part
World share_out(World& whole, Communicator& ranks, const DomainConfig& config,
                Space space = Space::host);
/// Shares out where each rank has made its own part, on the host: the triangles that `own` marks
/// and ghosts of those across their edges. Ids, vertices and joint_number are those of the whole
/// mesh, and so are the parameters, holds, marks of vertices and bundles. Couples are yet to be
/// found.
World share_parts(World part, const std::vector<std::uint8_t>& own, Communicator& ranks,
                  const DomainConfig& config, Space space);

/// Shares triangles out anew, if some have left the buffer since it was done last, with all that
/// they own (Lukas 2014, 3.5); first moves the borders if loads have become uneven (section 4).
/// Only before a search, which finds the couples of new ghosts.
void migrate(World& w);
/// Between two steps: elements are shared out anew if some ranks take longer than others, so that
/// these take less. Pairs go with their elements; the next search comes when it would have come.
void rebalance(World& w);

/// After the triangles have moved: active ghosts follow their owners.
/// Meanwhile ranks vote on a search.
void start_ghosts(World& w);
void finish_ghosts(World& w);
/// And now all of them: a search is due.
void refresh_ghosts(World& w);

/// After a search: selects the ghosts that are active until the next one.
void select_active_ghosts(World& w);

/// Brings the state of all ranks together in `whole` on rank 0; it may lack couple lists and sums,
/// which the observers do not read. Every rank calls it.
void collect(World& part, World& whole);

/// Where a triangle counts as being.  [m]
Vec3 centroid(const TriangleNodes& nodes);

/// Gives up a world's state and keeps what follows from the case.
void drop_state(World& w);

}  // namespace breccia::fdem
