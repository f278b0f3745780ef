#include "fdem/kernel_lanes.hpp"

#include "exec/whole_packs.hpp"

namespace breccia::fdem {

void run_packs(Lanes lanes, const JointForces<double>& kernel, Index begin, Index end) {
  run_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
void run_packs(Lanes lanes, const JointForces<float>& kernel, Index begin, Index end) {
  run_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
void run_packs(Lanes lanes, const TriangleForces<double>& kernel, Index begin, Index end) {
  run_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
void run_packs(Lanes lanes, const TriangleForces<float>& kernel, Index begin, Index end) {
  run_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}
void run_packs(Lanes lanes, const MoveTriangles& kernel, Index begin, Index end) {
  run_whole_packs<PacksAvx512, PacksAvx2>(lanes, kernel, begin, end);
}

}  // namespace breccia::fdem
