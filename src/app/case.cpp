#include "app/case.hpp"

#include <filesystem>

#include "exec/error.hpp"
#include "io/case_file.hpp"
#include "io/whole_file.hpp"
#include "prepare/build.hpp"
#include "prepare/check_case.hpp"
#include "prepare/model_file.hpp"

namespace breccia::app {
namespace {

/// A file that cannot be read is no fault of what is in it. @throws IoError with path and reason
void refuse_unreadable(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path file = fs::is_directory(path) ? fs::path(path) / "case.toml" : fs::path(path);
  if (fs::exists(file) && !fs::is_regular_file(file))
    throw IoError(file.string() + ": cannot read: it is not a file");
  read_whole_file(file.string());
}

std::string model_digest(dem::Config config) {
  config.title.clear();
  config.time.end = TimeConfig{}.end;
  config.output = {};
  config.checkpoint = {};
  config.probes.clear();
  config.checks.clear();
  return case_digest(completed_case(config));
}

/// Fills in what follows from the configuration.
Case completed(Case read) {
  dem::check_case(read.config);
  read.text = completed_case(read.config);
  read.digest = case_digest(read.text);
  read.model_digest = model_digest(read.config);
  return read;
}

/// The keys that a model was built from, and their values.
std::string model_keys(const dem::Config& config) {
  dem::Config part;
  part.seed = config.seed;
  part.materials = config.materials;
  part.bodies = config.bodies;
  part.links = config.links;
  return completed_case(part);
}

Case load_prepared(const std::string& path, const std::vector<std::string>& overrides) {
  const CheckpointReader reader(path);
  if (!holds_model(reader))
    throw InputError(path +
                     ": holds the state of a run, not a model; nothing was run\n"
                     "  'breccia run CASE --restart " +
                     path + "' begins from it");
  const CaseText text{reader.text("case.text"), path};
  Case read;
  read.config = read_case<dem::Config>(text, overrides);
  if (model_keys(read.config) != model_keys(read_case<dem::Config>(text, {})))
    throw InputError(path +
                     ": --set cannot change the seed, materials, bodies or links of a "
                     "prepared model; nothing was run");
  read.name = reader.text("case.name");
  read.folder = reader.text("case.folder");
  read.model = load_model(reader);
  return completed(std::move(read));
}

}  // namespace

Case load_case(const std::string& path, const std::vector<std::string>& overrides) {
  if (path.ends_with(".br")) return load_prepared(path, overrides);
  refuse_unreadable(path);
  Case read;
  read.config = read_case<dem::Config>(path, overrides);
  read.name = case_name(path);
  read.folder = std::filesystem::absolute(case_folder(path)).lexically_normal().string();
  return completed(std::move(read));
}

dem::Model model_of(const Case& read) {
  return read.model ? *read.model : build_model(read.config, read.folder);
}

}  // namespace breccia::app
