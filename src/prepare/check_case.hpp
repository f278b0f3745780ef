#pragma once

#include "dem/config.hpp"

namespace breccia::dem {

/// What keys by themselves cannot tell: names that lead nowhere, laws that do not fit, bodies in
/// each other.
/// @throws InputError with all problems at once
void check_case(const Config& config);

}  // namespace breccia::dem
