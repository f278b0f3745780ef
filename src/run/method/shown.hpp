#pragma once
// Whether a case asks only for what its run will show.

#include "coupled/setup/config.hpp"
#include "dem/setup/config.hpp"
#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"

namespace breccia {

/// Holds output.color and the value of every check against the fields and numbers of a small
/// specimen of the method with the case's bodies, so that nothing is missed after a long run.
/// @throws InputError with all problems at once
void check_shown(const dem::Config& config);
void check_shown(const fdem::Config& config);
void check_shown(const fdem3::Config& config);
void check_shown(const coupled::Config& config);

}  // namespace breccia
