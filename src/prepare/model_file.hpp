#pragma once
// A prepared model on disk, with the case it was built from.

#include <string>

#include "dem/setup/config.hpp"
#include "dem/setup/model.hpp"
#include "fdem/setup/config.hpp"
#include "fdem/setup/model.hpp"
#include "fdem3/setup/config.hpp"
#include "fdem3/setup/model.hpp"
#include "io/checkpoint.hpp"

namespace breccia {

/// Adds the model as sections "model.*".
void save_model(CheckpointWriter& writer, const dem::Model& model);
void save_model(CheckpointWriter& writer, const fdem::Model& model);
void save_model(CheckpointWriter& writer, const fdem3::Model& model);

/// Whether the file holds a model rather than the state of a run.
bool holds_model(const CheckpointReader& reader);

/// @throws CheckpointError if a section is missing or the arrays do not fit each other
dem::Model load_model(const CheckpointReader& reader);
fdem::Model load_fdem_model(const CheckpointReader& reader);
fdem3::Model load_fdem3_model(const CheckpointReader& reader);

/// @throws CheckpointError if the model names materials or joints that the case does not have
void refuse_misfits(const dem::Model& model, const dem::Config& config);
void refuse_misfits(const fdem::Model& model, const fdem::Config& config);
void refuse_misfits(const fdem3::Model& model, const fdem3::Config& config);

}  // namespace breccia
