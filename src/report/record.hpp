#pragma once
// A result folder as a report reads it: everything but the frames.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "math/vec.hpp"
#include "report/scene.hpp"
#include "report/table.hpp"

namespace breccia::report {

/// A link or joint that broke.
struct Break {
  double time;                            ///<  [s]
  std::size_t kind;                       ///< of links, as frames number them; of joints 0
  std::optional<Vec3> at = std::nullopt;  ///< middle of a link  [m]
};

struct Record {
  std::string folder;
  std::string summary;                    ///< summary.json as it is: JSON
  std::map<std::string, double> numbers;  ///< of it by their paths, as "fracture.broken_links"
  std::map<std::string, std::string> texts;
  std::string case_text;  ///< case.toml; empty: there is none
  Scene scene;
  NumberTable history;                ///< history.csv
  NumberTable cracks;                 ///< cracks.csv; no columns: there is none
  std::vector<Break> breaks;          ///< of joints or links since the start, in their order
  NumberTable fragments;              ///< fragments.csv, likewise
  std::vector<std::string> warnings;  ///< and errors, of log.jsonl
  std::vector<double> times;          ///< of the frames  [s]

  std::string text(const std::string& path) const;
  std::optional<double> number(const std::string& path) const;
};

/// Reads a result folder.
/// @throws IoError    if there is no such folder, or a file of it cannot be read
/// @throws InputError if it holds no run, or a file of it is damaged
Record read_record(const std::string& folder);

}  // namespace breccia::report
