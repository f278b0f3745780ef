#pragma once
// Notes on its run that pictures and films of a result folder carry.

#include <optional>
#include <string>
#include <vector>

#include "run/results/picture_notes.hpp"

namespace breccia::app {

/// Of the run in the folder; empty where its case.toml or summary.json is not there.
std::vector<PngNote> run_notes(const std::string& folder);

/// The moment of a frame by the run's log; none if the log does not tell.
std::optional<PictureMoment> moment_of_frame(const std::string& folder, int number, double time);

/// The title of the run's case or, without one, its name; empty if neither is known.
std::string run_title(const std::string& folder);

/// One line about the run, for a film.
std::string run_line(const std::string& folder);

}  // namespace breccia::app
