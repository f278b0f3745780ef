#pragma once
// What the keys of FDEM bodies cannot tell by themselves.

#include <string>
#include <vector>

#include "prepare/build_fdem.hpp"

namespace breccia::prepare {

/// Everything that keeps a case's bodies from being meshed, one sentence each: names that lead
/// nowhere, keys that a shape needs or cannot use, shares that do not fit.
std::vector<std::string> body_problems(
    const std::vector<fdem::BodyConfig>& bodies,
    const std::vector<fdem::DiscontinuityConfig>& discontinuities, const FdemNames& names);

}  // namespace breccia::prepare
