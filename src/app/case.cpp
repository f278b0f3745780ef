#include "app/case.hpp"

#include <filesystem>

#include "exec/error.hpp"
#include "io/case_file.hpp"
#include "io/whole_file.hpp"
#include "prepare/check_case.hpp"

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

}  // namespace

Case load_case(const std::string& path, const std::vector<std::string>& overrides) {
  refuse_unreadable(path);
  Case loaded;
  loaded.config = read_case<dem::Config>(path, overrides);
  dem::check_case(loaded.config);
  loaded.name = case_name(path);
  loaded.text = completed_case(loaded.config);
  loaded.digest = case_digest(loaded.text);
  loaded.folder = std::filesystem::absolute(case_folder(path)).lexically_normal().string();
  loaded.model_digest = model_digest(loaded.config);
  return loaded;
}

}  // namespace breccia::app
