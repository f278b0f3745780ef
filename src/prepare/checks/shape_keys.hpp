#pragma once
// Keys that only bodies of other shapes have.

#include <string>
#include <vector>

#include "dem/setup/config.hpp"
#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"

namespace breccia::prepare {

/// "body.ball.size is of boxes and files; shape is sphere": a sentence for each key of a body, and
/// of its cuts and joins, that its shape does not read.
std::vector<std::string> keys_of_other_shapes(const dem::BodyConfig& body);
std::vector<std::string> keys_of_other_shapes(const fdem::BodyConfig& body);
std::vector<std::string> keys_of_other_shapes(const fdem3::BodyConfig& body);

}  // namespace breccia::prepare
