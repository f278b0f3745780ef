// breccia: how concrete and rock break. Exit codes: docs of the commands, exec/error.hpp.

#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <set>
#include <string>
#include <system_error>

#include "app/commands.hpp"
#include "domain/mpi_ranks.hpp"
#include "exec/error.hpp"
#include "exec/no_memory.hpp"
#include "exec/threads.hpp"
#include "io/case/suggestion.hpp"
#include "io/emphasis.hpp"
#include "io/fold.hpp"
#include "io/harmless.hpp"
#include "run/machine/machine.hpp"
#include "run/machine/memory_plan.hpp"
#include "run/machine/signals.hpp"

namespace {

constexpr int usage_error = 2;
constexpr int file_error = 3;
constexpr int memory_error = 5;

void write_error(const std::string& message) {
  const std::string text =
      fmt::format("{} {}\n", breccia::emphasized(breccia::Emphasis::error, "error:", stderr),
                  breccia::harmless(message));
  std::fputs(breccia::fitting(text, 4, stderr).c_str(), stderr);
}

/// Help of the program and its commands, for terminals of 80 columns.
struct FoldedHelp : CLI::Formatter {
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override {
    const std::string text = CLI::Formatter::make_help(app, std::move(name), mode);
    std::string all;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
      const std::string line = text.substr(at, end - at);
      all += breccia::folded(line, 80, line.starts_with(' ') ? get_column_width() : 0);
      at = end;
    }
    return all;
  }
};

/// Problems of arguments that a command does not take, in the order in which they stand.
std::string text_of_extras(const CLI::App& command) {
  std::set<std::string> options;
  std::string takes;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) options.insert("--" + name);
    if (option->get_positional()) takes += option->get_single_name() + " and ";
  }
  std::string text, words;
  bool behind_option = false;
  for (const std::string& argument : command.remaining()) {
    const bool is_option = argument.starts_with('-') && argument.size() > 1;
    if (is_option)
      text += fmt::format("{}{} is not an option of {}{}", text.empty() ? "" : "\n", argument,
                          command.get_name(), breccia::suggestion(argument, options));
    else if (!behind_option)  // or it may be the value of one that is misspelt
      words += (words.empty() ? "" : " ") + argument;
    behind_option = is_option;
  }
  if (words.empty()) return text;
  return fmt::format(
      "{}{}{}: not expected; {} takes {}options, and what belongs to an option is one word behind "
      "it",
      text, text.empty() ? "" : "\n", words, command.get_name(), takes);
}

/// Tells of a wrong command line; a first word that is no command is named.
void tell_usage(const CLI::App& program, const CLI::ParseError& error, int argc, char** argv) {
  if (error.get_exit_code() == 0) {  // help
    program.exit(error);
    return;
  }
  const std::string first = argc > 1 ? argv[1] : "-";
  std::set<std::string> commands;
  for (const CLI::App* command : program.get_subcommands({})) commands.insert(command->get_name());
  const std::vector<CLI::App*> called = program.get_subcommands();
  std::string text = error.what();
  if (!called.empty() && error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError))
    text = text_of_extras(*called.front());
  else if (!called.empty())
    text = called.front()->get_name() + ": " + text;
  else if (!first.starts_with('-'))
    text = fmt::format("{} is not a command{}", first, breccia::suggestion(first, commands));
  write_error(text + "\nRun with --help for more information.");
}

int tell_and_end(breccia::Communicator& ranks, int exit_code, const std::string& message) {
  write_error(fmt::format("rank {}: {}", ranks.rank(), message));
  std::fflush(stderr);
  ranks.abort(exit_code);
  return exit_code;
}

std::string version_text() {
  const breccia::Build& build = breccia::this_build();
  return fmt::format("breccia {} ({}, {}, {}{})", build.version,
                     build.commit.empty() ? "no commit" : build.commit, build.type, build.compiler,
                     build.cuda ? ", CUDA" : "");
}

int run_program(int argc, char** argv, breccia::Communicator* ranks) {
  int exit_code = 0;
  CLI::App program{
      "How concrete and rock break: spheres with links that soften and fail, triangles and "
      "tetrahedra with joints that crack."};
  program.name("breccia");
  program.formatter(std::make_shared<FoldedHelp>());
  program.footer(
      "Exit codes: 0 done, 2 bad input, 3 input/output, 4 numerics, 5 memory or device,\n"
      "7 checkpoint refused, 8 a rank was lost, 9 a check of the case failed,\n"
      "10 end of --max-wall, 128+n ended by signal n.");
  program.set_version_flag("--version", version_text());
  program.require_subcommand(1);
  breccia::app::add_run(program, exit_code, ranks);
  breccia::app::add_resume(program, exit_code, ranks);
  breccia::app::add_prepare(program);
  breccia::app::add_check(program, exit_code);
  breccia::app::add_keys(program);
  breccia::app::add_materials(program);
  breccia::app::add_explain(program);
  breccia::app::add_new(program);
  breccia::app::add_demo(program, exit_code);
  breccia::app::add_doctor(program);
  breccia::app::add_info(program);
  breccia::app::add_compare(program);
  breccia::app::add_mesh(program);
  breccia::app::add_convert(program);
  breccia::app::add_render(program);
  breccia::app::add_report(program);
  breccia::app::add_sweep(program, exit_code);
  breccia::app::add_test(program, exit_code);
  breccia::app::add_watch(program, exit_code);
  breccia::app::add_verify(program, exit_code);
  breccia::app::add_shell_file(program);
  breccia::app::add_calibrate(program, exit_code);
#ifdef BR_BENCH
  breccia::app::add_bench(program, ranks);
#endif
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (ranks != nullptr && ranks->rank() != 0) return error.get_exit_code() == 0 ? 0 : usage_error;
    tell_usage(program, error, argc, argv);
    return error.get_exit_code() == 0 ? 0 : usage_error;
  }
  return exit_code;
}

/// Runs one command; errors become messages and exit codes.
int guarded(int argc, char** argv, breccia::Communicator* ranks) {
  // An error on all ranks is told once. A rank that fails alone tells its own and ends the others.
  const auto tell = [&](int exit_code, const std::string& message) {
    const bool alone = ranks != nullptr && !ranks->in_step();
    if (alone) return tell_and_end(*ranks, exit_code, message);
    if (ranks == nullptr || ranks->rank() == 0) write_error(message);
    return exit_code;
  };
  int exit_code = 0;
  try {
    exit_code = run_program(argc, argv, ranks);
  } catch (const breccia::Error& error) {
    exit_code = tell(error.exit_code(), error.what());
  } catch (const std::bad_alloc&) {
    exit_code =
        tell(memory_error,
             fmt::format("not enough memory: {} were in use",
                         breccia::memory_text(static_cast<double>(breccia::peak_memory()))));
  } catch (const std::filesystem::filesystem_error& error) {
    exit_code = tell(file_error, error.path1().string() + ": " + error.code().message());
  } catch (const std::system_error& error) {  // of fmt::print
    exit_code = tell(file_error, fmt::format("standard output: {}", error.what()));
  } catch (const std::exception& error) {
    exit_code = tell(1, fmt::format("a fault of the program itself: {}", error.what()));
  }
  if ((std::fflush(stdout) != 0 || std::ferror(stdout) != 0) && exit_code == 0)
    exit_code = tell(file_error, "standard output: cannot be written");
  return exit_code;
}

/// Frames take and free the same tens of megabytes again and again. The C library keeps them rather
/// than give them back to the system: else the page faults of new ones take a tenth of output.
void keep_freed_memory() {
#if defined(__GLIBC__)
  ::mallopt(M_MMAP_THRESHOLD, 32 << 20);  // longer arrays go back at once  [bytes]
  ::mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  breccia::end_without_memory();
  breccia::let_waiting_threads_sleep(argv);
  breccia::ignore_quota_signal();
  try {
    const std::unique_ptr<breccia::Communicator> ranks = breccia::launched_ranks();
    const std::string command = argc > 1 ? argv[1] : "";
    const bool several = ranks && ranks->size() > 1;
    const bool shared = several && (command == "run" || command == "resume" || command == "bench");
    if (several && ranks->rank() != 0 && !shared) return 0;  // the first rank does it
    return guarded(argc, argv, shared ? ranks.get() : nullptr);
  } catch (const breccia::Error& error) {  // of MPI itself
    write_error(error.what());
    return error.exit_code();
  }
}
