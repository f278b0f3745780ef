#pragma once
// Parts of a step that ranks take alike, whatever the method: ghosts follow their owners, elements
// are shared out anew. Worlds name `domain`, `exec` and `time` alike.

#include "domain/sharing.hpp"
#include "exec/timers.hpp"

namespace breccia {

/// After elements have moved: active ghosts follow their owners, while the rank does other work.
/// @param moving  positions and velocities of the world's elements
template <class World, class Item>
void start_ghosts(World& w, Buffer<Item>& moving) {
  if (w.domain.single_rank()) return;
  const StageTime timed(w.exec, "halo");
  w.domain.start_refresh(w.exec, moving);
}
template <class World, class Item>
void finish_ghosts(World& w, Buffer<Item>& moving) {
  if (w.domain.single_rank()) return;
  const StageTime timed(w.exec, "halo");
  w.domain.finish_refresh(w.exec, moving);
}
/// And now all of them: a search is due.
template <class World, class Item>
void refresh_ghosts(World& w, Buffer<Item>& moving) {
  if (w.domain.single_rank()) return;
  const StageTime timed(w.exec, "halo");
  w.domain.refresh_all(w.exec, moving);
}

/// Shares elements out anew where some have left their buffer. Only before a search.
template <class World>
void migrate(World& w, Shareable& elements) {
  const StageTime timed(w.exec, "migration");
  share_if_needed(w.domain, elements);
}
/// Shares elements out anew between two searches.
/// @param drift  of the world's travel  [m/s]
template <class World>
void rebalance(World& w, const Vec3& drift, Shareable& elements) {
  const StageTime timed(w.exec, "migration");
  // Otherwise the way since the last search would be taken off what comes next.
  w.domain.drift(drift, w.time);
  elements.come_to_host();
  share_anew(w.domain, elements, false);
}

/// Besides the owner, the ranks whose elements may touch one get a copy.
/// @param around  each element, where it counts as being
inline void add_ghosts(const Domain& domain, const std::vector<Sphere>& around,
                       const SharedItems& items, SendLists& elements) {
  for (std::size_t e = 0; e < around.size(); ++e) {
    const auto element = static_cast<Index>(e);
    if (domain.owns(element))
      domain.each_sharer(around[e], [&](int r) {
        if (r != items.owner_of(element)) elements.add(r, element);
      });
  }
}

}  // namespace breccia
