#pragma once
// The DEM as the outer loop runs it.

#include <memory>

#include "dem/world.hpp"
#include "domain/communicator.hpp"
#include "run/method/method.hpp"

namespace breccia {

/// @param ranks  those that share the work; null: none. Every rank makes the method alike.
/// @throws InputError if model and case do not fit
std::unique_ptr<Method> make_method(const dem::Config& config, const dem::Model& model,
                                    const Exec& exec, Communicator* ranks = nullptr);

/// The method with the world that it steps, on ranks its part: for a run that couples it to
/// another.
struct DemPart {
  std::unique_ptr<Method> method;
  dem::World* world;
};
DemPart dem_part(const dem::Config& config, const dem::Model& model, const Exec& exec,
                 Communicator* ranks);

/// Elements as spheres with velocity, spin, group and damage; links as lines with kind, state and
/// force.
/// Of a rank's part of a world, that part of the frame: all ranks make it at once.
FramePart dem_frame(const dem::World& w);

}  // namespace breccia
