#pragma once
// A world shared out among ranks: owner computes (docs/theory-domain.md).
//
// Each rank's World holds the elements that it owns and ghosts of all others that these may touch
// or are linked with, in ascending order of their global ids, so that every sum keeps its order.
// Links and contacts with an owned end are evaluated on each rank that owns one of their elements,
// with equal history; each rank sums for its own elements.

#include "dem/world.hpp"

namespace breccia::dem {

/// Makes a rank's part of a world. Every rank calls it with the world that the case builds, on the
/// host; rank 0's state is shared out, the others' is dropped.
/// @param space  of the part
World share_out(const World& whole, Communicator& ranks, const DomainConfig& config,
                Space space = Space::host);
/// Shares out where each rank has made its own part, on the host, and no two parts touch: ids
/// and the numbers of links are those of the whole, and so are the parameters and the numbers at
/// which groups of links begin and end.
World share_parts(World part, Communicator& ranks, const DomainConfig& config, Space space);

/// Shares elements out anew, if some have left the buffer since it was done last, with all that
/// they own: links, contacts and their history (Lukas 2014, 3.5); first moves the borders if loads
/// have become uneven (section 4). Only before a search, which finds the contacts of new ghosts.
void migrate(World& w);
/// Between two steps: elements are shared out anew if some ranks take longer than others, so that
/// these take less. Pairs go with their elements; the next search comes when it would have come.
void rebalance(World& w);

/// After the elements have moved: active ghosts follow their owners.
/// Meanwhile ranks vote on a search.
void start_ghosts(World& w);
void finish_ghosts(World& w);
/// And now all of them: a search is due.
void refresh_ghosts(World& w);

/// After a search: selects the ghosts that are active until the next one.
void select_active_ghosts(World& w);

/// Brings the state of all ranks together in `whole` on rank 0; it may lack contact lists and sums,
/// which the observers do not read. Every rank calls it.
void collect(World& part, World& whole);

/// Gives up a world's state and keeps what follows from the case.
void drop_state(World& w);

}  // namespace breccia::dem
