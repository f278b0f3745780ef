// How a run stood when it wrote a checkpoint, and whether that is of the case at hand.

#include <fmt/format.h>

#include "exec/error.hpp"
#include "run/run.hpp"

namespace breccia {

void refuse_other_case(const CheckpointReader& checkpoint, const RunPlan& plan) {
  const std::string precision =
      checkpoint.has("run.precision") ? checkpoint.text("run.precision") : "double";
  if (precision != plan.config.precision)
    throw CheckpointError(
        fmt::format("the checkpoint is of a run with precision = \"{}\", {} asks for \"{}\"",
                    precision, plan.case_name, plan.config.precision));
  if (checkpoint.text("run.model_digest") == plan.model_digest) return;
  throw CheckpointError(
      fmt::format("the checkpoint is of another case than {}: bodies, materials, links, loads and "
                  "[time] safety must be the same, and so must the keys that the program knows",
                  plan.case_name));
}

RunState::RunState(const CheckpointReader& checkpoint)
    : step(checkpoint.value<std::int64_t>("run.step")),
      time(checkpoint.value<double>("run.time")),
      dt_min(checkpoint.value<double>("run.dt_min")),
      dt_max(checkpoint.value<double>("run.dt_max")),
      end_time(checkpoint.value<double>("run.end_time")),
      end_steps(checkpoint.value<std::int64_t>("run.end_steps")) {
  record.load(checkpoint);
}

}  // namespace breccia
