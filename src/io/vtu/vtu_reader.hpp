#pragma once
// Reads back the frames that ParaviewSeries wrote.

#include <string>
#include <vector>

#include "io/frame.hpp"

namespace breccia {

/// Times of the frames in a result folder, from its elements.pvd.  [s]
/// @throws IoError if that file cannot be read
std::vector<double> frame_times(const std::string& folder);

/// Frame number `index` of frame_times(folder); numbers as precise as the files (Float32).
/// @throws InputError if there is no such frame, IoError if a file is missing or damaged
Frame read_frame(const std::string& folder, int index);

}  // namespace breccia
