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
/// Room of a block where its threads put their actions together.
__device__ inline std::byte* staging() {
  __shared__ uint4 room[block_size * sizeof(PairForce) / sizeof(uint4)];
  return reinterpret_cast<std::byte*>(room);
}
/// On a device: the lanes of a warp, whose items are neighbours, put their rows together and write
/// them as one run of memory. Each on its own would write in steps of a row.
/// @tparam Piece  what is written at a time; its lanes' rows begin at a multiple of it
/// @param rows  of the items of lane 0 and its neighbours
template <class Piece, class Row>
__device__ inline void write_together(Row* rows, const Row& own) {
  constexpr unsigned pieces = sizeof(Row) / sizeof(Piece);
  static_assert(sizeof(Row) % sizeof(Piece) == 0 && sizeof(Row) <= sizeof(PairForce));
  const unsigned lane = threadIdx.x % 32, active = __activemask();
  auto* const warp = reinterpret_cast<Piece*>(staging() + (threadIdx.x - lane) * sizeof(PairForce));
  *reinterpret_cast<Row*>(warp + lane * pieces) = own;
  __syncwarp(active);
  auto* const to = reinterpret_cast<Piece*>(rows);
  const unsigned stride = __popc(active);
  for (unsigned k = __popc(active & ((1U << lane) - 1)); k < 32 * pieces; k += stride)
    if ((active >> (k / pieces) & 1U) != 0) to[k] = warp[k];
  __syncwarp(active);
}
/// Divides what SplitActions keep of an action.
template <class Number>
using SplitPiece = std::conditional_t<sizeof(Number) == 8, int2, int>;
#endif

/// Actions of links in a device's launches: what each step adds up, and stiffnesses, which only
/// steps that evaluate ask for, apart from each other.
template <class Number>
struct SplitActions {
  struct Numbers {
    Number of[9];
  };
  struct Stiffness {
    float of[sizeof(PairForceOf<Number>::stiffness) / sizeof(float)];
  };
  Numbers* numbers;
  Stiffness* stiffness;
  Index size;

  /// In the memory of whole actions.
  explicit SplitActions(const View<PairForceOf<Number>>& actions)
      : numbers(reinterpret_cast<Numbers*>(actions.data)),
        stiffness(reinterpret_cast<Stiffness*>(numbers + actions.size)),
        size(actions.size) {}
};

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
  using Piece = std::conditional_t<sizeof action % sizeof(int4) == 0, int4, int2>;
  write_together<Piece>(actions.data + at - static_cast<Index>(threadIdx.x % 32), action);
#endif
}

/// Numbers of an action alone, in a step that does not evaluate: its stiffness stays as it is.
template <class Number>
BR_HD inline void write_numbers(const View<PairForceOf<Number>>& actions, Index at,
                                const double (&numbers)[9]) {
  for (int k = 0; k < 9; ++k) actions[at].numbers[k] = static_cast<Number>(numbers[k]);
}

template <class Number>
BR_HD inline void write_numbers(const SplitActions<Number>& actions, Index at,
                                const double (&numbers)[9]) {
  typename SplitActions<Number>::Numbers own;
  for (int k = 0; k < 9; ++k) own.of[k] = static_cast<Number>(numbers[k]);
#if defined(__CUDA_ARCH__)
  write_together<SplitPiece<Number>>(actions.numbers + at - static_cast<Index>(threadIdx.x % 32),
                                     own);
#else
  actions.numbers[at] = own;
#endif
}
template <class Number>
BR_HD inline void write_actions(const SplitActions<Number>& actions, Index at,
                                const double (&numbers)[9], const double (&stiffness)[9]) {
  write_numbers(actions, at, numbers);
  typename SplitActions<Number>::Stiffness own{};
  for (int k = 0; k < 9; ++k) own.of[k] = static_cast<float>(stiffness[k]);
#if defined(__CUDA_ARCH__)
  write_together<SplitPiece<Number>>(actions.stiffness + at - static_cast<Index>(threadIdx.x % 32),
                                     own);
#else
  actions.stiffness[at] = own;
#endif
}

BR_HD inline void widen(const Single (&numbers)[9], double (&wide)[9]) {
  for (int k = 0; k < 9; ++k) wide[k] = widened(numbers[k]);
}
template <class Actions>
BR_HD inline void write_actions(const Actions& actions, Index at, const Single (&numbers)[9],
                                const Single (&stiffness)[9]) {
  double wide[9], wide_stiffness[9];
  widen(numbers, wide);
  widen(stiffness, wide_stiffness);
  write_actions(actions, at, wide, wide_stiffness);
}
template <class Actions>
BR_HD inline void write_numbers(const Actions& actions, Index at, const Single (&numbers)[9]) {
  double wide[9];
  widen(numbers, wide);
  write_numbers(actions, at, wide);
}
#if !defined(__CUDACC__) && (defined(__AVX512F__) || defined(__AVX2__))
inline void write_actions(const View<PairForceOf<float>>& actions, Index at,
                          const SinglePack (&numbers)[9], const SinglePack (&stiffness)[9]) {
  constexpr int stride = sizeof(PairForceOf<float>) / sizeof(float);
  BR_ASSERT(at >= 0 && at + width_of<SinglePack> <= actions.size);
  write_rows<stride>(numbers, actions.data[at].numbers);
  write_rows<stride>(stiffness, actions.data[at].stiffness);
}
inline void write_numbers(const View<PairForceOf<float>>& actions, Index at,
                          const SinglePack (&numbers)[9]) {
  BR_ASSERT(at >= 0 && at + width_of<SinglePack> <= actions.size);
  write_rows<sizeof(PairForceOf<float>) / sizeof(float)>(numbers, actions.data[at].numbers);
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
template <class Number>
BR_HD inline void write_numbers(const TileActionsOf<Number>& actions, Index at,
                                const double (&numbers)[9]) {
  Number* const to = actions.records[at].numbers;
#if defined(__CUDA_ARCH__)
  if constexpr (sizeof(Number) == 8) {  // two at a time
    auto* const twos = reinterpret_cast<double2*>(to);
    for (int k = 0; k < 4; ++k) twos[k] = make_double2(numbers[2 * k], numbers[2 * k + 1]);
    to[8] = numbers[8];
  } else
#endif
    for (int k = 0; k < 9; ++k) to[k] = static_cast<Number>(numbers[k]);
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
/// Writes the numbers of item k of a pack to place(k).
template <class Place>
inline void write_numbers_to(const Place& place, const Pack8 (&numbers)[9]) {
  Pack8 rows[8];
  for (int k = 0; k < 8; ++k) rows[k] = numbers[k];
  transpose(rows);
  alignas(64) double last[8];
  _mm512_store_pd(last, numbers[8]);
  for (int k = 0; k < 8; ++k) {
    PairForce& action = place(k);
    _mm512_storeu_pd(action.numbers, rows[k]);
    action.numbers[8] = last[k];
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
/// Writes the numbers of item k of a pack to place(k).
template <class Place>
inline void write_numbers_to(const Place& place, const Pack4 (&numbers)[9]) {
  Pack4 rows[2][4];
  for (int part = 0; part < 2; ++part) {
    for (int k = 0; k < 4; ++k) rows[part][k] = numbers[4 * part + k];
    transpose(rows[part]);
  }
  alignas(32) double last[4];
  _mm256_store_pd(last, numbers[8]);
  for (int k = 0; k < 4; ++k) {
    PairForce& action = place(k);
    _mm256_storeu_pd(action.numbers, rows[0][k]);
    _mm256_storeu_pd(action.numbers + 4, rows[1][k]);
    action.numbers[8] = last[k];
  }
}
#endif
#if !defined(__CUDACC__) && (defined(__AVX512F__) || defined(__AVX2__))
/// Writes the action of item k of a pack to place(k).
template <class Place>
inline void write_actions_to(const Place& place, const WidestPack (&numbers)[9],
                             const WidestPack (&stiffness)[9]) {
  write_numbers_to(place, numbers);
  const SingleRows stiff(stiffness);
  for (int k = 0; k < width_of<WidestPack>; ++k) stiff.write(k, place(k).stiffness);
}
inline void write_numbers(const View<PairForceOf<float>>& actions, Index at,
                          const WidestPack (&numbers)[9]) {
  const SingleRows rows(numbers);
  for (int k = 0; k < width_of<WidestPack>; ++k) rows.write(k, actions.data[at + k].numbers);
}
inline void write_actions(const View<PairForceOf<float>>& actions, Index at,
                          const WidestPack (&numbers)[9], const WidestPack (&stiffness)[9]) {
  write_numbers(actions, at, numbers);
  const SingleRows stiff(stiffness);
  for (int k = 0; k < width_of<WidestPack>; ++k) stiff.write(k, actions.data[at + k].stiffness);
}
inline void write_numbers(const View<PairForce>& actions, Index at,
                          const WidestPack (&numbers)[9]) {
  write_numbers_to([&](Index k) -> PairForce& { return actions.data[at + k]; }, numbers);
}
inline void write_actions(const View<PairForce>& actions, Index at, const WidestPack (&numbers)[9],
                          const WidestPack (&stiffness)[9]) {
  write_actions_to([&](Index k) -> PairForce& { return actions.data[at + k]; }, numbers, stiffness);
}
#endif

/// Numbers of the action of force f and moment M on b.
template <class R>
BR_HD void find_numbers(R (&numbers)[9], const PairMotion<R>& motion, const Vec3Of<R>& f,
                        const Vec3Of<R>& moment) {
  const Vec3Of<R> lever = cross(motion.normal, f);
  const Vec3Of<R> on_a = -(motion.arm_a * lever) - moment;
  const Vec3Of<R> on_b = moment - motion.arm_b * lever;
  const R all[9] = {on_a.x, on_a.y, on_a.z, f.x, f.y, f.z, on_b.x, on_b.y, on_b.z};
  for (int k = 0; k < 9; ++k) numbers[k] = all[k];
}

/// Books force f and moment M on b of interaction `at`, and of its neighbours in a pack, in a step
/// that does not evaluate.
template <class R, class Actions>
BR_HD void write_push(const Actions& actions, Index at, const PairMotion<R>& motion,
                      const Vec3Of<R>& f, const Vec3Of<R>& moment) {
  R numbers[9];
  find_numbers(numbers, motion, f, moment);
  write_numbers(actions, at, numbers);
}

/// Books them with tangent stiffnesses, in one that does (Durand 2012, 4.4; docs/theory.md, time
/// step).
template <class R, class Actions>
BR_HD void write_pair_force(const Actions& actions, Index at, const PairMotion<R>& motion,
                            const Vec3Of<R>& f, const Vec3Of<R>& moment, const R& normal,
                            const R& shear, const R& bending, const R& twist) {
  R numbers[9];
  find_numbers(numbers, motion, f, moment);

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
