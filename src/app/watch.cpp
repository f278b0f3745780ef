// breccia watch DIR: a run that was started elsewhere, on the terminal, to its end.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

#include "app/board.hpp"
#include "app/commands.hpp"
#include "app/serve.hpp"
#include "exec/error.hpp"
#include "io/harmless.hpp"
#include "io/json.hpp"
#include "io/whole_file.hpp"
#include "run/case.hpp"
#include "run/results/result_folder.hpp"

namespace breccia::app {
namespace {

/// Whether the terminal shows more than ASCII, by the words of its locale.
bool shows_utf8() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"})
    if (const char* const value = std::getenv(name); value != nullptr && *value != '\0') {
      const std::string locale = value;
      return locale.find("UTF-8") != std::string::npos || locale.find("utf8") != std::string::npos;
    }
  return false;
}

class WatchCommand {
 public:
  std::string folder;
  double every = 1.0;  ///<  [s]
  bool once = false, serves = false;
  int port = 0;

  int execute() const {
    std::optional<ReportServer> server;
    if (serves) {
      look(0.0);  // whether it is a run's folder
      server.emplace(folder, port);
      fmt::print("report  {}\n        for browsers of this machine, until Ctrl-C\n",
                 server->address());
      std::fflush(stdout);
    }
    const int exit_code = show();
    while (server && !once) std::this_thread::sleep_for(std::chrono::seconds(1));
    return exit_code;
  }

 private:
  int show() const {
    const bool terminal = ::isatty(STDOUT_FILENO) != 0;
    const bool plain = !shows_utf8();
    const double end_time = end_of_case();
    std::size_t rows = 0;
    std::ptrdiff_t drawn = 0;  // lines
    for (bool more = true; more;) {
      const auto [run, exit_code, message] = look(end_time);
      more = !once && run.status == "running";
      const std::string text = board(run, plain);
      if (terminal && drawn > 0) fmt::print("\033[{}A\033[J", drawn);
      if (terminal || !more)
        fmt::print("{}", text);
      else if (run.history.rows() != rows)
        fmt::print("{}", line(text));
      std::fflush(stdout);
      drawn = std::count(text.begin(), text.end(), '\n');
      rows = run.history.rows();
      if (more) std::this_thread::sleep_for(std::chrono::duration<double>(every));
      if (!more && !message.empty()) fmt::print("  {}\n", harmless(message));
      if (!more) return run.status == "lost" ? 8 : exit_code;
    }
    return 0;
  }

  struct Look {
    Watched run;
    int exit_code;
    std::string message;
  };
  Look look(double end_time) const {
    // The lock first: a run that ends meanwhile has written its summary before.
    const bool locked = ResultFolder::is_locked(folder);
    const std::string path = folder + "/summary.json";
    if (!std::filesystem::exists(path))
      throw IoError(path + ": no such file: there is no run, or it still builds its model");
    const auto summary = read_json(read_whole_file(path));
    if (!summary.is_object() || !summary.contains("status"))
      throw InputError(path + ": is no summary of a run");
    Look seen{{folder, "", "", "", end_time, {}, {}}, 0, ""};
    try {
      Watched& run = seen.run;
      run.status = summary["status"];
      run.case_name = summary.at("case").at("name");
      run.method = summary.at("method");
      seen.exit_code = summary.at("exit_code");
      seen.message = summary.at("message");
      const Json fracture = summary.value("fracture", Json::object());
      for (const char* name : {"broken_links", "broken_joints"})
        if (fracture.contains(name)) run.broken = fracture[name];
      if (run.status == "running" && !locked) {
        run.status = "lost";
        seen.message = "nothing runs in this folder any more; go on with: breccia resume " + folder;
      }
    } catch (const Json::exception&) {
      throw InputError(path + ": is no summary of a run");
    }
    if (std::filesystem::exists(folder + "/history.csv"))
      seen.run.history = report::read_table(folder + "/history.csv");
    return seen;
  }

  /// The second line of a board, for a log.
  static std::string line(const std::string& text) {
    const std::size_t begin = text.find('\n') + 1;
    return text.substr(begin, text.find('\n', begin) + 1 - begin);
  }

  double end_of_case() const {
    try {
      return load_case(folder + "/case.toml", {}).common().time.end;
    } catch (const Error&) {  // of another version: the share is not shown
      return 0.0;
    }
  }
};

}  // namespace

void add_watch(CLI::App& program, int& exit_code) {
  const auto watch = std::make_shared<WatchCommand>();
  CLI::App* const command =
      program.add_subcommand("watch", "show how a run in DIR goes, until it ends");
  command->add_option("DIR", watch->folder, "the result folder of the run")->required();
  command->add_option("--every", watch->every, "from one look to the next")
      ->type_name("SECONDS")
      ->check(CLI::Range(0.05, 3600.0))
      ->capture_default_str();
  command->add_flag("--once", watch->once, "look once");
  command->add_flag(
      "--serve", watch->serves,
      "and show its report to browsers of this machine, with new frames as they come");
  command->add_option("--port", watch->port, "of --serve; default: one that is free")
      ->type_name("N")
      ->check(CLI::Range(1, 65535));
  command->callback([watch, &exit_code] { exit_code = watch->execute(); });
}

}  // namespace breccia::app
