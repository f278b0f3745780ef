#pragma once
// Frames as VTKHDF 1.0: unstructured grids in HDF5 files, where the program is built with HDF5.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/vtu/frame_file.hpp"

namespace breccia {

/// Numbers in files of frames.
enum class FrameNumber : std::uint8_t { float32, float64, int32, int64, uint8 };

/// An array of a file, its chunks compressed already.
struct HdfArray {
  std::string section;  ///< as a .vtu names it: "PointData", "Cells", ...
  std::string name, unit;
  FrameNumber type;
  std::size_t rows, components;
  std::size_t chunk_rows = 0;
  std::vector<std::string_view> chunks = {};  ///< zlib streams of chunk_rows rows each
};
struct HdfGrid {
  std::size_t points, cells, corners;
  std::vector<HdfArray> arrays;
};

/// Whether this program is built with HDF5.
bool has_hdf5();

/// The bytes of a file: the same for equal grids. @throws DeviceError for want of memory
std::string vtkhdf_content(const HdfGrid& grid);

/// @throws IoError if the file is missing, damaged, or this program is built without HDF5
std::unique_ptr<FrameFile> open_vtkhdf(const std::string& path);

}  // namespace breccia
