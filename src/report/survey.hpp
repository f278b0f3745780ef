#pragma once
// Survey of a run's frames: what they have in common, and the ranges of their numbers.

#include <string>
#include <vector>

#include "report/shot.hpp"

namespace breccia::report {

/// A field of elements or lines over all frames.
struct FieldSurvey {
  std::string name, unit;
  bool of_lines = false;
  int components = 1;
  bool category = false;          ///< its values are names and not a scale
  bool constant = true;           ///< it is alike in all frames
  float low = 0.0F, high = 0.0F;  ///< of all components
  double mean_size = 0.0;         ///< mean of |value| in the last frame
};

struct FrameFacts {
  int number = 0;  ///< in the folder
  std::int64_t step = 0;
  double time = 0.0;  ///<  [s]
  std::size_t lines = 0;
  std::vector<std::size_t> broken;  ///< lines, by their field "kind"
};

struct Survey {
  bool plane = false, solid = false;  ///< of triangles, of tetrahedra; else of spheres
  std::size_t elements = 0;
  bool lines_constant = true;  ///< all frames list the same lines in the same order
  Vec3 low, high;              ///< box around the elements of all frames  [m]
  double size = 0.0;           ///< mean radius, or mean edge of a triangle or tetrahedron  [m]
  std::vector<FieldSurvey> fields;
  std::vector<std::string> groups;
  std::size_t contacts = 0;    ///< of the frame that has most
  double contact_force = 0.0;  ///< the largest  [N; N/m of triangles]
  std::size_t bolts = 0;       ///< pieces of them in the frame that has most
  double bolt_force = 0.0;     ///< the largest in size  [N; N/m of triangles]
  std::vector<FrameFacts> frames;
  Shot first, last;

  bool spheres() const { return !plane && !solid; }
};

/// Looks at all frames of a result folder, one after the other.
/// @param count  how many there are; not 0
/// @throws IoError if a frame cannot be read, or does not list the elements of the first one
Survey survey_of(const std::string& folder, std::size_t count);

}  // namespace breccia::report
