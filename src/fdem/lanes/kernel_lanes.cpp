// Built once for each width of vector; BR_PACKS names the build (see CMakeLists.txt).

#include "fdem/kernel_lanes.hpp"

namespace breccia::fdem {
namespace {

constexpr Index width = width_of<WidestPack>;

}  // namespace

Index BR_PACKS::run(const JointForces& kernel, Index begin, Index end) {
  Index i = begin;
  for (; i + width <= end; i += width) {
    if (kernel.whole_at<WidestPack>(i)) continue;
    for (Index k = i; k < i + width; ++k) kernel(k);
  }
  return i;
}

Index BR_PACKS::run(const TriangleForces& kernel, Index begin, Index end) {
  Index t = begin;
  for (; t + width <= end; t += width) kernel.at<WidestPack>(t);
  return t;
}

Index BR_PACKS::run(const MoveTriangles& kernel, Index begin, Index end) {
  Index t = begin;
  for (; t + width <= end; t += width) {
    if (kernel.free_at<WidestPack>(t)) continue;
    for (Index k = t; k < t + width; ++k) kernel(k);
  }
  return t;
}

}  // namespace breccia::fdem
