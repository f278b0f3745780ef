#include "run/case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "domain/domain.hpp"
#include "domain/mpi_ranks.hpp"
#include "exec/device.hpp"
#include "exec/error.hpp"
#include "io/case/case_source.hpp"
#include "io/case/problems.hpp"
#include "io/round_numbers.hpp"
#include "io/whole_file.hpp"
#include "prepare/build.hpp"
#include "prepare/build_coupled.hpp"
#include "prepare/build_fdem.hpp"
#include "prepare/build_fdem3.hpp"
#include "prepare/checks/check_case.hpp"
#include "prepare/checks/check_in_situ.hpp"
#include "prepare/checks/check_regions.hpp"
#include "prepare/checks/check_stages.hpp"
#include "prepare/checks/check_values.hpp"
#include "prepare/checks/refusal.hpp"
#include "prepare/model_file.hpp"
#include "run/case_keys.hpp"
#include "run/machine/device_plan.hpp"
#include "run/machine/memory_plan.hpp"
#include "run/method/audited_method.hpp"
#include "run/method/coupled_method.hpp"
#include "run/method/dem_method.hpp"
#include "run/method/fdem3_method.hpp"
#include "run/method/fdem_method.hpp"
#include "run/method/shown.hpp"
#include "run/run.hpp"
#include "run/unknown_keys.hpp"

namespace breccia {
namespace {

/// A file that cannot be read is no fault of what is in it. @throws IoError with path and reason
void refuse_unreadable(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path file = fs::is_directory(path) ? fs::path(path) / "case.toml" : fs::path(path);
  if (fs::exists(file) && !fs::is_regular_file(file))
    throw IoError(file.string() + ": cannot read: it is not a file");
  read_whole_file(file.string());
}

template <class Config>
std::string model_digest(Config config) {
  config.title.clear();
  config.time.end = TimeConfig{}.end;
  config.output = {};
  config.checkpoint = {};
  config.domain = {};
  config.energy = {};
  config.audit = {};
  config.probes.clear();
  config.checks.clear();
  return case_digest(without_comments(completed_case(config)));  // words may change
}

/// Fills in what follows from the configuration.
Case completed(Case read) {
  std::visit(
      [&](auto& config) {
        located(read, [&] {
          prepare::refuse_all(
              "in the case",
              [&] { prepare::refuse(prepare::put_ends_in_si(config), "in the case"); },
              [&] { check_case(config); }, [&] { prepare::check_regions(config); });
          check_shown(config);
        });
        for (const std::string& doubt : prepare::doubtful_times(config))
          read.notes.push_back(read.file.empty() ? doubt : with_lines(doubt, read.file));
        read.text = completed_case(config);
        read.model_digest = model_digest(config);
      },
      read.config);
  read.digest = case_digest(read.text);
  return read;
}

/// The keys that a model was built from, and their values.
std::string model_keys(const dem::Config& config) {
  dem::Config part;
  part.seed = config.seed;
  part.materials = config.materials;
  part.bodies = config.bodies;
  part.links = config.links;
  for (const dem::WallConfig& wall : config.walls)
    if (wall.shape == "stl") {  // the rest of a wall is not in the model
      part.walls.emplace_back().name = wall.name;
      part.walls.back().file = wall.file;
      part.walls.back().file_unit = wall.file_unit;
    }
  return completed_case(part);
}
std::string model_keys(const fdem::Config& config) {
  fdem::Config part;
  part.seed = config.seed;
  part.materials = config.materials;
  part.joint_laws = config.joint_laws;
  part.bodies = config.bodies;
  part.discontinuities = config.discontinuities;
  part.joint_sets = config.joint_sets;
  return completed_case(part);
}
std::string model_keys(const fdem3::Config& config) {
  fdem3::Config part;
  part.seed = config.seed;
  part.materials = config.materials;
  part.joint_laws = config.joint_laws;
  part.bodies = config.bodies;
  part.discontinuities = config.discontinuities;
  part.joint_sets = config.joint_sets;
  return completed_case(part);
}

std::string model_keys(const coupled::Config& config) {
  const coupled::Parts parts = coupled::parts_of(config);
  return model_keys(parts.spheres) + model_keys(parts.tetrahedra);
}

CaseText text_of(const std::string& path) {
  return {read_case_source(case_file_of(path)), case_file_of(path)};
}
const CaseText& text_of(const CaseText& text) {
  return text;
}
std::uint32_t line_in(const std::string& path, const std::string& sentence) {
  return line_of_sentence(sentence, path);
}
std::uint32_t line_in(const CaseText&, const std::string&) {
  return 0;
}

/// Whether a problem takes a table or a name away that others may refer to.
bool takes_a_name(const std::string& problem) {
  const std::string key = problem.substr(0, problem.find(' '));
  return key.find('.') == std::string::npos || key.ends_with(".name") ||
         problem.find(" wants a ") < problem.find('\n');
}

/// Of a case with wrong values, what names something that is not there: no value changes that, so
/// all is told at once.
template <class Config, class Source>
std::vector<Problem> lost_names(const Source& source, const std::vector<std::string>& overrides) {
  Config config;
  CaseReader reader(source, overrides);
  config.each_key(ReadKeys{reader});
  std::vector<Problem> lost;
  try {
    check_case(config);
  } catch (const prepare::Refusal& refusal) {
    for (const std::string& problem : refusal.problems)
      if (problem.find("; there are: ") != std::string::npos ||
          problem.find("\" is neither a ") != std::string::npos)
        lost.push_back({line_in(source, problem), problem});
  } catch (const Error&) {  // of a value that is told already
  }
  return lost;
}

template <class Config, class Source>
Config read_all(const Source& source, const std::vector<std::string>& overrides) {
  try {
    return read_case<Config>(source, overrides);
  } catch (CaseError& error) {
    if constexpr (!std::is_same_v<Config, coupled::Config>) {
      std::vector<Problem> told = error.problems;
      for (Problem& problem : told)
        problem = told_of_unknown(std::move(problem), case_method(source, overrides));
      const CaseText& text = text_of(source);
      error = CaseError(std::move(told), text.origin, text.text);
    }
    if (std::any_of(error.problems.begin(), error.problems.end(),
                    [](const Problem& problem) { return takes_a_name(problem.text); }))
      throw;
    std::vector<Problem> all = error.problems;
    for (Problem& lost : lost_names<Config>(source, overrides)) all.push_back(std::move(lost));
    const CaseText& text = text_of(source);
    throw CaseError(std::move(all), text.origin, text.text);
  }
}

/// Refuses a method that does not exist by that problem alone: keys depend on it.
template <class Source>
void refuse_method(const Source& source, const std::vector<std::string>& overrides) {
  try {
    read_case<dem::Config>(source, overrides);
  } catch (const CaseError& error) {
    for (const Problem& problem : error.problems)
      if (problem.text.starts_with("method")) {
        const CaseText& text = text_of(source);
        throw CaseError({problem}, text.origin, text.text);
      }
    throw;
  }
}

template <class Source>
AnyConfig read_config(const Source& source, const std::vector<std::string>& overrides) {
  if (asks_for_two_methods(source, overrides)) return read_all<coupled::Config>(source, overrides);
  const std::string method = case_method(source, overrides);
  if (method != "dem3d" && method != "fdem2d" && method != "fdem3d")
    refuse_method(source, overrides);
  if (method == "fdem2d") return read_all<fdem::Config>(source, overrides);
  if (method == "fdem3d") return read_all<fdem3::Config>(source, overrides);
  return read_all<dem::Config>(source, overrides);
}

template <class Config>
using ModelOf = decltype(build_model(std::declval<const Config&>(), std::string()));

/// The model of a case: the prepared one, or built now and put into `built`.
template <class Config>
const ModelOf<Config>& model_of(const Case& read, const Config& config, const Exec& how,
                                ModelOf<Config>& built) {
  if (read.model) return std::get<ModelOf<Config>>(*read.model);
  try {
    if constexpr (requires { build_model(config, read.folder, how); })
      built = build_model(config, read.folder, how);
    else
      built = build_model(config, read.folder);
    return built;
  } catch (const IoError&) {
    prepare::check_files(config, read.folder);  // names the keys of all that cannot be read
    throw;
  }
}

std::string size_text(const dem::Model& model) {
  std::string text =
      fmt::format("{} elements  {} links", count_text(static_cast<double>(model.size())),
                  count_text(static_cast<double>(model.links.size())));
  for (std::size_t k = 0; k < model.bulk.size(); ++k)
    if (const dem::Model::Bulk& s = model.bulk[k]; s.young > 0.0)
      text += fmt::format("  {} E {:.3g} GPa ({:.3g} as packed)", model.groups[k], 1e-9 * s.young,
                          1e-9 * s.packed_young);
  return text;
}
std::string size_text(const fdem::Model& model) {
  return fmt::format("{} triangles", count_text(static_cast<double>(model.size())));
}
std::string size_text(const fdem3::Model& model) {
  return fmt::format("{} tetrahedra", count_text(static_cast<double>(model.size())));
}

std::string size_text(const coupled::Model& model) {
  return size_text(model.spheres) + "  " + size_text(model.tetrahedra);
}

/// The keys that the model of a case was built from.
std::string keys_of_model(const AnyConfig& config) {
  return std::visit([](const auto& c) { return model_keys(c); }, config);
}

void load_model_into(Case& read, const CheckpointReader& reader, const std::string& path) {
  if (const auto* const config = std::get_if<dem::Config>(&read.config)) {
    const dem::Model& model = std::get<dem::Model>(read.model.emplace(load_model(reader)));
    refuse_misfits(model, *config);
  } else if (const auto* const plane = std::get_if<fdem::Config>(&read.config)) {
    const fdem::Model& model = std::get<fdem::Model>(read.model.emplace(load_fdem_model(reader)));
    refuse_misfits(model, *plane);
  } else if (const auto* const solid = std::get_if<fdem3::Config>(&read.config)) {
    const fdem3::Model& model =
        std::get<fdem3::Model>(read.model.emplace(load_fdem3_model(reader)));
    refuse_misfits(model, *solid);
  } else {
    const coupled::Model& model =
        std::get<coupled::Model>(read.model.emplace(load_coupled_model(reader)));
    const coupled::Parts parts = coupled::parts_of(std::get<coupled::Config>(read.config));
    refuse_misfits(model.spheres, parts.spheres);
    refuse_misfits(model.tetrahedra, parts.tetrahedra);
  }
  read.prepared = std::filesystem::absolute(path).lexically_normal().string();
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
  read.config = read_config(text, overrides);
  if (keys_of_model(read.config) != keys_of_model(read_config(text, {})))
    throw InputError(path +
                     ": --set cannot change the seed, materials, bodies or links of a "
                     "prepared model; nothing was run");
  read.name = reader.text("case.name");
  read.folder = reader.text("case.folder");
  load_model_into(read, reader, path);
  return completed(std::move(read));
}

}  // namespace

Case load_case(const std::string& path, const std::vector<std::string>& overrides) {
  if (path.ends_with(".br") || is_checkpoint(path)) return load_prepared(path, overrides);
  refuse_unreadable(path);
  Case read;
  read.config = read_config(path, overrides);
  read.notes = CaseReader(path, overrides).notes();
  read.file = path;
  read.name = case_name(path);
  read.folder = std::filesystem::absolute(case_folder(path)).lexically_normal().string();
  return completed(std::move(read));
}

Case case_of_text(const std::string& text, const std::string& name, const std::string& folder,
                  const std::vector<std::string>& overrides) {
  Case read;
  read.config = read_config(CaseText{text, name}, overrides);
  read.name = name;
  read.folder = std::filesystem::absolute(folder).lexically_normal().string();
  return completed(std::move(read));
}

std::vector<std::string> scripts_of(const Case& read) {
  std::vector<std::string> files;
  const auto* const config = std::get_if<fdem::Config>(&read.config);
  if (config == nullptr || read.model) return files;
  for (const fdem::BodyConfig& body : config->bodies)
    if (body.shape == "geo") files.push_back(body.file);
  return files;
}

void refuse_scripts(const Case& read) {
  const std::vector<std::string> files = scripts_of(read);
  if (files.empty()) return;
  throw InputError(fmt::format(
      "{}: gmsh runs .geo files ({}), which may write files and start programs; nothing was run\n"
      "  --allow-scripts lets it, for cases you trust; a mesh of it needs no program: gmsh -2 "
      "-format msh41 {}, then shape = \"mesh\"",
      read.name, fmt::join(files, ", "), files.front()));
}

void take_prepared(Case& read, const std::string& path) {
  const CheckpointReader reader(path);
  if (!holds_model(reader) ||
      keys_of_model(read.config) !=
          keys_of_model(read_config(CaseText{reader.text("case.text"), path}, {})))
    throw InputError(
        path +
        ": the run began with a model that was prepared there, and this is another; nothing "
        "was run");
  load_model_into(read, reader, path);
}

const CaseConfig& Case::common() const {
  return std::visit([](const auto& c) -> const CaseConfig& { return c; }, config);
}

void check_files(const Case& read) {
  if (read.model) return;  // all files have been read
  std::visit(
      [&](const auto& config) {
        located(read, [&] {
          prepare::check_files(config, read.folder);
          prepare::check_regions(config, &read.folder);
        });
      },
      read.config);
}

std::unique_ptr<Method> make_method(const Case& read, const Exec& exec, Communicator* ranks,
                                    bool quiet) {
  return std::visit(
      [&](const auto& config) {
        using Model = ModelOf<std::remove_cvref_t<decltype(config)>>;
        Model built;
        const Model* model = nullptr;
        collective_try(ranks, [&] {  // before any of them takes some
          const MemoryPlan plan = memory_plan(config, read.model ? "" : read.folder);
          refuse_without_memory(plan, exec.space == Space::cuda ? plan.host_bytes : plan.run_bytes,
                                ranks_on_this_machine(ranks));
        });
        collective_try(ranks, [&] {
          if (!read.model && exec.space == Space::cuda) await_device();  // building takes longer
          model = located(read, [&] { return &model_of(read, config, exec, built); });
          if (exec.space == Space::cuda)
            plan_device(device_bytes(*model) / (ranks == nullptr ? 1 : ranks->size()),
                        quiet || (ranks != nullptr && ranks->rank() > 0));
        });
        try {
          return audited(located(read, [&] { return make_method(config, *model, exec, ranks); }),
                         config.audit, config.seed, ranks);
        } catch (const NumericsError& error) {
          throw NumericsError(fmt::format("step 0, t = 0 s: {}", error.what()));
        }
      },
      read.config);
}

std::unique_ptr<Method> method_to_look_at(const Case& read) {
  return make_method(read, Exec{}, nullptr);
}

RunPlan plan_of(const Case& read) {
  RunPlan plan;
  plan.config = read.common();
  plan.case_name = read.name;
  plan.case_text = read.text;
  plan.case_digest = read.digest;
  plan.case_folder = read.folder;
  plan.warnings = read.notes;
  std::visit(
      [&](const auto& config) {
        const auto warn = [&](const std::vector<std::string>& doubts) {
          for (const std::string& doubt : doubts)
            plan.warnings.push_back(read.file.empty() ? doubt : with_lines(doubt, read.file));
        };
        if constexpr (requires { prepare::doubtful_probes(config, read.folder); })
          warn(prepare::doubtful_probes(config, read.folder));
        if constexpr (requires { prepare::doubtful_in_situ(config, read.folder); })
          warn(prepare::doubtful_in_situ(config, read.folder));
        warn(prepare::doubtful_values(config, read.folder));
      },
      read.config);
  plan.prepared = read.prepared;
  plan.model_digest = read.model_digest;
  return plan;
}

std::string save_model_of(const Case& read, CheckpointWriter& writer, const Exec& how) {
  return std::visit(
      [&](const auto& config) {
        const MemoryPlan plan = memory_plan(config, read.model ? "" : read.folder);
        refuse_without_memory(plan, plan.build_bytes, 1);
        ModelOf<std::remove_cvref_t<decltype(config)>> built;
        const auto* const model =
            located(read, [&] { return &model_of(read, config, how, built); });
        save_model(writer, *model);
        return size_text(*model);
      },
      read.config);
}

}  // namespace breccia
