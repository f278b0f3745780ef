#pragma once
// The frames of a run in the form that the page draws them from: JSON that describes, and blobs of
// packed bytes. The page's own reader is web/report/src/film.js.

#include <string>
#include <vector>

#include "report/survey.hpp"

namespace breccia::report {

struct Film {
  std::string json;                ///< what the blobs hold
  std::vector<std::string> blobs;  ///< one a frame, in base 64
  std::vector<std::string> notes;  ///< what was left out, a sentence each

  std::size_t bytes() const;
};

/// Packs the frames. Positions are whole steps of a box, of 2 or 3 bytes; fields have 255 or 511
/// steps. Where that would take more than `limit` bytes, details go first, then frames, then
/// elements that cannot be seen, then any; `notes` says so.
/// @param first_blob  number that the first blob will have in the page
/// @param limit       of the blobs together; kept unless even the barest film is larger  [bytes]
Film film_of(const std::string& folder, const Survey& survey, std::size_t first_blob,
             std::size_t limit);

}  // namespace breccia::report
