#pragma once
// The FDEM in three dimensions as the outer loop runs it.

#include <memory>

#include "domain/communicator.hpp"
#include "fdem3/world.hpp"
#include "run/method/method.hpp"

namespace breccia {

/// @param ranks  those that share the work; null: none. Every rank makes the method alike.
/// @throws InputError if model and case do not fit
std::unique_ptr<Method> make_method(const fdem3::Config& config, const fdem3::Model& model,
                                    const Exec& exec, Communicator* ranks = nullptr);

/// As DemPart.
struct Fdem3Part {
  std::unique_ptr<Method> method;
  fdem3::World* world;
};
Fdem3Part fdem3_part(const fdem3::Config& config, const fdem3::Model& model, const Exec& exec,
                     Communicator* ranks);

/// Tetrahedra with stress, damage, body, material and fragment; softened and broken joints as
/// triangles with mode, damage, time of break, opening and slip.
/// Of a rank's part of a world, that part of the frame: all ranks make it at once.
/// @param mesh  on rank 0 of several: a whole world, for what does not change
FramePart fdem3_frame(fdem3::World& w, const fdem3::World* mesh = nullptr);

}  // namespace breccia
