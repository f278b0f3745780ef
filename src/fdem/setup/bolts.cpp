#include "fdem/setup/bolts.hpp"

#include "exec/error.hpp"
#include "fdem/setup/materials.hpp"
#include "fdem/shape.hpp"
#include "fdem_shared/setup/bolts.hpp"

namespace breccia::fdem {
namespace {

/// The stiffest corners that the case may have; no limit where its materials are in error.
double stiffest_corners(const Config& config) {
  try {
    double most = 0.0;
    for (const ElasticTriangle& law : elastic_table(config))
      most = std::max(most, Shape::corner_stiffness(law, {}));
    return most > 0.0 ? most : no_limit;
  } catch (const InputError&) {  // told by itself
    return no_limit;
  }
}

}  // namespace

std::vector<std::string> bolt_problems(const Config& config) {
  return fdem_shared::problems_of_bolts<Shape>(config, stiffest_corners(config));
}

}  // namespace breccia::fdem
