#pragma once
// Bodies that are turned, have the shape of a file, or of which something is cut out.
//
// A body is packed, linked and measured upright and whole, as a box, sphere or cylinder; then what
// lies outside of its shape goes. Its material is that of the whole, and cut faces are as rough as
// the elements are large.

#include <functional>
#include <string>

#include "dem/setup/config.hpp"
#include "dem/setup/model.hpp"
#include "prepare/packing/packing.hpp"
#include "prepare/shapes/solid.hpp"
#include "prepare/shapes/surface.hpp"

namespace breccia::prepare {

/// Whether elements of the body go, or move, once it is whole.
bool is_shaped(const dem::BodyConfig& body);

/// The upright body that is packed: of an STL file, or with joins, the box around it, with as many
/// more elements as it is larger; without turn and cuts.
/// @throws as read_surface
dem::BodyConfig whole_of(const dem::BodyConfig& body, const std::string& case_folder);

/// A case with the upright bodies that are packed, and the bars drawn in them where they lie then.
dem::Config with_whole_bodies(const dem::Config& config, const std::string& case_folder);

/// Whether a place of the whole of an STL body, or of one with joins, lies in its shape before that
/// is turned; empty for others.
std::function<bool(const Vec3&)> shape_within(const dem::BodyConfig& body,
                                              const dem::MaterialConfig& material,
                                              const std::string& case_folder);

/// Gives the bodies of a linked model their shapes: elements whose centres lie outside go, links
/// that pass through what is cut out go, and elements that lose all their links; turned bodies take
/// their bars along. `fabric` is made anew for bodies from a file.
/// @throws InputError names a body of which nothing is left
void carve(dem::Model& model, const dem::Config& config, const std::string& case_folder);

}  // namespace breccia::prepare
