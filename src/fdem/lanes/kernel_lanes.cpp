// Built once for each width of vector; BR_PACKS names the build (see CMakeLists.txt).

#include "fdem/kernel_lanes.hpp"

namespace breccia::fdem {
namespace {

constexpr Index width = width_of<WidestPack>;

}  // namespace

Index BR_PACKS::run(const JointForces& kernel, Index begin, Index end) {
  Index i = begin;
  while (i + width <= end && kernel.whole_at<WidestPack>(i)) i += width;
  return i;
}

Index BR_PACKS::run(const TriangleForces& kernel, Index begin, Index end) {
  Index t = begin;
  for (; t + width <= end; t += width) kernel.at<WidestPack>(t);
  return t;
}

Index BR_PACKS::run(const MoveTriangles& kernel, Index begin, Index end) {
  Index t = begin;
  while (t + width <= end && kernel.free_at<WidestPack>(t)) t += width;
  return t;
}

}  // namespace breccia::fdem
