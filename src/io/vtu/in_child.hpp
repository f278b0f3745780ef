#pragma once
// Work that a library may not survive, done in a process of its own.

#include <functional>
#include <optional>
#include <string>

namespace breccia {

/// @param work  may read all memory of this process, and changes none of it
/// @returns what it returned; none if it ended by a signal or took more than a minute of processor
///          time. Where no process can be started it is done in this one.
std::optional<std::string> answer_of_child(const std::function<std::string()>& work);

}  // namespace breccia
