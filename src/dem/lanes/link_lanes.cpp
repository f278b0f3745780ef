// Built once for each width of vector; BR_LANES names the build (see CMakeLists.txt).

#include "dem/link_lanes.hpp"

namespace breccia::dem {

BR_WHOLE Index BR_LANES(const ConcreteLinkForces& kernel, Index begin, Index end) {
  constexpr Index width = width_of<WidestPack>;
  Index i = begin;
  for (; i + width <= end; i += width) kernel.at<WidestPack>(i);
  return i;
}

}  // namespace breccia::dem
