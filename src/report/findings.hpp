#pragma once
// Findings of a run, in three sentences: what broke and when, where and how, what it bore or how
// near it was to breaking. `run` says them at its end, a report at its beginning.

#include <string>
#include <vector>

#include "report/record.hpp"

namespace breccia::report {

/// The sentences, made from the files of the run. Looks at about ten frames.
/// @throws IoError or InputError if a frame cannot be read
std::vector<std::string> findings_of(const Record& record);

}  // namespace breccia::report
