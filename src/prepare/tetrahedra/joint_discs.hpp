#pragma once
// Sets of joints in space: polygons read from files, or discs drawn at random.

#include <cstdint>
#include <string>
#include <vector>

#include "fdem3/setup/config.hpp"
#include "prepare/tetrahedra/crack_network.hpp"

namespace breccia::prepare {

/// The polygons of a set, each a discontinuity that carries the set's name.
///
/// Random ones: middles are uniform in the box, grown by `most`, or ten mean radii; directions are
/// Fisher's, turns about them uniform, radii independent of both. Discs are regular polygons of the
/// same area, cut at the box. One that does not fit into the network is left out, the last one is
/// made smaller until the intensity is met. A function of seed, number and network.
///
/// @param number   of the set in its case
/// @param network  what is there already; it takes the polygons in
/// @throws InputError  if the file says something else, or too few discs fit
std::vector<fdem3::DiscontinuityConfig> polygons_of_set(const fdem3::JointSetConfig& set,
                                                        std::int64_t seed, std::size_t number,
                                                        const std::string& case_folder,
                                                        CrackNetwork& network);

/// The cracks of a case and then those of its sets.
std::vector<fdem3::DiscontinuityConfig> cracks_with_sets(const fdem3::Config& config,
                                                         const std::string& case_folder);

/// Problems of the keys of a set.
std::vector<std::string> joint_set_problems(const fdem3::JointSetConfig& set,
                                            const std::vector<std::string>& joints);

}  // namespace breccia::prepare
