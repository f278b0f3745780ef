#pragma once
// One unstructured grid as a VTK XML file: appended raw data, UInt64 headers, zlib blocks.

#include <cstdint>
#include <string>

#include "io/frame.hpp"

namespace breccia {

/// What the cells of a file are.
enum class VtuCells : std::uint8_t { vertices = 1, lines = 3, triangles = 5 };  // VTK's numbers

/// Content of a .vtu file with the frame's points and the cells asked for, their fields with units
/// (vtkDataArray's UNITS_LABEL), and TIME [s], CYCLE and the names of groups as field data.
/// Vertices and triangles bring the fields of points along, and `radius`.
std::string vtu_content(const Frame& frame, VtuCells cells);

}  // namespace breccia
