#pragma once
// Stages that cannot begin and tables that begin too late: possible, and rarely meant; units of the
// numbers by which stages end.

#include <string>
#include <vector>

#include "coupled/setup/config.hpp"
#include "dem/setup/config.hpp"
#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"

namespace breccia::prepare {

/// Stages that begin after time.end, by the times that the ones before them take at least, tables
/// over time whose first row comes when nothing follows them any more, and ramps that are longer
/// than what they lead; a sentence each.
std::vector<std::string> doubtful_times(const dem::Config& config);
std::vector<std::string> doubtful_times(const fdem::Config& config);
std::vector<std::string> doubtful_times(const fdem3::Config& config);
std::vector<std::string> doubtful_times(const coupled::Config& config);

/// Numbers of `when` that have a unit, in SI from now on. Returns those whose unit is not one of
/// what their probe reads; a sentence each.
std::vector<std::string> put_ends_in_si(dem::Config& config);
std::vector<std::string> put_ends_in_si(fdem::Config& config);
std::vector<std::string> put_ends_in_si(fdem3::Config& config);
std::vector<std::string> put_ends_in_si(coupled::Config& config);

}  // namespace breccia::prepare
