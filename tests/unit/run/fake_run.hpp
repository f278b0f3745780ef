#pragma once
// Runs of the fake method, as a program would make them.

#include <nlohmann/json.hpp>
#include <string>

#include "io/whole_file.hpp"
#include "run/machine/signals.hpp"
#include "run/run.hpp"
#include "texts.hpp"
#include "unit/run/fake_method.hpp"

namespace breccia {

/// A plan of 2 s simulated time: about 200 steps.
inline RunPlan fake_plan() {
  RunPlan plan;
  plan.config.method = "fake";
  plan.config.time.end = 2.0;
  plan.config.output.frames = 4;
  plan.config.output.history = 0.05;
  plan.config.output.pictures = false;
  plan.config.probes = {ProbeConfig{"first", "", "position_x", "mean"}};
  plan.case_name = "fake";
  plan.case_text = "method = \"fake\"\n";
  plan.model_digest = "digest of the fake";
  plan.speech = Speech::quiet;
  return plan;
}

/// A new run in the folder.
inline int run_fake(const RunPlan& plan, const std::string& path, const Trouble& trouble = {}) {
  StopSignals signals;
  signals.answer_between_steps();
  FakeMethod method(trouble);
  const ResultFolder folder = ResultFolder::create(path, Existing::refuse);
  return Run(method, plan, &folder).execute();
}

/// Goes on with the run of the folder.
inline int resume_fake(const RunPlan& plan, const std::string& path,
                       std::string* warnings = nullptr) {
  StopSignals signals;
  signals.answer_between_steps();
  const ResultFolder folder = ResultFolder::open(path);
  FakeMethod method;
  const CheckpointReader checkpoint =
      newest_good_checkpoint(folder.file("checkpoints"), [&](const std::string& text) {
        if (warnings != nullptr) *warnings += text;
      });
  refuse_other_case(checkpoint, plan);
  method.load(&checkpoint);
  const RunState former(checkpoint);
  return Run(method, plan, &folder, &former).execute();
}

inline nlohmann::json summary_of(const std::string& path) {
  return parsed_json(read_whole_file(path + "/summary.json"));
}

}  // namespace breccia
