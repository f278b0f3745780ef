#pragma once
// Symmetric tensors of the plane: four fields in a frame, one field in files.

#include <vector>

#include "io/frame.hpp"

namespace breccia {

/// The fields, but four of one number that follow each other, NAME_xx, NAME_yy, NAME_zz and
/// NAME_xy, are one field NAME of six: xx, yy, zz, xy, yz, xz, as VTK orders a symmetric tensor;
/// yz and xz are 0 in the plane.
std::vector<FrameField> tensors_joined(const std::vector<FrameField>& fields);

/// The opposite: fields of six numbers become these four.
std::vector<FrameField> tensors_parted(std::vector<FrameField> fields);

}  // namespace breccia
