#pragma once
// How HDF5 reads a file that is in memory: by a driver that copies nothing before it is asked for,
// and that tells where a chunk stands. Its own driver reads metadata ahead into an accumulator,
// which with the addresses of a forged file copies from nowhere (HDF5 1.10.8, H5F__accum_read).

#include <hdf5.h>

#include <optional>
#include <string_view>

#include "io/vtu/hdf_index.hpp"

namespace breccia {

/// As files hold it.
hid_t hdf_type(FrameNumber type);

/// Properties by which H5Fopen() opens the content, for reading alone; the name does not matter.
/// @param content  stays where it is until the file is closed
/// @returns what H5Pclose() closes, or a negative number
hid_t access_to(const std::string_view& content);

/// Where a chunk of a dataset of such a file stands.
/// @returns none if there is no such chunk, or if filters were left out
std::optional<HdfPiece> chunk_at(hid_t dataset, const hsize_t* place);

}  // namespace breccia
