#pragma once
// A case as the commands use it: read, checked, completed and named.

#include <string>
#include <vector>

#include "dem/config.hpp"

namespace breccia::app {

struct Case {
  dem::Config config;
  std::string name;
  std::string text;    ///< completed: every key with the value used
  std::string digest;  ///< of text
  std::string folder;  ///< where files that the case names are
  /// Of what decides the states of a run: the case without its end, output, checkpoints and checks.
  std::string model_digest;
};

/// Reads a case file, or the case.toml of a folder.
/// @param overrides  KEY=VALUE, applied after reading
/// @throws InputError with every problem at once, IoError if it cannot be read
Case load_case(const std::string& path, const std::vector<std::string>& overrides);

}  // namespace breccia::app
