#pragma once

#include "fdem/config.hpp"

namespace breccia::fdem {

/// What keys by themselves cannot tell: names that lead nowhere, tables that do not fit.
/// @throws InputError with all problems at once
void check_case(const Config& config);

}  // namespace breccia::fdem
