// Built once for each width of vector; BR_PACKS names the build (see CMakeLists.txt).
#if !defined(__OPTIMIZE__)
#error "needs -O1 or more: functions left as calls would be shared by builds of different widths"
#endif

#include "fdem/stepping/kernel_lanes.hpp"

#include "fdem/contact/couple_lanes.hpp"

namespace breccia::fdem {
namespace {

constexpr Index width = width_of<WidestPack>;

/// Packs that a kernel takes: of the numbers that it computes in.
template <class Kernel>
using PackOf = std::conditional_t<Kernel::in_single, SinglePack, WidestPack>;

template <class Number>
LeftJoints run_whole(const JointForces<Number>& joints, Index begin, Index end, bool books) {
  using Pack = PackOf<JointForces<Number>>;
  Index i = begin;
  for (; i + width_of<Pack> <= end; i += width_of<Pack>) {
    const auto [others, drags] = run_at<Pack>(joints, i);
    if (drags != 0 && !books) return {i, others | drags};
    if (drags != 0) {  // in double
      constexpr unsigned all = (1U << width) - 1U;
      for (Index first = 0; first < width_of<Pack>; first += width) {
        const unsigned own = drags >> first & all;
        if (own != 0) joints.template book_slips<WidestPack>(i + first, own);
      }
    }
    if (others != 0) return {i, others};
  }
  return {i, 0};
}
template <class Kernel>
Index run_all(const Kernel& triangles, Index begin, Index end) {
  using Pack = PackOf<Kernel>;
  Index t = begin;
  for (; t + width_of<Pack> <= end; t += width_of<Pack>) run_at<Pack>(triangles, t);
  return t;
}
template <class Pack, class Move>
MovedTo move_all(const Move& kernel, Index begin, Index end) {
  MovedTo moved{begin, false};
  for (; moved.end + width_of<Pack> <= end; moved.end += width_of<Pack>) {
    if (run_at<Pack>(kernel, moved.end) == Moved::beyond) moved.beyond = true;
  }
  return moved;
}

}  // namespace

[[gnu::flatten]] LeftJoints BR_PACKS::run(const JointForces<double>& kernel, Index begin, Index end,
                                          bool books) {
  return run_whole(kernel, begin, end, books);
}
[[gnu::flatten]] LeftJoints BR_PACKS::run(const JointForces<float>& kernel, Index begin, Index end,
                                          bool books) {
  return run_whole(kernel, begin, end, books);
}

[[gnu::flatten]] LeftJoints BR_PACKS::run(const JointForces<Single>& kernel, Index begin, Index end,
                                          bool books) {
  return run_whole(kernel, begin, end, books);
}

[[gnu::flatten]] unsigned BR_PACKS::run(const JointForces<double>& kernel,
                                        const AlikeJoints& pack) {
  return run_alike<WidestPack>(kernel, pack);
}
[[gnu::flatten]] unsigned BR_PACKS::run(const JointForces<float>& kernel, const AlikeJoints& pack) {
  return run_alike<WidestPack>(kernel, pack);
}

[[gnu::flatten]] unsigned BR_PACKS::run(const JointForces<Single>& kernel,
                                        const AlikeJoints& pack) {
  return run_alike<WidestPack>(kernel, pack);
}

[[gnu::flatten]] Index BR_PACKS::run(const TriangleForces<double>& kernel, Index begin, Index end) {
  return run_all(kernel, begin, end);
}
[[gnu::flatten]] Index BR_PACKS::run(const TriangleForces<float>& kernel, Index begin, Index end) {
  return run_all(kernel, begin, end);
}

[[gnu::flatten]] Index BR_PACKS::run(const TriangleForces<Single>& kernel, Index begin, Index end) {
  return run_all(kernel, begin, end);
}

// Flat: no function that other builds call is compiled for this width.
[[gnu::flatten]] Index BR_PACKS::run(const CoupleForces<double>& kernel, Index begin, Index end) {
  return run_couples<WidestPack>(kernel, begin, end);
}
[[gnu::flatten]] Index BR_PACKS::run(const CoupleForces<float>& kernel, Index begin, Index end) {
  return run_couples<WidestPack>(kernel, begin, end);
}
[[gnu::flatten]] MovedTo BR_PACKS::run(const MoveTriangles& kernel, Index begin, Index end) {
  return move_all<WidestPack>(kernel, begin, end);
}
[[gnu::flatten]] MovedTo BR_PACKS::run(const SumAndMove<double>& kernel, Index begin, Index end) {
  return move_all<WidestPack>(kernel, begin, end);
}
[[gnu::flatten]] MovedTo BR_PACKS::run(const SumAndMove<float>& kernel, Index begin, Index end) {
  return move_all<WidestPack>(kernel, begin, end);
}
[[gnu::flatten]] MovedTo BR_PACKS::run(const SumAndMove<Single>& kernel, Index begin, Index end) {
  return move_all<SinglePack>(kernel, begin, end);
}

[[gnu::flatten]] Index BR_PACKS::add(const TriangleShares& kernel, Index begin, Index end,
                                     Energies& sum) {
  Index t = begin;
  if (t + width > end || !kernel.are_free<WidestPack>(t)) return t;
  EnergiesOf<WidestPack> packs;
  for (; t + width <= end && kernel.are_free<WidestPack>(t); t += width)
    kernel.add_free<WidestPack>(packs, t);
  add_packs<WidestPack>(sum, packs);
  return t;
}
[[gnu::flatten]] Index BR_PACKS::add(const WholeJoints& joints, Index begin, Index end,
                                     ExactSum& elastic) {
  Index i = begin;
  if (i + width > end || !joints.are_whole<WidestPack>(i)) return i;
  PackSum<WidestPack> sum;
  for (; i + width <= end && joints.are_whole<WidestPack>(i); i += width)
    sum.add(joints.elastic<WidestPack>(i));
  elastic.add(sum.sum());
  return i;
}

}  // namespace breccia::fdem
