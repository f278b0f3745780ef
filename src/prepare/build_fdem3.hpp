#pragma once
// From a case of the FDEM in three dimensions to a model: meshes, minerals, strengths, cracks,
// order in memory.

#include <string>

#include "fdem3/setup/config.hpp"
#include "fdem3/setup/model.hpp"

namespace breccia {

/// The model of a case. A function of the case alone: same seed, same bits (for bodies that gmsh
/// meshes: with the same version of gmsh).
///
///   bodies    each is a group, in the order of the case. Bodies do not share vertices, except
///             those from one file with one `center`.
///   order     tetrahedra follow Hilbert's curve, vertices the tetrahedra that use them.
///   strength  one for every tetrahedron without [body.weibull].
///
/// @param case_folder  where the files named by the case are
/// @throws InputError  names every body and key that is wrong
/// @throws IoError     if a file cannot be read
fdem3::Model build_model(const fdem3::Config& config, const std::string& case_folder);

}  // namespace breccia
