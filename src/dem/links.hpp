#pragma once
// What joins elements from the start: the arrays of each kind of link, and what interactions do to
// their ends.

#include "core/fields.hpp"
#include "dem/laws/concrete_link.hpp"
#include "dem/laws/interface_link.hpp"
#include "dem/laws/steel_link.hpp"

namespace breccia::dem {

/// Cohesive links. Never removed: a broken one answers as the contact that is left of it.
struct ConcreteLinks {
  Buffer<Index> a, b;        ///< the ends, a's global id below b's
  Buffer<double> length;     ///< D_eq  [m]
  Buffer<double> stiffness;  ///< K_n  [N/m]
  Buffer<double> opening;    ///< largest so far, or link_broken, link_released  [m]
  Vec3Planes shear;          ///< F_s on b  [N]
  Vec3Planes moment;         ///< M on b  [N m]
  Buffer<double> slid;       ///< energy spent on sliding so far  [J]
  Buffer<double> yielded;    ///< energy spent on plastic moments so far  [J]
  Buffer<double> broke;      ///< energy that its rupture spent  [J]

  template <class Visit>
  void each_field(Visit&& field) {
    field("a", "-", a);
    field("b", "-", b);
    field("length", "m", length);
    field("stiffness", "N/m", stiffness);
    field("opening", "m", opening);
    field("shear", "N", shear);
    field("moment", "N m", moment);
    field("slid", "J", slid);
    field("yielded", "J", yielded);
    field("broke", "J", broke);
  }
  Index size() const { return a.size(); }
};

/// Pieces of bar.
struct SteelLinks {
  Buffer<Index> a, b;
  Buffer<double> length;  ///< L_s  [m]
  Buffer<SteelState> state;
  Buffer<double> yielded;  ///< energy spent on yielding so far  [J]
  Buffer<double> broke;    ///< energy that its rupture spent  [J]

  template <class Visit>
  void each_field(Visit&& field) {
    field("a", "-", a);
    field("b", "-", b);
    field("length", "m", length);
    field("state", "-", state);
    field("yielded", "J", yielded);
    field("broke", "J", broke);
  }
  Index size() const { return a.size(); }
};

/// Bonds between bars and concrete: a is the bar's element, b the concrete's.
struct InterfaceLinks {
  Buffer<Index> a, b;
  Buffer<Index> before,
      after;  ///< neighbours of a along its bar (a itself at an end): they give the axis
  Buffer<double> stiffness;  ///< K_tr  [N/m]
  Buffer<double> area;       ///< S, share of the bar's surface  [m2]
  Buffer<InterfaceState> state;
  Buffer<double> slid;   ///< energy spent on bond slip and friction so far  [J]
  Buffer<double> broke;  ///< energy that its rupture spent  [J]

  template <class Visit>
  void each_field(Visit&& field) {
    field("a", "-", a);
    field("b", "-", b);
    field("before", "-", before);
    field("after", "-", after);
    field("stiffness", "N/m", stiffness);
    field("area", "m2", area);
    field("state", "-", state);
    field("slid", "J", slid);
    field("broke", "J", broke);
  }
  Index size() const { return a.size(); }
};

/// What an interaction does to its two ends in this step, and how stiff it is: written once by its
/// law, read by both ends. What an end adds up lies side by side: six numbers from 0 for a, from 3
/// for b.
struct Action {
  double numbers[9];  ///< torque on a  [N m], force on b (a gets the opposite)  [N], torque on b [N
                      ///< m]
  float stiffness[9];  ///< K^theta of a  [N m], K  [N/m], K^theta of b  [N m], each xx yy zz
  float unused;

  BR_HD Vec3 force_on_b() const { return {numbers[3], numbers[4], numbers[5]}; }
};
static_assert(sizeof(Action) == 112);

#if defined(__CUDACC__)
/// On a device: the lanes of a warp, whose items are neighbours, put their actions together and
/// write them as one run of memory. Each on its own would write in steps of 112 bytes.
/// @param actions  of the items of lane 0 and its neighbours
__device__ inline void write_together(Action* actions, const Action& own) {
  constexpr unsigned pieces = sizeof(Action) / sizeof(uint4);  // of each action
  __shared__ uint4 staged[block_size * pieces];
  const unsigned lane = threadIdx.x % 32, active = __activemask();
  uint4* const warp = staged + (threadIdx.x - lane) * pieces;
  *reinterpret_cast<Action*>(warp + lane * pieces) = own;
  __syncwarp(active);
  auto* const to = reinterpret_cast<uint4*>(actions);
  const unsigned stride = __popc(active);
  for (unsigned k = __popc(active & ((1U << lane) - 1)); k < 32 * pieces; k += stride)
    if ((active >> (k / pieces) & 1U) != 0) to[k] = warp[k];
  __syncwarp(active);
}
#endif

BR_HD inline void write_actions(const View<Action>& actions, Index at, const double (&numbers)[9],
                                const double (&stiffness)[9]) {
#if defined(__CUDA_ARCH__)
  Action action;
#else
  Action& action = actions[at];
#endif
  for (int k = 0; k < 9; ++k) action.numbers[k] = numbers[k];
  for (int k = 0; k < 9; ++k) action.stiffness[k] = static_cast<float>(stiffness[k]);
#if defined(__CUDA_ARCH__)
  action.unused = 0.0F;
  write_together(actions.data + at - static_cast<Index>(threadIdx.x % 32), action);
#endif
}

#if !defined(__CUDACC__) && defined(__AVX512F__)
inline void write_actions(const View<Action>& actions, Index at, const Pack8 (&numbers)[9],
                          const Pack8 (&stiffness)[9]) {
  Pack8 rows[8];
  for (int k = 0; k < 8; ++k) rows[k] = numbers[k];
  transpose(rows);
  __m256 halves[8];
  for (int k = 0; k < 8; ++k) halves[k] = rounded(stiffness[k]);
  transpose(halves);
  alignas(64) double last_number[8];
  alignas(32) float last_stiffness[8];
  _mm512_store_pd(last_number, numbers[8]);
  _mm256_store_ps(last_stiffness, rounded(stiffness[8]));
  for (int k = 0; k < 8; ++k) {
    Action& action = actions.data[at + k];
    _mm512_storeu_pd(action.numbers, rows[k]);
    action.numbers[8] = last_number[k];
    _mm256_storeu_ps(action.stiffness, halves[k]);
    action.stiffness[8] = last_stiffness[k];
  }
}
#elif !defined(__CUDACC__) && defined(__AVX2__)
inline void write_actions(const View<Action>& actions, Index at, const Pack4 (&numbers)[9],
                          const Pack4 (&stiffness)[9]) {
  Pack4 rows[2][4];
  __m128 floats[2][4];
  for (int part = 0; part < 2; ++part) {
    for (int k = 0; k < 4; ++k) {
      rows[part][k] = numbers[4 * part + k];
      floats[part][k] = rounded(stiffness[4 * part + k]);
    }
    transpose(rows[part]);
    _MM_TRANSPOSE4_PS(floats[part][0], floats[part][1], floats[part][2], floats[part][3]);
  }
  alignas(32) double last_number[4];
  alignas(16) float last_stiffness[4];
  _mm256_store_pd(last_number, numbers[8]);
  _mm_store_ps(last_stiffness, rounded(stiffness[8]));
  for (int k = 0; k < 4; ++k) {
    Action& action = actions.data[at + k];
    _mm256_storeu_pd(action.numbers, rows[0][k]);
    _mm256_storeu_pd(action.numbers + 4, rows[1][k]);
    action.numbers[8] = last_number[k];
    _mm_storeu_ps(action.stiffness, floats[0][k]);
    _mm_storeu_ps(action.stiffness + 4, floats[1][k]);
    action.stiffness[8] = last_stiffness[k];
  }
}
#endif

/// Books force f and moment M on b of interaction `at`, and of its neighbours in a pack, with
/// tangent stiffnesses (Durand 2012, 4.4; docs/theory.md, time step).
template <class R>
BR_HD void book(const View<Action>& actions, Index at, const PairMotion<R>& motion,
                const Vec3Of<R>& f, const Vec3Of<R>& moment, const R& normal, const R& shear,
                const R& bending, const R& twist) {
  const Vec3Of<R> lever = cross(motion.normal, f);
  const Vec3Of<R> torque_a = -(motion.arm_a * lever) - moment;
  const Vec3Of<R> torque_b = moment - motion.arm_b * lever;
  const R numbers[9] = {torque_a.x, torque_a.y, torque_a.z, f.x,       f.y,
                        f.z,        torque_b.x, torque_b.y, torque_b.z};

  const Vec3Of<R>& n = motion.normal;
  const R q[3] = {n.x * n.x, n.y * n.y, n.z * n.z};
  const R stretch = normal - shear, screw = twist - bending;
  const R a = shear * motion.arm_a * motion.arm_a, b = shear * motion.arm_b * motion.arm_b;
  R stiffness[9];
  for (int c = 0; c < 3; ++c) {
    stiffness[c] = a + bending + (screw - a) * q[c];
    stiffness[3 + c] = shear + stretch * q[c];
    stiffness[6 + c] = b + bending + (screw - b) * q[c];
  }
  write_actions(actions, at, numbers, stiffness);
}

}  // namespace breccia::dem
