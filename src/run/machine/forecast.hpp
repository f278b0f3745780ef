#pragma once
// Forecast of time and memory before a model is built: from small specimens of its bodies.

#include <string>

#include "coupled/setup/config.hpp"
#include "dem/setup/config.hpp"
#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"

namespace breccia {

/// The cost of a run as its start lets expect it: contacts and fragments to come make it dearer.
/// Everything but counts of packed elements is an estimate, mostly within a half.
struct Forecast {
  double items = 0.0;  ///< elements, triangles or tetrahedra; 0: only the mesh program tells
  double bonds = 0.0;  ///< links or joints at the start
  const char *item_name = "elements", *bond_name = "links";
  double step = 0.0;      ///< 0: nothing rules it at the start  [s]
  std::string step_rule;  ///< "joints of beam (mesh_size 5 mm)"
  double least = 0.0;     ///< size of the smallest element: a radius or an edge  [m]
  const char* least_name = "radius";
  double steps = 0.0;          ///< to time.end
  double here_s = 0.0;         ///< wall time of the steps on all processors of this machine  [s]
  double output_s = 0.0;       ///< rows, frames and pictures, besides  [s]
  double setup_s = 0.0;        ///< packing, meshing, tests for fracture energies, besides  [s]
  bool counted = false;        ///< items and bonds are those of a model
  bool of_model = false;       ///< the step is that of a model, not of specimens
  bool cut_by_lines = false;   ///< lines cut elements that ask for shorter steps than specimens do
  bool may_end_early = false;  ///< its stages end at rest or when a probe says so
  bool joined = false;         ///< of triangles or tetrahedra with joints, whose pieces would touch
  double gpu_s = 0.0;          ///< of the steps on an H200; 0: not measured  [s]
  double memory = 0.0;         ///< the program's own included  [bytes]
  double disk = 0.0;           ///< of the result folder at the end  [bytes]
  std::string longest_part;    ///< of the disk: "pictures", "fields", "history.csv"
};

/// The step of a model that is set up; 0: there is none.
struct ModelStep {
  double step = 0.0;  ///< [s]
  std::string rule;   ///< "joints"
};

/// Packs or meshes at most some hundred elements of each body, sets them up as the case would, and
/// takes some steps of them: well below a second.
/// @param folder  where the files that the case names are; they have been checked
/// @param model   its step is taken in place of that of specimens
/// @throws InputError if not even a specimen can be built
Forecast forecast(const dem::Config& config, const std::string& folder,
                  const ModelStep& model = {});
Forecast forecast(const fdem::Config& config, const std::string& folder,
                  const ModelStep& model = {});
Forecast forecast(const fdem3::Config& config, const std::string& folder,
                  const ModelStep& model = {});
Forecast forecast(const coupled::Config& config, const std::string& folder,
                  const ModelStep& model = {});

/// "12 s", "3.5 min", "2.1 h", "4 days".
std::string rough_duration(double seconds);

}  // namespace breccia
