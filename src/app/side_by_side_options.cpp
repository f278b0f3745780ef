#include "app/side_by_side_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "app/option_kinds.hpp"
#include "domain/mpi_ranks.hpp"
#include "exec/device.hpp"
#include "exec/error.hpp"
#include "io/emphasis.hpp"
#include "io/harmless.hpp"
#include "prepare/meshing/run_gmsh.hpp"
#include "run/machine/memory_plan.hpp"

namespace breccia::app {

std::string count_problem(const std::string& text) {
  constexpr int most = 10'000;
  int count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  const bool good = error == std::errc{} && end == text.data() + text.size();
  return good && count >= 1 && count <= most
             ? ""
             : fmt::format("{} is no count from 1 to {}", text, most);
}

laboratory::Workers SideBySideOptions::workers(std::size_t runs, double bytes) const {
  laboratory::Workers workers = laboratory::workers_for(jobs, runs, bytes, ranks);
  if (const int wanted = std::min(jobs, static_cast<int>(runs)); workers.jobs < wanted)
    tell_notes(
        {fmt::format("--jobs {}: the memory that is free ({}) holds {} of these runs at a time",
                     jobs, memory_text(available_memory()), workers.jobs)});
  if (ranks > 1 && !built_with_mpi())
    throw InputError("--ranks: this program has no MPI ('breccia doctor'); nothing was run");
  if (ranks > 1 && prepare::on_path("mpirun").empty() && std::getenv("BRECCIA_MPIRUN") == nullptr)
    throw InputError("--ranks: there is no mpirun (apt install openmpi-bin); nothing was run");
  if (const char* const mpirun = std::getenv("BRECCIA_MPIRUN")) workers.mpirun = mpirun;
  if (threads > 0) workers.threads = threads;
  workers.force = force;
  workers.allow_scripts = allow_scripts;
  if (device == "cpu") return workers;
  if (!device.starts_with("cuda"))
    throw InputError(
        fmt::format("--device {}: there are cpu, cuda and cuda:N; nothing was run", device));
  if (device == "cuda") {
    const int there = device_count();
    if (there == 0)
      throw DeviceError("--device cuda: there is no GPU, or this program has no CUDA");
    const char* const visible = std::getenv("CUDA_VISIBLE_DEVICES");
    workers.devices = laboratory::gpus_for(there, ranks, visible != nullptr ? visible : "");
  } else {
    workers.devices = {{device, ""}};
  }
  if (jobs == 0) workers.jobs = std::min(workers.jobs, static_cast<int>(workers.devices.size()));
  return workers;
}

void add_side_by_side_options(CLI::App& command, SideBySideOptions& options) {
  add_count(&command, "--jobs", options.jobs, "runs at a time; default: as many as fit");
  add_count(&command, "--ranks", options.ranks, "of each run, by mpirun; default: 1");
  add_count(&command, "--threads", options.threads, "of each rank; default: its share");
  command
      .add_option("--device", options.device, "cpu, cuda (all GPUs dealt to the runs) or cuda:N")
      ->type_name("NAME");
  command.add_flag("--force", options.force, "compute finished runs anew");
  command.add_flag("--allow-scripts", options.allow_scripts,
                   "let gmsh run .geo files; only for trusted cases");
}

double run_bytes(const Case& read) {
  return std::visit([](const auto& config) { return memory_plan(config).run_bytes; }, read.config);
}

void tell_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes)
    std::fputs(
        fmt::format("{} {}\n", emphasized(Emphasis::warning, "warning:", stderr), harmless(note))
            .c_str(),
        stderr);
}

std::function<void(std::size_t, const laboratory::FinishedRun&)> tell_of(
    const std::vector<laboratory::PlannedRun>& runs) {
  const auto ended = std::make_shared<std::size_t>(0);
  return [ended, &runs](std::size_t run, const laboratory::FinishedRun& result) {
    if (result.again_beside > 0) {
      fmt::print("{}\n", harmless(fmt::format(
                             "   later       no memory    {:>7.1f} s  {}: {}; {} at a "
                             "time from here on",
                             result.wall, runs[run].name, result.message, result.again_beside)));
      std::fflush(stdout);
      return;
    }
    const std::string state = result.kept              ? "kept"
                              : result.exit_code == 0  ? "done"
                              : result.exit_code == 9  ? "check failed"
                              : result.exit_code > 128 ? "interrupted"
                                                       : "failed";
    std::string line = fmt::format("{:>5} of {}  {:<12} {:>7.1f} s  {}", ++*ended, runs.size(),
                                   state, result.wall, runs[run].name);
    if (!result.message.empty()) line += ": " + result.message;
    if (state == "failed" && result.ended_mute())
      line += "; all it said: " + laboratory::log_beside(runs[run].folder);
    fmt::print("{}\n", harmless(line));
    std::fflush(stdout);
  };
}

}  // namespace breccia::app
