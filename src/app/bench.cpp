// breccia bench: how fast this machine is.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>

#include "app/benchmarks.hpp"
#include "app/commands.hpp"
#include "app/run_options.hpp"
#include "exec/error.hpp"
#include "io/whole_file.hpp"

namespace breccia::app {
namespace {

struct BenchCommand {
  std::vector<std::string> names;
  std::string file;
  bool paced = false;
  RunOptions options;

  void refuse_unknown() const {
    std::string known;
    for (const Benchmark& benchmark : benchmarks())
      known += fmt::format("\n  {:<24} {}", benchmark.name, benchmark.meaning);
    for (const std::string& name : names)
      if (std::none_of(benchmarks().begin(), benchmarks().end(),
                       [&](const Benchmark& benchmark) { return benchmark.name == name; }))
        throw InputError(fmt::format("{} is not a benchmark; there are:{}", name,
                                     known.empty() ? " none" : known));
  }

  void execute() const {
    refuse_unknown();
    const Exec exec = exec_of(options, nullptr);
    if (paced) {
      pace_slab(std::cin, std::cout, exec);
      return;
    }
    std::vector<std::pair<std::string, std::vector<Measurement>>> all;
    fmt::print("{}, {} threads\n", processor_name(), exec.threads);
    for (const Benchmark& benchmark : benchmarks()) {
      if (!names.empty() && std::find(names.begin(), names.end(), benchmark.name) == names.end())
        continue;
      all.emplace_back(benchmark.name, benchmark.measure(exec));
      fmt::print("\n{}", benchmark_table(all.back().first, all.back().second));
      std::fflush(stdout);
    }
    if (!file.empty()) replace_file(file, benchmark_json(all, exec, options.device));
  }
};

}  // namespace

void add_bench(CLI::App& program) {
  const auto bench = std::make_shared<BenchCommand>();
  CLI::App* const command = program.add_subcommand("bench", "measure how fast this machine is");
  command->add_option("NAME", bench->names, "which benchmarks; default: all");
  command->add_option("--json", bench->file, "write the numbers to this file")->type_name("FILE");
  command->add_option("--device", bench->options.device, "where to compute: cpu, cuda or cuda:N")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--threads", bench->options.threads, "host threads; default: all")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));
  command->add_flag(
      "--paced", bench->paced,
      "run the slab as told on standard input: 'steps N', 'until T', 'export FOLDER'");
  command->callback([bench] { bench->execute(); });
}

}  // namespace breccia::app
