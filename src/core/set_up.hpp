#pragma once
// For set-up and for the begin of a stage: the key to writing what a case gives.

#include "core/read_only.hpp"

namespace breccia {

struct SetUp {};

}  // namespace breccia
