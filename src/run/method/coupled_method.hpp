#pragma once
// Spheres and tetrahedra in one run, as the outer loop runs them.

#include <memory>

#include "coupled/setup/model.hpp"
#include "coupled/world.hpp"
#include "domain/communicator.hpp"
#include "run/method/method.hpp"

namespace breccia {

/// @throws InputError if model and case do not fit, or it shall run on ranks
std::unique_ptr<Method> make_method(const coupled::Config& config, const coupled::Model& model,
                                    const Exec& exec, Communicator* ranks = nullptr);

}  // namespace breccia
