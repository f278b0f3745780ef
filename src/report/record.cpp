#include "report/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "exec/error.hpp"
#include "exec/no_memory.hpp"
#include "io/json.hpp"
#include "io/vtu/vtu_reader.hpp"
#include "io/whole_file.hpp"

namespace breccia::report {
namespace {

namespace fs = std::filesystem;

void flatten(const Json& json, const std::string& path, Record& record) {
  if (json.is_object()) {
    for (const auto& [key, value] : json.items())
      flatten(value, path.empty() ? key : path + "." + key, record);
  } else if (json.is_number()) {
    record.numbers[path] = json.get<double>();
  } else if (json.is_string()) {
    record.texts[path] = json.get<std::string>();
  }
}

void read_summary(const std::string& path, Record& record) {
  const NeedsMemory scope;
  const Json json = read_json(read_whole_file(path));
  if (!json.is_object())
    throw InputError(path + ": this is no summary of a run: it is damaged, or not JSON");
  record.summary = json_text(json);
  flatten(json, "", record);
}

/// Messages of lines that warn or tell of an error, the first of many and how many more there are;
/// a damaged line is passed over.
std::vector<std::string> warnings_of(const std::string& path) {
  constexpr std::size_t most = 50;
  std::vector<std::string> warnings;
  std::size_t more = 0;
  const std::string log = read_whole_file(path);
  for (std::size_t begin = 0; begin < log.size();) {
    const std::size_t end = std::min(log.find('\n', begin), log.size());
    const Json line = read_json(log.substr(begin, end - begin));
    begin = end + 1;
    if (!line.is_object()) continue;
    const auto word = [&](const char* key) {
      return line.contains(key) && line[key].is_string() ? line[key].get<std::string>() : "";
    };
    const std::string level = word("level");
    if (level == "info" || level == "debug" || word("message").empty()) continue;
    if (warnings.size() < most)
      warnings.push_back(level + ": " + word("message"));
    else
      ++more;
  }
  if (more > 0) warnings.push_back(std::to_string(more) + " more: see log.jsonl");
  return warnings;
}

}  // namespace

std::string Record::text(const std::string& path) const {
  const auto found = texts.find(path);
  return found == texts.end() ? "" : found->second;
}

std::optional<double> Record::number(const std::string& path) const {
  const auto found = numbers.find(path);
  if (found == numbers.end()) return std::nullopt;
  return found->second;
}

namespace {

/// Tables of more than this are left alone: reading would take longer than a person waits.
constexpr std::uintmax_t largest_table = 100'000'000;

/// Bonds that have parted, by time. A cut before the start has the time 0 and is left out.
std::vector<Break> breaks_in(const NumberTable& broken) {
  const Column *const time = broken.column("time"), *const kind = broken.column("kind");
  const Column *const x = broken.column("x"), *const y = broken.column("y"),
                      *const z = broken.column("z");
  const bool placed = x != nullptr && y != nullptr && z != nullptr;
  std::vector<Break> breaks;
  for (std::size_t i = 0; time != nullptr && i < broken.rows(); ++i)
    if (time->values[i] > 0.0 && std::isfinite(time->values[i])) {
      const bool told = kind != nullptr && kind->values[i] > 0.0;
      breaks.push_back(
          {time->values[i], told ? static_cast<std::size_t>(std::min(kind->values[i], 99.0)) : 0,
           placed ? std::optional(Vec3{x->values[i], y->values[i], z->values[i]}) : std::nullopt});
    }
  std::stable_sort(breaks.begin(), breaks.end(),
                   [](const Break& a, const Break& b) { return a.time < b.time; });
  return breaks;
}

}  // namespace

Record read_record(const std::string& folder) {
  std::error_code error;
  if (!fs::exists(folder, error))
    throw IoError(folder + ": cannot be read: there is no such folder");
  if (!fs::is_directory(folder, error))
    throw InputError(folder + ": this is no folder; report takes the result folder of a run");
  const auto file = [&](const char* name) { return folder + "/" + name; };
  const auto has = [&](const char* name) { return fs::exists(file(name), error); };
  if (!has("summary.json"))
    throw InputError(fmt::format(
        "{}: this folder holds no run (there is no summary.json){}", folder,
        has("case.toml") ? "\n  it holds a case: 'breccia run' makes a result of it" : ""));
  Record record;
  record.folder = folder;
  read_summary(file("summary.json"), record);
  if (has("case.toml")) record.case_text = read_whole_file(file("case.toml"));
  record.scene = scene_of(record.case_text);
  if (has("history.csv")) record.history = read_table(file("history.csv"));
  if (has("cracks.csv")) record.cracks = read_table(file("cracks.csv"));
  record.breaks = breaks_in(record.cracks);
  if (const std::string links = file("broken_links.csv");
      has("broken_links.csv") && fs::file_size(links, error) <= largest_table)
    record.breaks = breaks_in(read_table(links));
  if (has("fragments.csv")) record.fragments = read_table(file("fragments.csv"));
  if (has("log.jsonl")) record.warnings = warnings_of(file("log.jsonl"));
  if (holds_frames(folder)) record.times = frame_times(folder);
  return record;
}

}  // namespace breccia::report
