#pragma once
// Places at the start, for probes that read how far corners have gone.

#include "fdem/case.hpp"
#include "fdem/setup/model.hpp"

namespace breccia::fdem {

/// Places of all corners if a probe reads displacements or strains, and the fits of strains.
/// @throws InputError if the corners of a probe of strain lie on a line
void set_up_starts(Case& given, const Config& config, const Model& model);

}  // namespace breccia::fdem
