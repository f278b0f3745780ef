#pragma once
// Symmetric tensors: one field a component in a frame, one field of six in files.

#include <vector>

#include "io/frame.hpp"

namespace breccia {

/// The fields, but fields of one number that follow each other, NAME_xx, NAME_yy, NAME_zz, NAME_xy
/// and, in space, NAME_yz, NAME_xz, are one field NAME of six, in this order: VTK's of a symmetric
/// tensor. In the plane yz and xz are 0.
std::vector<FrameField> tensors_joined(const std::vector<FrameField>& fields);

/// The opposite: fields of six numbers become four in the plane, six in space.
std::vector<FrameField> tensors_parted(std::vector<FrameField> fields, bool plane);

}  // namespace breccia
