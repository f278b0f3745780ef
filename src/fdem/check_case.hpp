#pragma once

#include "fdem/config.hpp"

namespace breccia::fdem {

/// What keys by themselves cannot tell: names that lead nowhere, tables that do not fit.
/// @throws InputError with all problems at once
void check_case(const Config& config);

/// Why a probe cannot read this, and what it can read.
std::string no_z(const std::string& quantity);

}  // namespace breccia::fdem
