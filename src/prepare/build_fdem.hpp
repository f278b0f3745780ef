#pragma once
// From the bodies of an FDEM case to a model: meshes, minerals, strengths, cracks, order in memory.

#include <cstdint>
#include <string>
#include <vector>

#include "fdem/setup/config.hpp"
#include "fdem/setup/model.hpp"

namespace breccia {

/// The names that bodies and discontinuities refer to.
struct FdemNames {
  std::vector<std::string> materials, joints;  ///< in the order of the case
};
FdemNames names_of(const fdem::Config& config);

/// The model of an FDEM case. A function of the case alone: same seed, same bits (for bodies that
/// gmsh meshes: with the same version of gmsh).
///
///   bodies    each is a group, in the order of the case. Bodies do not share vertices, except
///             those from one file with one `center`.
///   order     triangles follow Hilbert's curve, vertices the triangles that use them.
///   strength  one for every triangle without [body.weibull].
///
/// @param case_folder  where the files named by the case are
/// @throws InputError  names every body and key that is wrong
/// @throws IoError     if a file cannot be read
fdem::Model build_fdem_model(const std::vector<fdem::BodyConfig>& bodies,
                             const std::vector<fdem::DiscontinuityConfig>& discontinuities,
                             const FdemNames& names, std::int64_t seed,
                             const std::string& case_folder,
                             const std::vector<fdem::JointSetConfig>& joint_sets = {});
fdem::Model build_model(const fdem::Config& config, const std::string& case_folder);

}  // namespace breccia
