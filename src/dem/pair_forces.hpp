#pragma once
// Actions of interactions on their two ends: written once by each, read by both ends.

#include "core/precision.hpp"
#include "dem/laws/pair_motion.hpp"
#include "exec/buffer.hpp"

namespace breccia::dem {

/// Forces of an interaction on its two ends in this step, and its stiffness: written once by its
/// law, read by both ends. What an end adds up lies side by side: six numbers from 0 for a, from 3
/// for b, and the same eight stiffnesses for both.
///
/// The rotational stiffness of an end is bounded by a matrix that K itself makes up,
/// K^theta <= turn I - ratio K: two numbers instead of six (docs/theory.md, time step).
template <class Number>
struct PairForceOf {
  Number numbers[9];  ///< torque on a  [N m], force on b (a gets the opposite)  [N], torque on b [N
                      ///< m]
  /// turn of a  [N m], K xx yy zz xy xz yz  [N/m], turn of b  [N m], ratio  [m2]; a tenth fills up
  float stiffness[sizeof(Number) == 8 ? 10 : 9];

  BR_HD Vec3 force_on_b() const { return {numbers[3], numbers[4], numbers[5]}; }
};
using PairForce = PairForceOf<double>;
template <class Number>
using ActionsOf = Buffer<PairForceOf<Number>>;
static_assert(sizeof(PairForce) == 112 && sizeof(PairForceOf<float>) == 72);

#if defined(__CUDACC__)
/// On a device: the lanes of a warp, whose items are neighbours, put their actions together and
/// write them as one run of memory. Each on its own would write in steps of 112 or 72 bytes.
/// @param actions  of the items of lane 0 and its neighbours
template <class Number>
__device__ inline void write_together(PairForceOf<Number>* actions,
                                      const PairForceOf<Number>& own) {
  using PairForce = PairForceOf<Number>;
  using Piece = std::conditional_t<sizeof(PairForce) % sizeof(uint4) == 0, uint4, uint2>;
  constexpr unsigned pieces = sizeof(PairForce) / sizeof(Piece);  // of each action
  __shared__ Piece staged[block_size * pieces];
  const unsigned lane = threadIdx.x % 32, active = __activemask();
  Piece* const warp = staged + (threadIdx.x - lane) * pieces;
  *reinterpret_cast<PairForce*>(warp + lane * pieces) = own;
  __syncwarp(active);
  auto* const to = reinterpret_cast<Piece*>(actions);
  const unsigned stride = __popc(active);
  for (unsigned k = __popc(active & ((1U << lane) - 1)); k < 32 * pieces; k += stride)
    if ((active >> (k / pieces) & 1U) != 0) to[k] = warp[k];
  __syncwarp(active);
}
#endif

template <class Number>
BR_HD inline void write_actions(const View<PairForceOf<Number>>& actions, Index at,
                                const double (&numbers)[9], const double (&stiffness)[9]) {
#if defined(__CUDA_ARCH__)
  PairForceOf<Number> action;
#else
  PairForceOf<Number>& action = actions[at];
#endif
  for (int k = 0; k < 9; ++k) action.numbers[k] = static_cast<Number>(numbers[k]);
  for (int k = 0; k < 9; ++k) action.stiffness[k] = static_cast<float>(stiffness[k]);
#if defined(__CUDA_ARCH__)
  if constexpr (sizeof action.stiffness > 9 * sizeof(float)) action.stiffness[9] = 0.0F;
  write_together(actions.data + at - static_cast<Index>(threadIdx.x % 32), action);
#endif
}

template <class Actions>
BR_HD inline void write_actions(const Actions& actions, Index at, const Single (&numbers)[9],
                                const Single (&stiffness)[9]) {
  double wide[9], wide_stiffness[9];
  for (int k = 0; k < 9; ++k) {
    wide[k] = widened(numbers[k]);
    wide_stiffness[k] = widened(stiffness[k]);
  }
  write_actions(actions, at, wide, wide_stiffness);
}
#if !defined(__CUDACC__) && (defined(__AVX512F__) || defined(__AVX2__))
inline void write_actions(const View<PairForceOf<float>>& actions, Index at,
                          const SinglePack (&numbers)[9], const SinglePack (&stiffness)[9]) {
  constexpr int stride = sizeof(PairForceOf<float>) / sizeof(float);
  BR_ASSERT(at >= 0 && at + width_of<SinglePack> <= actions.size);
  write_rows<stride>(numbers, actions.data[at].numbers);
  write_rows<stride>(stiffness, actions.data[at].stiffness);
}
#endif

/// Writes an action alone.
template <class Number>
BR_HD inline void write_action(PairForceOf<Number>& to, const double (&numbers)[9],
                               const double (&stiffness)[9]) {
  PairForceOf<Number> action;
  for (int k = 0; k < 9; ++k) action.numbers[k] = static_cast<Number>(numbers[k]);
  for (int k = 0; k < 9; ++k) action.stiffness[k] = static_cast<float>(stiffness[k]);
  if constexpr (sizeof action.stiffness > 9 * sizeof(float)) action.stiffness[9] = 0.0F;
#if defined(__CUDA_ARCH__)
  using Word = std::conditional_t<sizeof action % sizeof(int4) == 0, int4, int2>;
  Word parts[sizeof action / sizeof(Word)];
  __builtin_memcpy(parts, &action, sizeof action);
  auto* const words = reinterpret_cast<Word*>(&to);
  for (std::size_t k = 0; k < sizeof action / sizeof(Word); ++k) words[k] = parts[k];
#else
  to = action;
#endif
}

/// Actions that lie in a tile's own memory (stepping/tile_memory.hpp), each written by its thread;
/// and the place of the present item among all of its kind.
template <class Number>
struct TileActionsOf {
  PairForceOf<Number>* records;
  Index number;
  bool books;  ///< whether this tile books what the item spends
};
using TileActions = TileActionsOf<double>;
/// Whether items that answer nothing lie together, so that it pays to leave out their law.
template <class Actions>
inline constexpr bool has_idle_together = false;
template <class Number>
inline constexpr bool has_idle_together<TileActionsOf<Number>> = true;
template <class Number>
BR_HD inline void write_actions(const TileActionsOf<Number>& actions, Index at,
                                const double (&numbers)[9], const double (&stiffness)[9]) {
  write_action(actions.records[at], numbers, stiffness);
}

/// Adds to the energy that item i, or each of a pack, has spent so far.
template <class Actions, class R>
BR_HD inline void book(const Actions&, const View<double>& spent, Index i, const R& more) {
  add_to(spent, i, more);
}
/// One thread alone adds to a number, so that an addition without an answer gives the same bits.
template <class Number>
BR_HD inline void book(const TileActionsOf<Number>& actions, const View<double>& spent, Index,
                       double more) {
  if (!actions.books) return;
#if defined(__CUDA_ARCH__)
  atomicAdd(spent.data + actions.number, more);
#else
  spent[actions.number] += more;
#endif
}
template <class Number>
BR_HD inline void book(const TileActionsOf<Number>& actions, const View<double>& spent, Index i,
                       const Single& more) {
  book(actions, spent, i, widened(more));
}

#if !defined(__CUDACC__) && defined(__AVX512F__)
/// Nine numbers of eight actions, by number, as rows in single precision.
struct SingleRows {
  __m256 rows[8];
  alignas(32) float last[8];

  explicit SingleRows(const Pack8 (&numbers)[9]) {
    for (int k = 0; k < 8; ++k) rows[k] = rounded(numbers[k]);
    transpose(rows);
    _mm256_store_ps(last, rounded(numbers[8]));
  }
  void write(int action, float* to) const {
    _mm256_storeu_ps(to, rows[action]);
    to[8] = last[action];
  }
};
/// Writes the action of item k of a pack to place(k).
template <class Place>
inline void write_actions_to(const Place& place, const Pack8 (&numbers)[9],
                             const Pack8 (&stiffness)[9]) {
  Pack8 rows[8];
  for (int k = 0; k < 8; ++k) rows[k] = numbers[k];
  transpose(rows);
  const SingleRows stiff(stiffness);
  alignas(64) double last[8];
  _mm512_store_pd(last, numbers[8]);
  for (int k = 0; k < 8; ++k) {
    PairForce& action = place(k);
    _mm512_storeu_pd(action.numbers, rows[k]);
    action.numbers[8] = last[k];
    stiff.write(k, action.stiffness);
  }
}
inline void write_actions(const View<PairForceOf<float>>& actions, Index at,
                          const Pack8 (&numbers)[9], const Pack8 (&stiffness)[9]) {
  const SingleRows rows(numbers), stiff(stiffness);
  for (int k = 0; k < 8; ++k) {
    rows.write(k, actions.data[at + k].numbers);
    stiff.write(k, actions.data[at + k].stiffness);
  }
}
#elif !defined(__CUDACC__) && defined(__AVX2__)
/// Nine numbers of four actions, by number, as rows in single precision.
struct SingleRows {
  __m128 rows[2][4];
  alignas(16) float last[4];

  explicit SingleRows(const Pack4 (&numbers)[9]) {
    for (int part = 0; part < 2; ++part) {
      for (int k = 0; k < 4; ++k) rows[part][k] = rounded(numbers[4 * part + k]);
      _MM_TRANSPOSE4_PS(rows[part][0], rows[part][1], rows[part][2], rows[part][3]);
    }
    _mm_store_ps(last, rounded(numbers[8]));
  }
  void write(int action, float* to) const {
    _mm_storeu_ps(to, rows[0][action]);
    _mm_storeu_ps(to + 4, rows[1][action]);
    to[8] = last[action];
  }
};
/// Writes the action of item k of a pack to place(k).
template <class Place>
inline void write_actions_to(const Place& place, const Pack4 (&numbers)[9],
                             const Pack4 (&stiffness)[9]) {
  Pack4 rows[2][4];
  for (int part = 0; part < 2; ++part) {
    for (int k = 0; k < 4; ++k) rows[part][k] = numbers[4 * part + k];
    transpose(rows[part]);
  }
  const SingleRows stiff(stiffness);
  alignas(32) double last[4];
  _mm256_store_pd(last, numbers[8]);
  for (int k = 0; k < 4; ++k) {
    PairForce& action = place(k);
    _mm256_storeu_pd(action.numbers, rows[0][k]);
    _mm256_storeu_pd(action.numbers + 4, rows[1][k]);
    action.numbers[8] = last[k];
    stiff.write(k, action.stiffness);
  }
}
inline void write_actions(const View<PairForceOf<float>>& actions, Index at,
                          const Pack4 (&numbers)[9], const Pack4 (&stiffness)[9]) {
  const SingleRows rows(numbers), stiff(stiffness);
  for (int k = 0; k < 4; ++k) {
    rows.write(k, actions.data[at + k].numbers);
    stiff.write(k, actions.data[at + k].stiffness);
  }
}
#endif
#if !defined(__CUDACC__) && (defined(__AVX512F__) || defined(__AVX2__))
template <class R>
requires(width_of<R> > 1) inline void write_actions(const View<PairForce>& actions, Index at,
                                                    const R (&numbers)[9],
                                                    const R (&stiffness)[9]) {
  write_actions_to([&](Index k) -> PairForce& { return actions.data[at + k]; }, numbers, stiffness);
}
#endif

/// Books force f and moment M on b of interaction `at`, and of its neighbours in a pack, with
/// tangent stiffnesses (Durand 2012, 4.4; docs/theory.md, time step).
template <class R, class Actions>
BR_HD void write_pair_force(const Actions& actions, Index at, const PairMotion<R>& motion,
                            const Vec3Of<R>& f, const Vec3Of<R>& moment, const R& normal,
                            const R& shear, const R& bending, const R& twist) {
  const Vec3Of<R> lever = cross(motion.normal, f);
  const Vec3Of<R> torque_a = -(motion.arm_a * lever) - moment;
  const Vec3Of<R> torque_b = moment - motion.arm_b * lever;
  const R numbers[9] = {torque_a.x, torque_a.y, torque_a.z, f.x,       f.y,
                        f.z,        torque_b.x, torque_b.y, torque_b.z};

  // K = shear I + stretch n n^T, K^theta = across I - (across - twist) n n^T, with the larger arm's
  // `across` for an end that has it: the ratio of the two matrices is the smaller end's.
  const Vec3Of<R>& n = motion.normal;
  const R stretch = normal - shear, none = constant<R>(0.0);
  const R across_a = shear * motion.arm_a * motion.arm_a + bending;
  const R across_b = shear * motion.arm_b * motion.arm_b + bending;
  const R softer = min(across_a, across_b) - twist;
  const auto alike = stretch > 0.01 * normal && softer > none;
  const R ratio = select(alike, softer / select(alike, stretch, constant<R>(1.0)), none);
  const Vec3Of<R> along = stretch * n;
  const R stiffness[9] = {max(across_a, twist) + ratio * shear,
                          shear + along.x * n.x,
                          shear + along.y * n.y,
                          shear + along.z * n.z,
                          along.x * n.y,
                          along.x * n.z,
                          along.y * n.z,
                          max(across_b, twist) + ratio * shear,
                          ratio};
  write_actions(actions, at, numbers, stiffness);
}

}  // namespace breccia::dem
