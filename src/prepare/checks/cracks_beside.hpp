#pragma once
// Discontinuities and sets of joints that lie beside every body.

#include <string>
#include <vector>

#include "prepare/checks/outlines.hpp"

namespace breccia::prepare {

/// The problem of a discontinuity no part of which can meet a body; empty: one may.
std::string problem_of_discontinuity(const fdem::DiscontinuityConfig& d,
                                     const std::vector<Outline>& outlines);
std::string problem_of_discontinuity(const fdem3::DiscontinuityConfig& d,
                                     const std::vector<Outline>& outlines);

/// The problem of a set of joints that meets no body; empty: it may meet one, or its file is bad.
/// @param folder  of the case; null: files are not looked at
std::string problem_of_set(const fdem::JointSetConfig& set, const std::string* folder,
                           const std::vector<Outline>& outlines);
std::string problem_of_set(const fdem3::JointSetConfig& set, const std::string* folder,
                           const std::vector<Outline>& outlines);

}  // namespace breccia::prepare
