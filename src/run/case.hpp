#pragma once
// A case as the commands use it: read, checked, completed and named, whatever its method.

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coupled/setup/config.hpp"
#include "coupled/setup/model.hpp"
#include "dem/setup/config.hpp"
#include "dem/setup/model.hpp"
#include "domain/communicator.hpp"
#include "exec/error.hpp"
#include "exec/space.hpp"
#include "fdem/setup/config.hpp"
#include "fdem/setup/model.hpp"
#include "fdem3/setup/config.hpp"
#include "fdem3/setup/model.hpp"
#include "io/case/case_file.hpp"
#include "io/checkpoint.hpp"
#include "run/method/method.hpp"

namespace breccia {

struct RunPlan;

using AnyConfig = std::variant<dem::Config, fdem::Config, fdem3::Config, coupled::Config>;
using AnyModel = std::variant<dem::Model, fdem::Model, fdem3::Model, coupled::Model>;

struct Case {
  AnyConfig config;
  std::string name;
  std::string text;                ///< completed: every key with the value used
  std::string digest;              ///< of text
  std::string folder;              ///< where files that the case names are
  std::string file;                ///< that it was read from; empty: a prepared model
  std::vector<std::string> notes;  ///< what a case may not mean: for check and run
  /// Of what decides the states of a run: the case without its end, output, checkpoints and checks.
  std::string model_digest;
  std::optional<AnyModel> model;  ///< if it was prepared
  std::string prepared;           ///< the file of that model

  const CaseConfig& common() const;
};

/// Whether a case asks for two methods in one run.
/// @throws InputError if the file cannot be read or is no TOML, or an override makes no sense
template <class Source>
bool asks_for_two_methods(const Source& source, const std::vector<std::string>& overrides) {
  CaseReader reader(source, overrides);
  std::vector<std::string> methods;
  reader.read("method", methods, "");
  return !methods.empty();
}

/// Reads a case file, the case.toml of a folder, or a prepared model (*.br).
/// @param overrides  KEY=VALUE, applied after reading
/// @throws InputError with every problem at once, IoError if it cannot be read, CheckpointError if
/// a
///         prepared model is damaged
Case load_case(const std::string& path, const std::vector<std::string>& overrides);

/// Reads a case from its text.
/// @param name    of the case; messages name it as their file
/// @param folder  where files that the case names are
/// @throws InputError with every problem at once
Case case_of_text(const std::string& text, const std::string& name, const std::string& folder,
                  const std::vector<std::string>& overrides);

/// Reads the files that the case names, as building its model would.
/// @throws InputError or IoError with every problem at once
void check_files(const Case& read);

/// Calls `work`, whose messages about the case then name its file and lines.
template <class Work>
auto located(const Case& read, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    if (read.file.empty()) throw;
    throw InputError(with_lines(error.what(), read.file));
  } catch (const IoError& error) {
    if (read.file.empty()) throw;
    throw IoError(with_lines(error.what(), read.file));
  }
}

/// The files of a case that are programs: gmsh runs a .geo file, which may write files and start
/// others. None if the model was prepared.
std::vector<std::string> scripts_of(const Case& read);
/// The text of `--allow-scripts` in the help of the commands that build models.
inline constexpr const char* allow_scripts_help =
    "let gmsh run the .geo files of the case, which may do whatever you may; only for cases you "
    "trust";
/// @throws InputError naming them
void refuse_scripts(const Case& read);

/// Takes the model of a case from where it was prepared.
/// @throws InputError if the file holds the model of another case, IoError if it cannot be read,
/// CheckpointError if it is damaged
void take_prepared(Case& read, const std::string& path);

/// The case's method over its model: the prepared one, or built now.
/// @param ranks  those that share the work; null: none. Every rank calls it alike.
/// @throws InputError if the model cannot be built, or does not fit
std::unique_ptr<Method> make_method(const Case& read, const Exec& exec, Communicator* ranks,
                                    bool quiet = true);

/// The method of a case over its model as `check` and `prepare` look at it: alone, on the host.
/// @throws InputError if the model cannot be built, or does not fit
std::unique_ptr<Method> method_to_look_at(const Case& read);

/// The plan of a run with what the case says; the rest of it as it is by default.
RunPlan plan_of(const Case& read);

/// Builds the model and adds it to a file. Returns a few words about its size.
std::string save_model_of(const Case& read, CheckpointWriter& writer, const Exec& how = {});

}  // namespace breccia
