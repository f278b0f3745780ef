#pragma once
// A mesh of tetrahedra shared out among ranks, as fdem/ranks.hpp shares one of triangles.

#include "fdem3/world.hpp"

namespace breccia::fdem3 {

/// Makes a rank's part of a world. Every rank calls it with the world that the case builds, on the
/// host; rank 0's state is shared out, the others' is dropped.
/// @param space  of the part
World share_out(World& whole, Communicator& ranks, const DomainConfig& config,
                Space space = Space::host);

/// Shares tetrahedra out anew, if some have left the buffer since it was done last, with all that
/// they own (Lukas 2014, 3.5). Only before a search, which finds the couples of new ghosts.
void migrate(World& w);
/// Between two steps: elements are shared out anew if some ranks take longer than others.
void rebalance(World& w);

/// After the tetrahedra have moved: active ghosts follow their owners.
void start_ghosts(World& w);
void finish_ghosts(World& w);
/// And now all of them: a search is due.
void refresh_ghosts(World& w);
/// After a search: selects the ghosts that are active until the next one.
void select_active_ghosts(World& w);

/// Gives up a world's state and keeps what follows from the case.
void drop_state(World& w);

/// Brings the state of all ranks together in `whole` on rank 0.
void collect(World& part, World& whole);

}  // namespace breccia::fdem3
