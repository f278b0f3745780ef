#pragma once
// Loads of a case: their faces; how large they are is in fdem_shared/setup/over_time.hpp.

#include "fdem3/shape.hpp"
#include "fdem_shared/setup/over_time.hpp"

namespace breccia::fdem3 {

using fdem_shared::set_up;

/// How large loads are, and how that changes: what configure() writes anew.
void prescribe_loads(World& w, const Config& config);
/// Which faces they act on.
void set_up_loads(World& w, const Config& config, const Model& model);

}  // namespace breccia::fdem3
