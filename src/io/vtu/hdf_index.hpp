#pragma once
// Contents of an HDF5 file of a frame, and their places.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/vtu/vtkhdf.hpp"

namespace breccia {

/// Bytes of a file.
struct HdfPiece {
  std::uint64_t begin, size;
};
/// A dataset.
struct HdfEntry {
  std::string path;     ///< below /VTKHDF/
  std::string problem;  ///< why its numbers cannot be read, if they cannot
  std::string unit;
  FrameNumber type = FrameNumber::uint8;
  std::uint64_t rows = 0, components = 1;
  std::uint64_t chunk_rows = 0;  ///< 0: all rows are one piece
  bool packed = false;           ///< each chunk is a zlib stream
  std::vector<HdfPiece> pieces;
};

/// The datasets of a frame, in the order of the file. HDF5 trusts what a forged file says and has
/// ended by signals on some: it looks at the file in a process of its own, and whoever reads
/// numbers takes them from the content itself.
/// @throws IoError without the path if HDF5 refuses the file or does not survive it
std::vector<HdfEntry> hdf_index(std::string_view content);

}  // namespace breccia
