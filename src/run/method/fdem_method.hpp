#pragma once
// The FDEM as the outer loop runs it.

#include <memory>

#include "domain/communicator.hpp"
#include "fdem/world.hpp"
#include "run/method/method.hpp"

namespace breccia {

/// @param ranks  those that share the work; null: none. Every rank makes the method alike.
/// @throws InputError if model and case do not fit
std::unique_ptr<Method> make_method(const fdem::Config& config, const fdem::Model& model,
                                    const Exec& exec, Communicator* ranks = nullptr);

/// Triangles with stress, damage, body, material and fragment; softened and broken joints as lines
/// with mode, damage, time of break, opening and slip.
/// Of a rank's part of a world, that part of the frame: all ranks make it at once.
/// @param mesh  on rank 0 of several: a whole world, for what does not change
FramePart fdem_frame(fdem::World& w, const fdem::World* mesh = nullptr);

}  // namespace breccia
