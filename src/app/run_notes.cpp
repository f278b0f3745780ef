#include "app/run_notes.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <sstream>

#include "exec/error.hpp"
#include "exec/no_memory.hpp"
#include "io/case/toml.hpp"
#include "io/json.hpp"
#include "io/whole_file.hpp"

namespace breccia::app {
namespace {

/// The text of a file of the folder; empty if it cannot be read.
std::string text_of(const std::string& path) {
  if (!std::filesystem::exists(path)) return {};
  try {
    return read_whole_file(path);
  } catch (const Error&) {
    return {};
  }
}

/// summary.json as far as pictures need it.
struct RunFacts {
  std::string name, version, hash;
  std::int64_t seed = 0, steps = -1;

  explicit RunFacts(const std::string& folder) {
    try {
      const NeedsMemory scope;
      const Json json = read_json(text_of(folder + "/summary.json"));
      name = json.at("case").at("name").get<std::string>();
      seed = json.at("case").at("seed").get<std::int64_t>();
      version = json.at("breccia").at("version").get<std::string>();
      steps = json.at("steps").get<std::int64_t>();
      hash = json.value("state_hash", "");
    } catch (const Json::exception&) {
      *this = RunFacts();
    }
  }

 private:
  RunFacts() = default;
};

/// The hash in "frame 3 at 0.001 s, state 0123456789abcdef".
std::optional<std::uint64_t> hash_in(const std::string& message) {
  constexpr std::string_view before = ", state ";
  const std::size_t at = message.rfind(before);
  if (at == std::string::npos) return {};
  return std::strtoull(message.c_str() + at + before.size(), nullptr, 16);
}

}  // namespace

std::vector<PngNote> run_notes(const std::string& folder) {
  const RunFacts run(folder);
  const std::string text = text_of(folder + "/case.toml");
  if (run.version.empty() || text.empty()) return {};
  std::vector<PngNote> notes = notes_of_case(run.name, text, run.seed);
  notes.front().text = "breccia " + run.version;
  return notes;
}

std::optional<PictureMoment> moment_of_frame(const std::string& folder, int number, double time) {
  std::optional<PictureMoment> moment;
  std::istringstream lines(text_of(folder + "/log.jsonl"));
  const std::string begin = fmt::format("frame {} at ", number);
  for (std::string line; std::getline(lines, line);) {
    const NeedsMemory scope;
    const Json json = read_json(line);
    try {
      if (json.is_object() && json.at("stage") == "frame" &&
          json.at("message").get<std::string>().starts_with(begin))
        moment = {json.at("step").get<std::int64_t>(), time,
                  hash_in(json.at("message").get<std::string>()), number};
    } catch (const Json::exception&) {
      continue;
    }
  }
  const RunFacts run(folder);
  if (moment && !moment->hash && moment->step == run.steps && !run.hash.empty())
    moment->hash = std::strtoull(run.hash.c_str(), nullptr, 16);
  return moment;
}

std::string run_title(const std::string& folder) {
  const std::string text = text_of(folder + "/case.toml");
  try {
    const toml::table file = toml::parse(text);
    if (const std::string title = file["title"].value_or(std::string()); !title.empty())
      return title;
  } catch (const toml::parse_error&) {
    return {};
  }
  return RunFacts(folder).name;
}

std::string run_line(const std::string& folder) {
  const RunFacts run(folder);
  if (run.version.empty()) return "breccia render " + folder;
  return fmt::format("breccia {}, case {}, seed {}, state hash {} at step {}", run.version,
                     run.name, run.seed, run.hash, run.steps);
}

}  // namespace breccia::app
