#pragma once
// The built-in benchmarks: fixed work whose speed is measured on the machine at hand.

#include <iosfwd>
#include <string>
#include <vector>

#include "exec/space.hpp"

namespace breccia {

/// A number a benchmark measured: over several windows of equal work, or once.
struct Measurement {
  std::string part;  ///< of the benchmark: "scene", "before impact", ...
  std::string name;  ///< "ns_per_link_step", ...
  std::string unit;
  double median, least, most;  ///< over the windows; all equal if there is only one
  std::string text = {};       ///< instead of the numbers: a hash
};

/// The slab of Durand et al. 2012, section 5: whole steps before and during the impact, by stage;
/// memory an element. 14,274 elements.
std::vector<Measurement> measure_slab(const Exec& exec);
/// The slab 2.7 times as long and wide: 99,262 elements.
std::vector<Measurement> measure_large_slab(const Exec& exec);
/// Many of the paper's slabs side by side, during the impact: 100,000 to 1 million elements, on a
/// GPU to 10 million.
std::vector<Measurement> measure_slabs(const Exec& exec);
/// As many slabs as an H200 holds: 62.8 million elements, 105 steps. Nothing on a host.
std::vector<Measurement> measure_most_slabs(const Exec& exec);
/// The slab on one thread and on all threads of `exec`, in alternating windows.
std::vector<Measurement> measure_threads(const Exec& exec);
/// The search alone, on random spheres at the density of a packing.
std::vector<Measurement> measure_search(const Exec& exec);
/// The search when elements of the slab fly apart and its bounding box grows a thousandfold.
std::vector<Measurement> measure_burst(const Exec& exec);
/// Packings of a box at the compactness of the slab.
std::vector<Measurement> measure_packing(const Exec& exec);

/// Whole steps of the cube of cases/ldpm_cube: elastic, while tension cracks it, and while it is
/// crushed; with the hash at the end of each.
std::vector<Measurement> measure_facets(const Exec& exec);

/// Whole FDEM steps of plates of 10^4 to 10^6 joined triangles, by stage.
std::vector<Measurement> measure_triangles(const Exec& exec);
/// Whole FDEM steps of a plate of 50 million triangles. Nothing on a host.
std::vector<Measurement> measure_largest_plate(const Exec& exec);
/// Whole FDEM steps of 8,000 hexagons that fly together, from far apart to pressed together.
std::vector<Measurement> measure_contact(const Exec& exec);
/// Bodies near each other, as many as in cases/moving_box, and on a GPU a hundred times as many.
std::vector<Measurement> measure_heap(const Exec& exec);

/// Time of each kernel on a GPU and the share of the copy's speed at which it moves its bytes.
/// Nothing on a host.
std::vector<Measurement> measure_roofline(const Exec& exec);

/// Runs the slab as told line by line, so that another program can be measured in alternating
/// windows. Each line is answered by one line of JSON.
///
///   steps N          N whole steps: {"seconds", "processor_seconds", "steps", "time", ...}
///   until T          steps until the simulated time T in s: the same
///   export FOLDER    elements.csv and links.csv in that folder: {"elements", "links", "dt", ...}
///
/// @throws InputError for any other line
void pace_slab(std::istream& commands, std::ostream& answers, const Exec& exec);

/// The machine, its threads and all measurements, for --json.
std::string benchmark_json(const std::vector<std::pair<std::string, std::vector<Measurement>>>& all,
                           const Exec& exec, const std::string& device);
/// A table for a terminal.
std::string benchmark_table(const std::string& name, const std::vector<Measurement>& measurements);

}  // namespace breccia
