#pragma once
// Rules for bodies that their keys cannot state one by one.

#include <string>
#include <vector>

#include "dem/setup/config.hpp"
#include "fdem3/setup/config.hpp"
#include "prepare/build_fdem.hpp"

namespace breccia::prepare {

/// Everything that keeps the bodies of a case from being built, one sentence each: names that lead
/// nowhere, keys that a shape needs or cannot use, laws and shares that do not fit. No file is read
/// and nothing is built.
std::vector<std::string> body_problems(const dem::Config& config);
std::vector<std::string> body_problems(
    const std::vector<fdem::BodyConfig>& bodies,
    const std::vector<fdem::DiscontinuityConfig>& discontinuities, const FdemNames& names);
std::vector<std::string> body_problems(const fdem3::Config& config);

/// Names that lead nowhere, tables that do not fit, and bodies that cannot be built or lie in each
/// other. Rules of the other methods are in their setup.
std::vector<std::string> case_problems(const fdem3::Config& config);

/// Bodies that share space by their keys alone. The built model is tested by its elements again.
std::vector<std::string> overlap_problems(const std::vector<dem::BodyConfig>& bodies);
/// Plates, beams and discs without holes and slots; discs if they overlap by more than sides of
/// their mesh lie within the circle.
std::vector<std::string> overlap_problems(const std::vector<fdem::BodyConfig>& bodies);
/// Boxes, cylinders and spheres; round ones if they overlap by more than an edge of their mesh.
/// Cylinders with different axes are not looked at.
std::vector<std::string> overlap_problems(const std::vector<fdem3::BodyConfig>& bodies);

/// The problem of a part that takes nothing of its body; empty: it may take some. Of bodies from a
/// file, and of cylinders with different axes that the boxes around them do not tell apart,
/// nothing.
std::string missing_part(const fdem3::BodyConfig& part, const fdem3::BodyConfig& body);
inline std::string none_in_part(const std::string& element, const std::string& body) {
  return "takes nothing: no " + element + " of body." + body + " has its middle in it";
}

inline std::string overlap_problem(const std::string& a, const std::string& b) {
  return "body." + a + " and body." + b + " overlap at the start; move one of them";
}

}  // namespace breccia::prepare
