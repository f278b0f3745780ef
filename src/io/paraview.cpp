#include "io/paraview.hpp"

namespace breccia {

ParaviewSeries::ParaviewSeries(const std::string& folder) : folder_(folder) {}
ParaviewSeries ParaviewSeries::resumed(const std::string& folder, double) {
  return ParaviewSeries(folder);
}
void ParaviewSeries::write(const Frame& frame) {
  times_.push_back(frame.time);
}
void ParaviewSeries::write_collections() const {}
void ParaviewSeries::drop_from(std::size_t) {}

}  // namespace breccia
