#pragma once
// The virtual laboratory of the FDEM: plane specimens of one rock.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fdem/setup/config.hpp"
#include "io/case/material_library.hpp"
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
/// @param pressure  on the sides of the plate under pressure  [Pa]
std::vector<SpecimenTest> rock_tests(double pressure);

/// Half the compressive strength, a target or that of the joints, but no more than the target
/// `confinement`, up to which the source's friction angle holds.  [Pa]
double side_pressure(const std::vector<MaterialTarget>& targets, const fdem::StrengthConfig& joint);

/// Axial strength under a pressure by the targets `compression` and `friction_angle`; nothing
/// without both.  [Pa]
std::optional<double> pressed_strength(const std::vector<MaterialTarget>& targets, double pressure);

/// Strength that a pressure adds, over it: (1 + sin phi) / (1 - sin phi).
double gain_of(double friction_angle);

/// By how much an angle changes with its gain, d(phi) = cos(phi)/2 dN/N.  [rad]
double angle_for(double friction_angle, double gain_change);

/// The case of a test, with a free mesh that differs with the seed. Ends of plates move along y and
/// are free across; a disc is pressed by its corners within a tenth of its diameter.
/// @param folder  takes no file
fdem::Config case_of(const SpecimenTest& test, const RockSample& sample, std::int64_t seed,
                     const std::string& folder);

}  // namespace breccia::laboratory
