#pragma once
// Cases of spheres and tetrahedra: their models, rules and files, as those of both methods.

#include <string>
#include <vector>

#include "coupled/setup/config.hpp"
#include "coupled/setup/model.hpp"
#include "io/checkpoint.hpp"

namespace breccia {

/// The models of both methods. @throws InputError, IoError as theirs, keys with the part before
/// them
coupled::Model build_model(const coupled::Config& config, const std::string& case_folder,
                           const Exec& how = {});

/// Adds both models, as sections "spheres.model.*" and "tetrahedra.model.*".
void save_model(CheckpointWriter& writer, const coupled::Model& model);
/// @throws CheckpointError if a section is missing or the arrays do not fit each other
coupled::Model load_coupled_model(const CheckpointReader& reader);

namespace coupled {

/// The rules of both parts, and those between them. @throws InputError with all problems at once
void check_case(const Config& config);

}  // namespace coupled

namespace prepare {

void check_regions(const coupled::Config& config, const std::string* folder = nullptr);
void check_files(const coupled::Config& config, const std::string& case_folder);

/// Doubts of the parts, with their names: of walls (check_regions.hpp), loads, and stress at the
/// start (check_in_situ.hpp), and values (check_values.hpp).
std::vector<std::string> doubtful_walls(const coupled::Config& config, const std::string& folder);
std::vector<std::string> doubtful_loads(const coupled::Config& config, const std::string& folder);
std::vector<std::string> doubtful_in_situ(const coupled::Config& config, const std::string& folder);
std::vector<std::string> doubtful_values(const coupled::Config& config, const std::string& folder);

}  // namespace prepare
}  // namespace breccia
