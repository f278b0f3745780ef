#include "prepare/build_coupled.hpp"

#include "prepare/build.hpp"
#include "prepare/build_fdem3.hpp"
#include "prepare/checks/check_case.hpp"
#include "prepare/checks/check_in_situ.hpp"
#include "prepare/checks/check_regions.hpp"
#include "prepare/checks/check_values.hpp"
#include "prepare/checks/refusal.hpp"
#include "prepare/model_file.hpp"

namespace breccia {
namespace {

/// "body.pile.size needs ..." of a part as "spheres.body.pile.size needs ...",
/// "stage.shear.wall.top ..." as "stage.shear.spheres.wall.top ..."; sentences that begin with no
/// key as "spheres: ...". Probes and [time] stand above both parts and keep their keys.
std::string of_part(const char* part, const std::string& problem,
                    const std::vector<coupled::StageConfig>& stages) {
  for (const coupled::StageConfig& stage : stages)
    if (const std::string where = "stage." + stage.name + "."; problem.starts_with(where))
      return where + part + "." + problem.substr(where.size());
  if (problem.starts_with("probe.") || problem.starts_with("time.")) return problem;
  const std::string word = problem.substr(0, problem.find(' '));
  return part + std::string(word.find('.') == std::string::npos ? ": " : ".") + problem;
}

/// Calls check, whose problems then begin with the name of the part.
template <class Check>
void of_part(const coupled::Config& config, const char* part, const Check& check) {
  const auto named = [&](std::vector<std::string> problems) {
    for (std::string& problem : problems) problem = of_part(part, problem, config.stages);
    return problems;
  };
  try {
    check();
  } catch (const prepare::Refusal& found) {
    prepare::refuse(named(found.problems), "in the case");
  } catch (const prepare::Unreadable& found) {
    prepare::refuse<prepare::Unreadable>(named(found.problems), "in the case");
  }
}

/// check(config) for both parts, all problems at once.
template <class Check>
void of_both(const coupled::Config& config, const Check& check) {
  const coupled::Parts parts = coupled::parts_of(config);
  prepare::refuse_all(
      "in the case", [&] { of_part(config, "spheres", [&] { check(parts.spheres); }); },
      [&] { of_part(config, "tetrahedra", [&] { check(parts.tetrahedra); }); });
}

}  // namespace

coupled::Model build_model(const coupled::Config& config, const std::string& case_folder,
                           const Exec& how) {
  const coupled::Parts parts = coupled::parts_of(config);
  coupled::Model model;
  of_part(config, "spheres", [&] { model.spheres = build_model(parts.spheres, case_folder, how); });
  of_part(config, "tetrahedra",
          [&] { model.tetrahedra = build_model(parts.tetrahedra, case_folder); });
  return model;
}

void save_model(CheckpointWriter& writer, const coupled::Model& model) {
  CheckpointWriter spheres, tetrahedra;
  save_model(spheres, model.spheres);
  save_model(tetrahedra, model.tetrahedra);
  writer.adopt("spheres.", spheres);
  writer.adopt("tetrahedra.", tetrahedra);
}
coupled::Model load_coupled_model(const CheckpointReader& reader) {
  return {load_model(reader.below("spheres.")), load_fdem3_model(reader.below("tetrahedra."))};
}

void coupled::check_case(const Config& config) {
  prepare::refuse_all(
      "in the case", [&] { prepare::refuse(case_problems(config), "in the case"); },
      [&] {
        of_both(config, [](const auto& part) {
          using namespace breccia;
          check_case(part);
        });
      });
}

void prepare::check_regions(const coupled::Config& config, const std::string* folder) {
  of_both(config, [&](const auto& part) { prepare::check_regions(part, folder); });
}
void prepare::check_files(const coupled::Config& config, const std::string& case_folder) {
  of_both(config, [&](const auto& part) { prepare::check_files(part, case_folder); });
}

namespace {
/// @param doubts_of  doubts_of(parts)
template <class DoubtsOf>
std::vector<std::string> doubts_of_part(const coupled::Config& config, const char* part,
                                        const DoubtsOf& doubts_of) {
  std::vector<std::string> doubts = doubts_of(coupled::parts_of(config));
  for (std::string& doubt : doubts) doubt = of_part(part, doubt, config.stages);
  return doubts;
}
}  // namespace

std::vector<std::string> prepare::doubtful_walls(const coupled::Config& config,
                                                 const std::string& folder) {
  return doubts_of_part(config, "spheres", [&](const coupled::Parts& parts) {
    return doubtful_walls(parts.spheres, folder);
  });
}
std::vector<std::string> prepare::doubtful_loads(const coupled::Config& config,
                                                 const std::string& folder) {
  return doubts_of_part(config, "tetrahedra", [&](const coupled::Parts& parts) {
    return doubtful_loads(parts.tetrahedra, folder);
  });
}
std::vector<std::string> prepare::doubtful_in_situ(const coupled::Config& config,
                                                   const std::string& folder) {
  return doubts_of_part(config, "tetrahedra", [&](const coupled::Parts& parts) {
    return doubtful_in_situ(parts.tetrahedra, folder);
  });
}

std::vector<std::string> prepare::doubtful_values(const coupled::Config& config,
                                                  const std::string& folder) {
  std::vector<std::string> doubts = doubts_of_part(
      config, "spheres",
      [&](const coupled::Parts& parts) { return doubtful_values(parts.spheres, folder); });
  for (std::string& doubt : doubts_of_part(config, "tetrahedra", [&](const coupled::Parts& parts) {
         return doubtful_values(parts.tetrahedra, folder);
       }))
    doubts.push_back(std::move(doubt));
  return doubts;
}

}  // namespace breccia
