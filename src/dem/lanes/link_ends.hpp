#pragma once
// How kernels read the ends of a link, or of each link in a pack.

#include "dem/elements.hpp"
#include "dem/laws/pair_motion.hpp"
#include "exec/buffer.hpp"
#include "math/lanes.hpp"
#include "math/records.hpp"

namespace breccia::dem {

/// One end of a link, or of each in a pack.
template <class R>
struct LinkEnd {
  PairEnd<R> motion;
  R radius;
};
template <class R>
BR_HD inline LinkEnd<R> load_end(const View<const ElementState>& state, const Indices<R>& i) {
  if constexpr (width_of<R> == 1) {
    const ElementState s = read_record_now(&state[i.at]);
    return {{s.position, s.velocity, s.spin}, s.radius};
  } else {
    R c[10];
    gather_records(state, i, c);
    return {{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}, {c[6], c[7], c[8]}}, c[9]};
  }
}

/// Both ends of a link, or of each in a pack.
template <class R>
struct LinkPair {
  PairEnds<R> motion;
  R radius_a, radius_b;

  BR_HD R touching() const { return radius_a + radius_b; }
  BR_HD R difference() const { return radius_a - radius_b; }
};
template <class R>
BR_HD inline LinkPair<R> link_pair(const LinkEnd<R>& a, const LinkEnd<R>& b) {
  return {ends_of(a.motion, b.motion), a.radius, b.radius};
}
/// Places and velocities of a pack are subtracted as they lie in memory: the differences alone are
/// then put in columns.
template <class R>
BR_HD inline LinkPair<R> load_pair(const View<const ElementState>& state, const Indices<R>& a,
                                   const Indices<R>& b) {
  if constexpr (width_of<R> == 1) {
    return link_pair(load_end<R>(state, a), load_end<R>(state, b));
  } else {
    R apart[6], of_a[4], of_b[4];
    gather_differences(state, a, b, apart);
    const auto turning = numbers_from<6>(state);
    gather_records(turning, a, of_a);
    gather_records(turning, b, of_b);
    return {{{apart[0], apart[1], apart[2]},
             {apart[3], apart[4], apart[5]},
             {of_a[0], of_a[1], of_a[2]},
             {of_b[0], of_b[1], of_b[2]}},
            of_a[3],
            of_b[3]};
  }
}

}  // namespace breccia::dem
