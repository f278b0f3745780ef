#pragma once
// Sets of joints as lines: read from files, or drawn at random.

#include <cstdint>
#include <string>
#include <vector>

#include "fdem/setup/body_config.hpp"

namespace breccia::prepare {

/// The lines of a set, each a discontinuity that carries the set's name.
///
/// Random ones: middles are uniform in the rectangle, grown by half of `most`, or of ten means;
/// angles and lengths are independent. Lines are cut at the rectangle; the last one ends where the
/// intensity is met. A function of seed and number.
///
/// @param number  of the set in its case
/// @throws InputError  if the file says something else, or no length fits
std::vector<fdem::DiscontinuityConfig> lines_of_set(const fdem::JointSetConfig& set,
                                                    std::int64_t seed, std::size_t number,
                                                    const std::string& case_folder);

/// Problems of the keys of a set.
std::vector<std::string> joint_set_problems(const fdem::JointSetConfig& set,
                                            const std::vector<std::string>& joints);

}  // namespace breccia::prepare
