#pragma once
// Values that a case can be run with and that are hardly meant: lengths and densities in another
// unit, strengths that are never reached, elements larger than their body.

#include <string>
#include <vector>

#include "dem/setup/config.hpp"
#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"

namespace breccia::prepare {

/// A sentence for each, which begins with its key and says what is usual.
/// @param folder  of the case
std::vector<std::string> doubtful_values(const dem::Config& config, const std::string& folder);
std::vector<std::string> doubtful_values(const fdem::Config& config, const std::string& folder);
std::vector<std::string> doubtful_values(const fdem3::Config& config, const std::string& folder);

}  // namespace breccia::prepare
