#pragma once
// From a case to a model: bodies are packed, reinforced, ordered in memory and linked.

#include <string>

#include "dem/setup/config.hpp"
#include "dem/setup/model.hpp"
#include "exec/space.hpp"

namespace breccia {

/// The model of a case. A function of the case alone: same seed, same bits.
///
///   elements   each body is a group, in the order of the case. Packed bodies have exactly
///              `pack.count` elements (about, if cut) that fill `pack.compactness` of the body's
///              volume; their density is the material's density over that share, so that the body
///              has the mass of its bulk. Volume taken by bars does not count as the body's. Bars
///              move with the body they reinforce. A file's spheres have the mass of the bulk
///              `volume`, or of the box `size`; grains have their own when neither is given. Bodies
///              that are turned, cut or from an STL file are built upright and whole first
///              (prepare/shapes/carve.hpp).
///   order      element i is global id i; ids follow space, so that linked elements are close in
///              memory.
///   links      pairs of one concrete body, neighbours along a bar, bars and the concrete around
///              them; never between two other bodies; none in bodies of law grain (docs/theory.md,
///              links at the start).
///
/// @param case_folder  where the files named by the case are
/// @param how          its threads share the work: any number gives the same bits
/// @throws InputError  names every body that cannot be built, or that overlaps another one
/// @throws IoError     if a file cannot be read
dem::Model build_model(const dem::Config& config, const std::string& case_folder,
                       const Exec& how = {});

}  // namespace breccia
