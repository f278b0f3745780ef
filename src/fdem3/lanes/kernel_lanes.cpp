// Built once for each width of vector; BR_PACKS names the build (see CMakeLists.txt).
#if !defined(__OPTIMIZE__)
#error "needs -O1 or more: functions left as calls would be shared by builds of different widths"
#endif

#include "fdem3/stepping/kernel_lanes.hpp"

namespace breccia::fdem3 {
namespace {
constexpr Index width = width_of<WidestPack>;
}  // namespace

// Flat: no function that other builds call is compiled for this width.
[[gnu::flatten]] LeftJoints BR_PACKS::run(const JointForces& kernel, Index begin, Index end) {
  for (; begin + width <= end; begin += width) {
    const JointForces::Left left = run_at<WidestPack>(kernel, begin);
    if ((left.others | left.drags) != 0) return {begin, left};
  }
  return {begin, {0, 0}};
}
[[gnu::flatten]] Index BR_PACKS::run(const ElementForces& kernel, Index begin, Index end) {
  for (; begin + width <= end; begin += width) run_at<WidestPack>(kernel, begin);
  return begin;
}
[[gnu::flatten]] Index BR_PACKS::run(const BeddedForces& kernel, Index begin, Index end) {
  for (; begin + width <= end; begin += width) run_at<WidestPack>(kernel, begin);
  return begin;
}
[[gnu::flatten]] MovedTo BR_PACKS::run(const MoveTetrahedra& kernel, Index begin, Index end) {
  MovedTo moved{begin, false};
  for (; moved.end + width <= end; moved.end += width) {
    if (run_at<WidestPack>(kernel, moved.end) == fdem_shared::Moved::beyond) moved.beyond = true;
  }
  return moved;
}

}  // namespace breccia::fdem3
