#pragma once
// Loads of a case: their faces; how large they are is in fdem_shared/setup/over_time.hpp.

#include "fdem3/shape.hpp"
#include "fdem_shared/setup/over_time.hpp"

namespace breccia::fdem3 {

using fdem_shared::prescribe_loads;
using fdem_shared::set_up;

/// Which faces they act on.
void set_up_loads(World& w, const Config& config, const Model& model);

}  // namespace breccia::fdem3
