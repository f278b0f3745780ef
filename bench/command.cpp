// breccia bench: how fast this machine is.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>

#include "app/commands.hpp"
#include "app/run_options.hpp"
#include "bench/list.hpp"
#include "core/precision.hpp"
#include "domain/together.hpp"
#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "run/machine/exec_choice.hpp"

namespace breccia::app {
namespace {

struct BenchCommand {
  std::vector<std::string> names;
  std::string file, precision = "double";
  bool paced = false;
  RankScale scale;
  RunOptions options;

  template <class List>
  static bool holds(const List& list, const std::string& name) {
    return std::any_of(list.begin(), list.end(),
                       [&](const auto& benchmark) { return benchmark.name == name; });
  }
  template <class Benchmark>
  bool wanted(const Benchmark& benchmark) const {
    return std::find(names.begin(), names.end(), benchmark.name) != names.end();
  }

  void refuse_unknown(const Communicator* ranks) const {
    std::string known;
    for (const Benchmark& benchmark : benchmarks())
      known += fmt::format("\n  {:<24} {}", benchmark.name, benchmark.meaning);
    for (const RankBenchmark& benchmark : rank_benchmarks())
      known += fmt::format("\n  {:<24} {}", benchmark.name, benchmark.meaning);
    for (const std::string& name : names)
      if (!holds(benchmarks(), name) && !holds(rank_benchmarks(), name))
        throw InputError(fmt::format("{} is not a benchmark; there are:{}", name, known));
    if (ranks == nullptr) return;
    for (const std::string& name : names)
      if (!holds(rank_benchmarks(), name))
        throw InputError(name + " is no benchmark of several ranks; start it without mpirun");
    if (names.empty() || paced)
      throw InputError("name the benchmarks that several ranks make together: weak_slabs, ...");
  }

  void execute(Communicator* ranks) const {
    refuse_unknown(ranks);
    Exec exec;
    collective_try(ranks, [&] {
      exec = in_precision(exec_on(options.device, options.threads, ranks), precision);
    });
    if (paced) {
      pace_slab(std::cin, std::cout, exec);
      return;
    }
    std::vector<std::pair<std::string, std::vector<Measurement>>> all;
    if (leads(ranks))
      fmt::print("{}, {} threads, {} precision\n", processor_name(), exec.threads, precision);
    const auto add = [&](const char* name, std::vector<Measurement> measured) {
      all.emplace_back(name, std::move(measured));
      if (leads(ranks)) fmt::print("\n{}", benchmark_table(all.back().first, all.back().second));
      std::fflush(stdout);
    };
    for (const Benchmark& benchmark : benchmarks())
      if (names.empty() || wanted(benchmark)) add(benchmark.name, benchmark.measure(exec));
    for (const RankBenchmark& benchmark : rank_benchmarks())
      if (wanted(benchmark)) add(benchmark.name, benchmark.measure(exec, ranks, scale));
    collective_try(ranks, [&] {
      if (!file.empty() && leads(ranks))
        replace_file(file, benchmark_json(all, exec, options.device));
    });
  }
};

}  // namespace

void add_bench(CLI::App& program, Communicator* ranks) {
  const auto bench = std::make_shared<BenchCommand>();
  CLI::App* const command = program.add_subcommand("bench", "measure how fast this machine is");
  command->add_option("NAME", bench->names, "which benchmarks; default: all of one rank");
  command->add_option("--json", bench->file, "write the numbers to this file")->type_name("FILE");
  command->add_option("--device", bench->options.device, "where to compute: cpu, cuda or cuda:N")
      ->type_name("NAME")
      ->capture_default_str();
  command
      ->add_option("--threads", bench->options.threads,
                   "host threads of each rank; default: its share of the machine")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));
  command
      ->add_option(
          "--precision", bench->precision,
          "what numbers are stored in: double, mixed or single, as the key `precision` of a case")
      ->check(CLI::IsMember({"double", "mixed", "single"}))
      ->capture_default_str();
  command->add_flag(
      "--paced", bench->paced,
      "run the slab as told on standard input: 'steps N', 'until T', 'export FOLDER'");
  command
      ->add_option("--elements", bench->scale.elements,
                   "of each rank in weak_..., of all in strong_...")
      ->type_name("N")
      ->check(CLI::Range(1, 2'000'000'000));
  command
      ->add_option("--window-steps", bench->scale.steps,
                   "steps of a window of weak_... and strong_...")
      ->type_name("N")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command->callback([bench, ranks] { bench->execute(ranks); });
}

}  // namespace breccia::app
