// breccia info FILE: what a checkpoint, a model or a result folder holds.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/findings.hpp"
#include "exec/error.hpp"
#include "io/case/key_pages.hpp"
#include "io/checkpoint.hpp"
#include "io/harmless.hpp"
#include "io/json.hpp"
#include "io/picture/png_notes.hpp"
#include "io/round_numbers.hpp"
#include "io/vtu/vtu_reader.hpp"
#include "io/whole_file.hpp"
#include "report/table.hpp"
#include "run/results/checkpoints.hpp"
#include "run/results/picture_notes.hpp"
#include "run/results/result_folder.hpp"

namespace breccia::app {
namespace {

namespace fs = std::filesystem;

/// Prints what files say, which must not steer the terminal.
template <class... Values>
void print_harmless(fmt::format_string<Values...> form, Values&&... values) {
  fmt::print("{}", harmless(fmt::format(form, std::forward<Values>(values)...)));
}

void describe_state(const std::string& path) {
  const CheckpointReader reader(path);
  print_harmless("{}\n", path);
  if (reader.has("run.case_name"))
    print_harmless("  a state of case {} ({}, {} precision), step {}, {}\n",
                   reader.text("run.case_name"), reader.text("run.method"),
                   reader.has("run.precision") ? reader.text("run.precision") : "double",
                   count_text(static_cast<double>(reader.value<std::int64_t>("run.step"))),
                   time_text(reader.value<double>("run.time")));
  if (reader.has("case.name")) print_harmless("  the model of case {}\n", reader.text("case.name"));
  print_harmless("  {:<32} {:>12} {:>12}\n", "section", "items", "bytes");
  for (const CheckpointReader::Section& section : reader.sections())
    print_harmless("  {:<32} {:>12} {:>12}\n", section.name, section.count, section.bytes.size());
}

/// A summary as text for people.
class Told {
 public:
  explicit Told(const std::string& path) : json_(read_json(read_whole_file(path))) {
    if (!json_.is_object())
      throw InputError(path + ": this is no summary of a run: it is damaged, or not JSON");
  }

  std::string text(const char* path) const {
    const Json* const found = find(path);
    return found != nullptr && found->is_string() ? found->get<std::string>() : "";
  }
  double number(const char* path) const {
    const Json* const found = find(path);
    return found != nullptr && found->is_number() ? found->get<double>() : 0.0;
  }
  /// "1 of 2 checks passed"; empty without checks.
  std::string checks() const {
    const Json* const all = find("/checks");
    if (all == nullptr || !all->is_array() || all->empty()) return "";
    const auto passed = std::count_if(all->begin(), all->end(), [](const Json& check) {
      return check.is_object() && check.contains("pass") && check["pass"] == true;
    });
    return fmt::format("{} of {} passed", passed, all->size());
  }
  /// "1,500 elements, 8,364 links"
  std::string model() const {
    std::vector<std::string> parts;
    for (const char* kind : {"elements", "links", "triangles", "tetrahedra", "joints"})
      if (const double count = number(fmt::format("/model/{}", kind).c_str()); count > 0.0)
        parts.push_back(count_text(count) + ' ' + kind);
    return fmt::format("{}", fmt::join(parts, ", "));
  }

 private:
  const Json* find(const char* path) const {
    const Json::json_pointer at(path);
    return json_.contains(at) ? &json_.at(at) : nullptr;
  }
  Json json_;
};

void tell(const char* head, const std::string& text) {
  if (text.empty()) return;
  for (const std::string& line : wrapped(harmless(text), 70)) {
    fmt::print("{:<7} {}\n", head, line);
    head = "";
  }
}

/// How far the history of a run that has not ended goes beyond its summary; empty: no farther.
std::string told_since(const std::string& path, const Told& told) {
  const std::string file = path + "/history.csv";
  if (!fs::exists(file)) return "";
  const report::NumberTable history = report::read_table(file);
  const report::Column* const step = history.column("step");
  const report::Column* const time = history.column("time");
  if (step == nullptr || time == nullptr || history.rows() == 0) return "";
  if (!(step->values.back() > told.number("/steps"))) return "";
  return fmt::format(
      "these numbers are of step {}; {} goes on to step {}, {}. What broke is told when the run "
      "has ended",
      count_text(told.number("/steps")), file, count_text(step->values.back()),
      time_text(time->values.back()));
}

void describe_folder(const std::string& path) {
  const std::string summary = path + "/summary.json";
  if (!fs::exists(summary))
    throw InputError(path + ": this folder holds no run (there is no summary.json)" +
                     (fs::exists(path + "/sweep.csv") ? "; of a sweep read sweep.md"
                      : fs::exists(path + "/../summary.json")
                          ? "; it is a part of one, which is the folder above it"
                          : ""));
  const Told told(summary);
  const bool unfinished = told.text("/status") == "running";
  if (unfinished && !ResultFolder::is_locked(path))
    print_harmless(
        "{}: killed; nothing runs in this folder any more, go on with: breccia resume {}\n", path,
        path);
  else
    print_harmless("{}: {}{}\n", path, told.text("/status"),
                   told.text("/message").empty() ? "" : ", " + told.text("/message"));
  tell("case", fmt::format("{}, {}, seed {:.0f}", told.text("/case/name"), told.text("/method"),
                           told.number("/case/seed")));
  tell("model", told.model());
  tell("run", fmt::format("{} in {} steps, {} of wall-clock time on {} x{}",
                          time_text(told.number("/time")), count_text(told.number("/steps")),
                          time_text(told.number("/wall_s/total")), told.text("/machine/device"),
                          count_text(told.number("/machine/threads"))));
  tell("energy", fmt::format("{:.2g} % is missing from the ledger",
                             100.0 * told.number("/energy/error_relative")));
  const std::string since = unfinished ? told_since(path, told) : "";
  if (since.empty())
    tell_findings(path);
  else
    tell("since", since);
  tell("checks", told.checks());
  tell("hash", told.text("/state_hash"));
  tell("program",
       fmt::format("breccia {} {}", told.text("/breccia/version"), told.text("/breccia/commit")));
  if (holds_frames(path)) {
    const std::vector<double> times = frame_times(path);
    if (!times.empty())
      tell("frames", fmt::format("{}, from {} to {}", times.size(), time_text(times.front()),
                                 time_text(times.back())));
  }
  for (const CheckpointFile& file : list_checkpoints(path + "/checkpoints"))
    print_harmless("{:<7} {}, step {}\n", "state", file.path,
                   count_text(static_cast<double>(file.step)));
  tell("all", summary);
}

/// Contacts of elements that no link joins.
void describe_contacts(const Frame& frame) {
  const auto on_walls = std::count_if(frame.contacts.begin(), frame.contacts.end(),
                                      [](const FrameContact& contact) { return contact.b < 0; });
  print_harmless("  {} contacts without links, {} of them with walls\n",
                 count_text(static_cast<double>(frame.contacts.size())),
                 count_text(static_cast<double>(on_walls)));
  if (frame.contacts.empty()) return;
  double low = norm(frame.contacts.front().force), high = low;
  for (const FrameContact& contact : frame.contacts) {
    low = std::min(low, norm(contact.force));
    high = std::max(high, norm(contact.force));
  }
  print_harmless("    {:<24} {:<8} {:.4g} to {:.4g}\n", "force",
                 frame.tetrahedra.empty() && !frame.triangles.empty() ? "N/m" : "N", low, high);
}

/// A file of a frame: what the whole frame holds.
void describe_frame(const std::string& path) {
  const fs::path file(path);
  const fs::path above = (file.parent_path() / "..").lexically_normal();
  const std::string folder = (above.has_filename() ? above : above.parent_path()).string();
  const std::string stem = file.stem().string();
  const std::size_t digits = stem.find_last_not_of("0123456789");
  if (!fs::exists(file)) throw IoError(path + ": cannot be read: there is no such file");
  if (digits == std::string::npos || digits + 1 == stem.size() || !holds_frames(folder))
    throw InputError(path + ": this is no file of a frame in the folder of a run");
  const int number = static_cast<int>(std::strtol(stem.c_str() + digits + 1, nullptr, 10));
  Frame frame = read_frame(folder, number);
  print_harmless("{}: of the frame at {}, step {}\n", path, time_text(frame.time),
                 count_text(static_cast<double>(frame.step)));
  if (stem.starts_with("contacts_") || stem.starts_with("joint_contacts_")) {
    add_contacts_of(folder, number, frame);
    return describe_contacts(frame);
  }
  const auto tell_items = [](const char* kind, std::size_t count,
                             const std::vector<FrameField>& fields) {
    if (count == 0) return;
    print_harmless("  {} {}\n", count_text(static_cast<double>(count)), kind);
    for (const FrameField& field : fields) {
      if (field.values.empty()) continue;
      const auto [low, high] = std::minmax_element(field.values.begin(), field.values.end());
      print_harmless(
          "    {:<24} {:<8} {:.4g} to {:.4g}\n",
          field.name + (field.components == 1 ? "" : fmt::format("[{}]", field.components)),
          field.unit, *low, *high);
    }
  };
  const bool solid = !frame.tetrahedra.empty(), plane = !solid && !frame.triangles.empty();
  tell_items(solid || plane ? "corners" : "spheres", frame.position.size(), frame.point_fields);
  tell_items(plane ? "joints" : "links", frame.lines.size() / 2, frame.line_fields);
  tell_items(solid ? "joints" : "triangles", frame.triangles.size() / 3, frame.triangle_fields);
  tell_items("tetrahedra", frame.tetrahedra.size() / 4, frame.tetrahedron_fields);
}

void describe_table(const std::string& path) {
  const std::string text = read_whole_file(path);
  const std::size_t names_end = text.find('\n');
  const std::size_t units_end = text.find('\n', names_end + 1);
  if (units_end == std::string::npos) throw InputError(path + ": this is no history of a run");
  const auto lines = std::count(text.begin(), text.end(), '\n');
  print_harmless("{}\n  {} rows\n  columns: {}\n  units:   {}\n", path, lines - 2,
                 text.substr(0, names_end), text.substr(names_end + 1, units_end - names_end - 1));
}

/// A picture of a run, by the texts in it.
void describe_picture(const std::string& path) {
  const std::vector<PngNote> notes = notes_of(read_whole_file(path), path);
  if (note(notes, "Software").empty())
    throw InputError(path + ": this picture holds no text of Breccia");
  print_harmless("{}: a picture by {}\n", path, note(notes, "Software"));
  tell("case", fmt::format("{}, seed {}", note(notes, "Case"), note(notes, "Seed")));
  if (note(notes, "Pictures").empty()) {
    const PictureRecipe recipe = recipe_of(notes, path);
    tell("shows", fmt::format("{}, step {}", time_text(recipe.moment.time),
                              count_text(static_cast<double>(recipe.moment.step))));
    if (recipe.moment.hash) tell("hash", fmt::format("{:016x}", *recipe.moment.hash));
  }
  tell("runs", note(notes, "Runs"));
  tell("again", "breccia verify " + path);
}

void describe(const std::string& path) {
  if (fs::is_directory(path)) return describe_folder(path);
  const std::string kind = fs::path(path).extension().string();
  if (kind == ".csv") return describe_table(path);
  if (kind == ".vtu" || kind == ".hdf") return describe_frame(path);
  if (kind == ".png") return describe_picture(path);
  for (const char* const shown : {".svg", ".pdf", ".mp4", ".webm", ".gif"})
    if (kind == shown)
      throw InputError(path + ": a drawing or film; breccia verify makes it again and compares");
  if (kind == ".json" || kind == ".toml") {
    print_harmless("{}", read_whole_file(path));
    return;
  }
  describe_state(path);
}

}  // namespace

void add_info(CLI::App& program) {
  const auto path = std::make_shared<std::string>();
  CLI::App* const command = program.add_subcommand(
      "info", "what a result folder, a frame, a picture, a checkpoint or a model holds");
  command->add_option("FILE", *path, "a file a run left, or its folder")->required();
  command->callback([path] { describe(*path); });
}

}  // namespace breccia::app
