#pragma once
// Which part of a run's frames a film shows.

#include <cstdint>
#include <string>
#include <vector>

#include "report/survey.hpp"

namespace breccia::report {

/// Frames and fields that go into a film.
struct Selection {
  std::vector<std::size_t> frames;      ///< of the survey
  std::vector<std::uint32_t> elements;  ///< ascending
  bool line_forces = true;              ///< scales of lines, as their forces
  bool components = true;               ///< of vectors; else their lengths
  bool fine = true;                     ///< 511 steps a field and fine positions
  bool all_fields = true;               ///< else groups and damage
  bool hidden = true;                   ///< elements inside that nobody sees
  std::size_t stride = 1;               ///< each so many elements

  /// All there is.
  static Selection whole(const Survey& survey);
  /// Leaves the next detail out. False: nothing is left that could go.
  bool tighten(const Survey& survey);
  bool takes(const FieldSurvey& field) const;
  /// Items that it leaves out, in sentences.
  std::vector<std::string> notes(const Survey& survey) const;
  /// How large the film will be, from experience.  [bytes]
  double estimate(const Survey& survey) const;
};

/// Elements of which a part can be seen from outside, or that are damaged, or belong to one of the
/// smaller bodies, in the first frame or in the last.
std::vector<std::uint32_t> visible_elements(const Survey& survey);

}  // namespace breccia::report
