#pragma once
// The move of elements by packs, which tells whether one has used its margin up.

#include "exec/types.hpp"
#include "exec/whole_packs.hpp"

namespace breccia::fdem_shared {

/// A move that notes whether an element has used its margin up.
template <class Move>
struct NotingMove {
  const Move& move;
  bool& beyond;
  void operator()(Index t) const { beyond = move(t) || beyond; }
};
template <class Move>
NotingMove(const Move&, bool&) -> NotingMove<Move>;  // clang 14 asks for it

template <class Packs>
struct NotingPacks {
  template <class Move>
  static Index run(const NotingMove<Move>& noting, Index begin, Index end) {
    const auto moved = Packs::run(noting.move, begin, end);
    noting.beyond = noting.beyond || moved.beyond;
    return moved.end;
  }
};

/// Moves elements by packs. @returns whether one has used its margin up
template <class Eight, class Four, class Move>
bool move_packs(Lanes lanes, const Move& kernel, Index begin, Index end) {
  bool beyond = false;
  run_whole_packs<NotingPacks<Eight>, NotingPacks<Four>>(lanes, NotingMove{kernel, beyond}, begin,
                                                         end);
  return beyond;
}

}  // namespace breccia::fdem_shared
