#pragma once
// Forces of contacts as lines, coloured and as wide as they are large.

#include "io/picture/field_colors.hpp"

namespace breccia {

inline constexpr const char* contact_field = "contact_force";

/// Whether a picture by this field is one of contacts: by its name, or by that of forces where the
/// frame has no links.
bool is_of_contacts(const Frame& frame, const std::string& field);

/// Colours by the force of contacts, and bodies pale.
void color_by_contacts(const Frame& frame, const std::optional<ValueRange>& range,
                       const std::string& map, bool log, Coloring& coloring);

/// Adds dark lines for contacts to a picture by another field.
void add_contacts(const Frame& frame, Coloring& coloring);

}  // namespace breccia
