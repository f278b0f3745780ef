#pragma once
// A case as the commands use it: read, checked, completed and named.

#include <optional>
#include <string>
#include <vector>

#include "dem/config.hpp"
#include "dem/model.hpp"

namespace breccia::app {

struct Case {
  dem::Config config;
  std::string name;
  std::string text;    ///< completed: every key with the value used
  std::string digest;  ///< of text
  std::string folder;  ///< where files that the case names are
  /// Of what decides the states of a run: the case without its end, output, checkpoints and checks.
  std::string model_digest;
  std::optional<dem::Model> model;  ///< if it was prepared
};

/// Reads a case file, the case.toml of a folder, or a prepared model (*.br).
/// @param overrides  KEY=VALUE, applied after reading
/// @throws InputError with every problem at once, IoError if it cannot be read, CheckpointError if
/// a
///         prepared model is damaged
Case load_case(const std::string& path, const std::vector<std::string>& overrides);

/// The model of the case: the prepared one, or built now.
dem::Model model_of(const Case& read);

}  // namespace breccia::app
