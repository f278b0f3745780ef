#pragma once
// Bodies, supports and walls that go further in one step than an element is large.

#include <string>
#include <vector>

#include "run/machine/forecast.hpp"

namespace breccia {

/// A sentence for each velocity with which something passes the smallest element within a step that
/// a forecast expects; it begins with its key.
std::vector<std::string> too_fast(const dem::Config& config, const Forecast& expected);
std::vector<std::string> too_fast(const fdem::Config& config, const Forecast& expected);
std::vector<std::string> too_fast(const fdem3::Config& config, const Forecast& expected);
std::vector<std::string> too_fast(const coupled::Config& config, const Forecast& expected);

}  // namespace breccia
