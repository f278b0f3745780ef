#pragma once
// The rules of a case that its keys cannot state one by one.

#include <string>

#include "dem/setup/config.hpp"
#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"

namespace breccia {
namespace dem {

/// Names that lead nowhere, laws that do not fit, bodies that cannot be built or lie in each other.
/// `run`, `prepare` and `check` apply these rules alike. No file is read.
/// @throws InputError with all problems at once
void check_case(const Config& config);

}  // namespace dem
namespace fdem {

/// Names that lead nowhere, tables that do not fit, bodies that cannot be meshed or lie in each
/// other. @throws InputError with all problems at once
void check_case(const Config& config);

}  // namespace fdem
namespace fdem3 {

/// Checks a case of tetrahedra. @throws InputError with all problems at once
void check_case(const Config& config);

}  // namespace fdem3
namespace prepare {

/// Reads every file that bodies name, as building them would. Scripts for gmsh are not run.
/// @throws InputError with all problems at once; IoError if files that cannot be read are all that
///         is wrong
void check_files(const dem::Config& config, const std::string& case_folder);
void check_files(const fdem::Config& config, const std::string& case_folder);
void check_files(const fdem3::Config& config, const std::string& case_folder);

}  // namespace prepare
}  // namespace breccia
