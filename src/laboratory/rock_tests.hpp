#pragma once
// The virtual laboratory of the FDEM: plane specimens of one rock.

#include <cstdint>
#include <string>
#include <vector>

#include "fdem/setup/config.hpp"
#include "laboratory/concrete_tests.hpp"

namespace breccia::laboratory {

/// Material of all plane specimens.
struct RockSample {
  fdem::MaterialConfig material;
  fdem::JointsConfig joints;
  int elements = 1200;  ///< triangles of the plate and of the disc, about  [-]
};

/// The material of a case, with its rules of joints; specimens are in plane stress, where slopes
/// of curves are E and nu.
/// @throws InputError if there is no such material, or it does not break
RockSample rock_sample_of(const fdem::Config& config, const std::string& material);

/// Compression of a plate between smooth ends, free and under pressure on its sides; a disc between
/// strips; a plate whose ends part.
const std::vector<SpecimenTest>& rock_tests();

/// The case of a test, with a free mesh that differs with the seed. Ends of plates move along y and
/// are free across; a disc is pressed by its corners within a tenth of its diameter.
/// @param folder  takes no file
fdem::Config case_of(const SpecimenTest& test, const RockSample& sample, std::int64_t seed,
                     const std::string& folder);

}  // namespace breccia::laboratory
