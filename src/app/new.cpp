// breccia new NAME: a case to begin from. breccia demo: one that is run at once, with what to look
// at.

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands.hpp"
#include "app/templates.hpp"
#include "exec/error.hpp"
#include "io/harmless.hpp"
#include "io/whole_file.hpp"

namespace breccia::app {
namespace {

void list_templates(const char* command) {
  for (const CaseTemplate& t : case_templates()) fmt::print("  {:<10}{}\n", t.name, t.shows);
  fmt::print("Take one: breccia {} {}\n", command, case_templates().front().name);
}

std::vector<std::string> template_names() {
  std::vector<std::string> names;
  for (const CaseTemplate& t : case_templates()) names.push_back(t.name);
  return names;
}

void write_new(const std::string& file, const CaseTemplate& from) {
  if (std::filesystem::exists(file))
    throw InputError(file + ": exists already; name another file, as in breccia new " + from.name +
                     " mine.toml");
  if (const auto folder = std::filesystem::path(file).parent_path(); !folder.empty())
    std::filesystem::create_directories(folder);
  replace_file(file, from.text);
}

/// Runs this program again as a process of its own. Returns its exit code.
int run_self(std::vector<std::string> arguments) {
  std::fflush(stdout);
  arguments.insert(arguments.begin(), "breccia");
  std::vector<char*> words;
  for (std::string& word : arguments) words.push_back(word.data());
  words.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    ::execv("/proc/self/exe", words.data());
    ::_exit(127);
  }
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) < 0)
    throw IoError("this program could not be started once more");
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

int run_demo(const std::string& name, const std::string& threads) {
  const CaseTemplate& demo = template_named(name);
  const std::string file = "out/demo/" + name + ".toml", folder = "out/demo/" + name;
  std::filesystem::create_directories("out/demo");
  replace_file(file, demo.text);
  fmt::print("{}: {}\n", file, demo.shows);
  std::vector<std::string> run{"run", file, "-o", folder, "--force"};
  if (!threads.empty()) run.insert(run.end(), {"--threads", threads});
  if (const int code = run_self(run); code != 0) return code;
  if (const int code = run_self({"report", folder}); code != 0) return code;
  fmt::print(
      "\nLook at\n  {0}/pictures   {1}\n  {0}/report.html  the same to turn and to "
      "play\n",
      folder, demo.look);
  fmt::print("Change {}, then: breccia run {}\n", file, file);
  return 0;
}

}  // namespace

void add_new(CLI::App& program) {
  struct Wish {
    std::string name, file;
  };
  const auto wish = std::make_shared<Wish>();
  CLI::App* const command = program.add_subcommand("new", "a small case to begin from");
  command->add_option("NAME", wish->name,
                      fmt::format("{}; none: lists", fmt::join(template_names(), ", ")));
  command->add_option("FILE", wish->file, "where to write it; default: NAME.toml");
  command->footer("Example: breccia new beam && breccia run beam.toml");
  command->callback([wish] {
    if (wish->name.empty()) return list_templates("new");
    const std::string file = wish->file.empty() ? wish->name + ".toml" : wish->file;
    write_new(file, template_named(wish->name));
    fmt::print("{}: written; then: breccia check {} && breccia run {}\n", harmless(file),
               harmless(file), harmless(file));
  });
}

void add_demo(CLI::App& program, int& exit_code) {
  struct Wish {
    std::string name = "slab", threads;
    bool list = false;
  };
  const auto wish = std::make_shared<Wish>();
  CLI::App* const command =
      program.add_subcommand("demo", "run a small case and say what to look at");
  command->add_option("NAME", wish->name, "one of those that `breccia demo --list` tells")
      ->capture_default_str();
  command->add_option("--threads", wish->threads, "host threads")->type_name("N");
  command->add_flag("--list", wish->list, "only say which there are");
  command->callback([wish, &exit_code] {
    if (wish->list) return list_templates("demo");
    exit_code = run_demo(wish->name, wish->threads);
  });
}

}  // namespace breccia::app
