// breccia: how concrete and rock break. Exit codes: docs of the commands, exec/error.hpp.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <new>

#include "app/commands.hpp"
#include "exec/error.hpp"
#include "exec/threads.hpp"
#include "run/machine.hpp"

namespace {

constexpr int usage_error = 2;
constexpr int file_error = 3;
constexpr int memory_error = 5;

int tell(int exit_code, const std::string& message) {
  std::fputs(fmt::format("error: {}\n", message).c_str(), stderr);
  return exit_code;
}

std::string version_text() {
  const breccia::Build& build = breccia::this_build();
  return fmt::format("breccia {} ({}, {}, {}{})", build.version,
                     build.commit.empty() ? "no commit" : build.commit, build.type, build.compiler,
                     build.cuda ? ", CUDA" : "");
}

int run_program(int argc, char** argv) {
  int exit_code = 0;
  CLI::App program{
      "How concrete and rock break: discrete elements with links that soften and fail."};
  program.name("breccia");
  program.footer(
      "Exit codes: 0 done, 2 bad input, 3 input/output, 4 numerics, 5 memory or device,\n"
      "7 checkpoint refused, 9 a check of the case failed, 128+n ended by signal n.");
  program.set_version_flag("--version", version_text());
  program.require_subcommand(1);
  breccia::app::add_run(program, exit_code);
  breccia::app::add_resume(program, exit_code);
  breccia::app::add_prepare(program);
  breccia::app::add_check(program, exit_code);
  breccia::app::add_keys(program);
  breccia::app::add_info(program);
  breccia::app::add_render(program);
  breccia::app::add_bench(program);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : usage_error;
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  breccia::let_waiting_threads_sleep(argv);
  int exit_code = 0;
  try {
    exit_code = run_program(argc, argv);
  } catch (const breccia::Error& error) {
    exit_code = tell(error.exit_code(), error.what());
  } catch (const std::bad_alloc&) {
    exit_code = tell(memory_error, "not enough memory");
  } catch (const std::filesystem::filesystem_error& error) {
    exit_code = tell(file_error, error.what());
  } catch (const std::exception& error) {
    exit_code = tell(1, fmt::format("a fault of the program itself: {}", error.what()));
  }
  if (std::fflush(stdout) != 0 && exit_code == 0)
    exit_code = tell(file_error, "standard output: cannot be written");
  return exit_code;
}
