#pragma once
// A frame as a report sees it: elements, which are spheres, triangles or tetrahedra, and lines
// between or beside them.

#include <cstdint>
#include <string>
#include <vector>

#include "io/frame.hpp"

namespace breccia::report {

/// One moment. All shots of a run list the same elements in the same order; those that a stage took
/// out show nothing.
struct Shot {
  std::int64_t step = 0;
  double time = 0.0;           ///<  [s]
  bool plane = false;          ///< of triangles
  bool solid = false;          ///< of tetrahedra; neither: of spheres
  std::vector<Vec3> corner;    ///< centres of spheres, or three or four corners an element  [m]
  std::vector<double> radius;  ///< of spheres  [m]
  std::vector<FrameField> element_fields;
  std::vector<std::int32_t> ends;  ///< of spheres: two of them a line
  /// Of triangles two ends a line, of tetrahedra three corners a joint, which is a "line" here,
  /// too. They may lie anywhere.  [m]
  std::vector<Vec3> end;
  std::vector<FrameField> line_fields;
  std::vector<FrameContact> contacts;  ///< that press without a link, the strongest first
  std::vector<FrameBar> bolts;         ///< pieces of those that are there
  std::vector<std::string> groups;     ///< names for the field "group"

  bool spheres() const { return !plane && !solid; }
  std::size_t corners_of_element() const { return solid ? 4 : plane ? 3 : 1; }
  std::size_t ends_of_line() const { return solid ? 3 : 2; }
  std::size_t elements() const { return corner.size() / corners_of_element(); }
  std::size_t lines() const { return (spheres() ? ends.size() : end.size()) / ends_of_line(); }
  /// Middle of a line.  [m]
  Vec3 middle(std::size_t line) const;
};

/// Null if there is none of this name.
const FrameField* field_named(const std::vector<FrameField>& fields, const std::string& name);

/// Frame `number` of a result folder. Elements come by their field "id", if they have one; nodes'
/// velocities become those of triangles and tetrahedra.
/// @throws InputError or IoError as read_frame
Shot read_shot(const std::string& folder, int number);

/// The shot with the elements of the first one in their order. Those that are gone lie inside the
/// largest that is left or, triangles and tetrahedra, have no size; they have its values.
/// @returns false if it cannot be told which are gone; the shot is then as it was
bool match(Shot& shot, const Shot& first);

/// Whether a line of this shot is broken: by its field "state", or by "damage".
std::vector<std::uint8_t> broken_lines(const Shot& shot);

}  // namespace breccia::report
