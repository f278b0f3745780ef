#pragma once
// Specimens of the lattice discrete particle model in the virtual laboratory.

#include <cstdint>
#include <vector>

#include "laboratory/concrete_tests.hpp"

namespace breccia::laboratory {

/// Compression between smooth, rough and held ends of prism and cube, direct tension of a plain
/// and of a notched prism, triaxial and equal biaxial compression, hydrostatic pressure, and
/// compression between sides that stand still. A prism is five of the mix's largest grains wide.
std::vector<SpecimenTest> ldpm_tests(const dem::MaterialConfig& material);

/// The case of a test. All faces are supports: what is pressed are the particles on them, so that
/// plates are stiff and smooth, or rub with the friction of contacts, and held ends neither spread
/// nor turn.
dem::Config ldpm_case_of(const SpecimenTest& test, const Sample& sample, std::int64_t seed);

}  // namespace breccia::laboratory
