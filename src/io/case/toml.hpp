#pragma once
// The parser of case files.

// Text such as "[[[a]]]" meets an assertion of toml++ 3.3 before it is reported as an error; a
// wrong case must not end the program.
#define TOML_ASSERT(condition) static_cast<void>(0)
#include <toml++/toml.h>
