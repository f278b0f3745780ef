#pragma once
// A method that does some of its steps twice and compares the bits: silent errors of a machine.

#include <memory>

#include "core/case_config.hpp"
#include "domain/together.hpp"
#include "run/method/method.hpp"

namespace breccia {

/// Every method has the same bits whenever it does the same steps, so two results differ only if
/// memory, a processor or the program has failed. Before a step that is drawn at random the state
/// is kept; the step is done, undone and done again, and all that a checkpoint holds is compared.
/// Arrays that no step changes are compared with those of the start, and where two steps in
/// succession are repeated, the state that one has left with the state that the other finds. An
/// error in another step is not found: the chance of that is the share of steps that are repeated,
/// so a machine that fails often is found soon, and with `every` = 1 each error that reaches the
/// state.
/// @param audit  how rare; `every` = 0: returns the method itself
/// @param seed   of the case
/// @param ranks  null: alone
std::unique_ptr<Method> audited(std::unique_ptr<Method> method, const AuditConfig& audit,
                                std::int64_t seed, Communicator* ranks);

}  // namespace breccia
