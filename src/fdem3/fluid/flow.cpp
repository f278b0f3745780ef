#include "fdem_shared/fluid/network.hpp"

namespace breccia::fdem_shared {

template Flowed flow(std::vector<FaceCell>& cells, const FlowSource& source, double viscosity,
                     double span);

}  // namespace breccia::fdem_shared
