#include "fdem3/setup/bolts.hpp"

#include "fdem3/shape.hpp"
#include "fdem_shared/setup/bolts.hpp"

namespace breccia::fdem3 {

std::vector<std::string> bolt_problems(const Config& config) {
  return fdem_shared::problems_of_bolts<Shape>(config, no_limit);
}

}  // namespace breccia::fdem3
