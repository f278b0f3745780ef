#pragma once
// From the materials of a case to numbers that kernels read.

#include "fdem/setup/materials.hpp"
#include "fdem3/case.hpp"

namespace breccia::fdem3 {

/// The keys that do not depend on the number of dimensions, as the plane method has them: laws of
/// joints and friction come from the same tables.
fdem::Config shared_keys(const Config& config);

/// Whether some material is stiffer in one direction than in others.
bool has_bedded_rock(const Config& config);

/// Stiffness of bedded rock. @throws InputError naming the key where no such rock can be
SolidModuli moduli_of(const MaterialConfig& material);

/// @throws InputError for a Poisson's ratio of 0.5 or more, or a bedding that no rock can have
std::vector<ElasticTetrahedron> elastic_table(const Config& config);

/// Laws of materials, or, where the stress in situ has a slope, of tetrahedra.
std::vector<ElasticTetrahedron> elastic_laws(const Config& config, const Case& given);

/// @param lengths  h_c of each material  [m]  @throws InputError for names that do not exist
std::vector<ContactPair> contact_table(const Config& config, const std::vector<double>& lengths);

/// Materials as waves meet them: joints between tetrahedra whose faces point everywhere add 4/(3 p)
/// to 1/E, p the joint's stiffness (docs/theory-fdem3.md, 2).
std::vector<EffectiveRock> effective_rocks(const Config& config);

}  // namespace breccia::fdem3
