#pragma once
// Reads back the frames that ParaviewSeries wrote.

#include <string>
#include <vector>

#include "io/vtu/vtu_writer.hpp"

namespace breccia {

/// Whether a folder lists frames.
bool holds_frames(const std::string& folder);
FrameFormat format_of_frames(const std::string& folder);

/// Times of the frames in a result folder, from its list of them.  [s]
/// @throws IoError if that file cannot be read
std::vector<double> frame_times(const std::string& folder);

/// Frame number `index` of frame_times(folder); numbers as precise as the files (Float32).
/// @throws InputError if there is no such frame, IoError if a file is missing or damaged
Frame read_frame(const std::string& folder, int index);

/// Adds the contacts of a frame that was read, from the files that hold them.
/// @returns false if the folder has no such files
bool add_contacts_of(const std::string& folder, int index, Frame& frame);

}  // namespace breccia
