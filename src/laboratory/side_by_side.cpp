#include "laboratory/side_by_side.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <omp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <filesystem>
#include <optional>
#include <thread>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "laboratory/run_result.hpp"
#include "run/machine/memory_plan.hpp"
#include "run/machine/signals.hpp"
#include "run/results/result_folder.hpp"

namespace breccia::laboratory {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

const std::string visible_gpus_key = "CUDA_VISIBLE_DEVICES=";
const std::string this_program = "/proc/self/exe";

/// The environment of a run.
std::vector<std::string> environment_of(int ranks, const std::string& visible) {
  std::vector<std::string> kept;
  const auto is_set = [](const char* name) { return std::getenv(name) != nullptr; };
  const bool in_rank = is_set("OMPI_COMM_WORLD_RANK") || is_set("PMIX_RANK") || is_set("PMI_RANK");
  for (char** entry = environ; *entry != nullptr; ++entry) {
    // Without what an mpirun leaves in it: a run that a rank starts is no rank of that.
    constexpr std::array foreign{"OMPI_", "PMIX_", "PMI_", "PRTE_"};
    const std::string text = *entry;
    if (!in_rank || text.starts_with("OMPI_ALLOW_") ||
        std::none_of(foreign.begin(), foreign.end(),
                     [&](const char* start) { return text.starts_with(start); }))
      kept.push_back(text);
  }
  if (ranks > 1)  // beside others on one machine: Open MPI would bind all to the first cores
    for (const char* setting :
         {"OMPI_MCA_hwloc_base_binding_policy=none", "OMPI_MCA_rmaps_base_oversubscribe=1",
          "PRTE_MCA_hwloc_default_binding_policy=none"})
      kept.emplace_back(setting);
  if (!visible.empty()) {
    std::erase_if(kept, [](const auto& entry) { return entry.starts_with(visible_gpus_key); });
    kept.push_back(visible_gpus_key + visible);
  }
  return kept;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// Starts the words' first one; both streams go to the file `log`. It ends when this process dies,
/// and a signal of the terminal reaches it only through this process.
pid_t start(std::vector<std::string> words, std::vector<std::string> environment,
            const std::string& log) {
  const std::string program = words.front();
  if (program == this_program) words.front() = "breccia";
  const std::vector<char*> arguments = pointers_to(words), entries = pointers_to(environment);
  const int output = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (output < 0) throw IoError(log + ": cannot be written: " + std::strerror(errno));
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);  // mpirun reads, and would stop
  const pid_t child = ::fork();
  if (child == 0) {
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    ::execvpe(program.c_str(), arguments.data(), entries.data());
    ::_exit(127);
  }
  const int reason = errno;
  ::close(nothing);
  ::close(output);
  if (child < 0) throw IoError(std::string("cannot start a process: ") + std::strerror(reason));
  return child;
}

bool holds_checkpoint(const std::string& folder) {
  std::error_code error;
  return !fs::is_empty(folder + "/checkpoints", error) && !error;
}

/// Of a run that told no error.
std::string mute_end(int exit_code) {
  return exit_code < 0 ? fmt::format("killed by signal {}", -exit_code)
                       : fmt::format("exit code {}", exit_code);
}

/// The first line that has words, as in what mpirun says below a line of dashes.
std::string first_words(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, std::min<std::size_t>(end - at, 120));
    if (std::any_of(line.begin(), line.end(),
                    [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }))
      return ": " + line;
    at = end + 1;
  }
  return "";
}

/// The error that a run has told, without the word before it, with the first line below it that
/// stands further in: the problem that the error counts.
std::string told_error(const std::string& log, int exit_code) {
  try {
    const std::string text = read_whole_file(log);
    const std::size_t at = text.rfind("error: ");
    if (at != std::string::npos) {
      const auto line_from = [&](std::size_t begin) {
        return text.substr(begin, std::min(text.find('\n', begin), text.size()) - begin);
      };
      const std::string error = line_from(at + 7);
      const std::string below = line_from(std::min(at + 7 + error.size() + 1, text.size()));
      const std::size_t first = below.find_first_not_of(' ');
      return first == 0 || first == std::string::npos ? error : error + ": " + below.substr(first);
    }
    return mute_end(exit_code) + first_words(text);
  } catch (const Error&) {
  }
  return mute_end(exit_code);
}

/// Whether a run ended because the machine, or its GPU, had no memory for it.
bool lacked_memory(int exit_code, const std::string& log) {
  if (exit_code == -SIGKILL || exit_code == 128 + SIGKILL) return true;  // by the kernel; mpirun
  constexpr int refused_by_device = 5;
  return exit_code == refused_by_device &&
         told_error(log, exit_code).find("memory") != std::string::npos;
}

class Pool {
 public:
  Pool(const std::vector<PlannedRun>& runs, const Workers& workers,
       const std::function<void(std::size_t, const FinishedRun&)>& tell)
      : runs_(runs), workers_(workers), tell_(tell), results_(runs.size()), at_once_(workers.jobs) {
    for (std::size_t run = 0; run < runs.size(); ++run) waiting_.push_back(run);
  }

  std::vector<FinishedRun> work() {
    StopSignals signals;
    signals.answer_between_steps();
    bool told = false;
    while (!waiting_.empty() || !active_.empty()) {
      const int signal = StopSignals::received();
      if (signal != 0 && !told) {
        // mpirun hands SIGUSR1 on; of others it ends the ranks before they have saved.
        for (const Active& run : active_)
          ::kill(run.process, workers_.ranks > 1 ? SIGUSR1 : signal);
        told = true;
      }
      while (signal == 0 && !waiting_.empty() &&
             active_.size() < static_cast<std::size_t>(at_once_)) {
        const std::size_t run = waiting_.front();
        waiting_.pop_front();
        begin(run);
      }
      if (signal != 0)
        for (; !waiting_.empty(); waiting_.pop_front())
          results_[waiting_.front()].exit_code = 128 + signal;
      collect();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return results_;
  }

 private:
  struct Active {
    std::size_t run;
    pid_t process;
    int device;
    Clock::time_point begin;
    bool resumed;
    bool alone;  ///< no other has run beside it
  };

  std::string log_of(std::size_t run) const { return log_beside(runs_[run].folder); }

  void begin(std::size_t run) {
    const PlannedRun& plan = runs_[run];
    const std::optional<RunResult> former = read_result(plan.folder);
    const bool same = former && former->digest == plan.digest && !workers_.force;
    if (same && former->complete()) {
      results_[run] = {former->exit_code, true, 0.0, ""};
      tell_(run, results_[run]);
      return;
    }
    make_folder(fs::path(plan.folder).parent_path().string());
    launch(run, same && holds_checkpoint(plan.folder));
  }

  void launch(std::size_t run, bool resume) {
    const PlannedRun& plan = runs_[run];
    std::vector<std::string> words;
    if (workers_.ranks > 1) words = {workers_.mpirun, "-n", std::to_string(workers_.ranks)};
    words.push_back(workers_.program.empty() ? program_for(workers_.ranks) : workers_.program);
    if (resume) {
      words.insert(words.end(), {"resume", plan.folder});
    } else {
      words.insert(words.end(), {"run", plan.case_path, "-o", plan.folder, "--force"});
      for (const std::string& text : plan.overrides) {
        words.emplace_back("--set");
        words.push_back(text);
      }
    }
    words.insert(words.end(), {"--quiet", "--threads", std::to_string(workers_.threads)});
    const int device = free_device();
    std::string visible;
    if (!workers_.devices.empty()) {
      const Device& chosen = workers_.devices[static_cast<std::size_t>(device)];
      words.insert(words.end(), {"--device", chosen.name});
      visible = chosen.visible;
    }
    if (workers_.allow_scripts) words.emplace_back("--allow-scripts");
    const pid_t process = start(words, environment_of(workers_.ranks, visible), log_of(run));
    for (Active& other : active_) other.alone = false;
    active_.push_back({run, process, device, Clock::now(), resume, active_.empty()});
  }

  static std::string program_for(int ranks) {
    return ranks > 1 ? fs::read_symlink(this_program).string() : this_program;
  }

  /// The device with the fewest runs.
  int free_device() const {
    std::vector<int> load(std::max<std::size_t>(workers_.devices.size(), 1), 0);
    for (const Active& run : active_) ++load[static_cast<std::size_t>(run.device)];
    return static_cast<int>(std::min_element(load.begin(), load.end()) - load.begin());
  }

  void collect() {
    for (std::size_t k = 0; k < active_.size();) {
      int status = 0;
      const Active ended = active_[k];
      if (::waitpid(ended.process, &status, WNOHANG) != ended.process) {
        ++k;
        continue;
      }
      active_.erase(active_.begin() + static_cast<std::ptrdiff_t>(k));
      finish(ended, WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status));
    }
  }

  void finish(const Active& ended, int exit_code) {
    constexpr int refused = 7;
    if (exit_code == refused && ended.resumed) {  // its checkpoint is no good
      launch(ended.run, false);
      return;
    }
    const int signal = StopSignals::received();
    if (signal == 0 && !ended.alone && lacked_memory(exit_code, log_of(ended.run))) {
      put_off(ended, exit_code);
      return;
    }
    FinishedRun& result = results_[ended.run];
    const bool passed_on = signal != 0 && exit_code == 128 + SIGUSR1;  // in the place of `signal`
    result.exit_code = passed_on ? 128 + signal : exit_code;
    result.wall = std::chrono::duration<double>(Clock::now() - ended.begin).count();
    if (result.complete()) {
      std::error_code ignored;
      fs::remove(log_of(ended.run), ignored);
    } else {
      result.message = told_error(log_of(ended.run), result.exit_code);
    }
    tell_(ended.run, result);
  }

  void put_off(const Active& ended, int exit_code) {
    at_once_ = std::clamp(static_cast<int>(active_.size()), 1, std::max(1, at_once_ - 1));
    FinishedRun result{exit_code, false,
                       std::chrono::duration<double>(Clock::now() - ended.begin).count(),
                       told_error(log_of(ended.run), exit_code), at_once_};
    waiting_.push_back(ended.run);
    tell_(ended.run, result);
  }

  const std::vector<PlannedRun>& runs_;
  const Workers& workers_;
  const std::function<void(std::size_t, const FinishedRun&)>& tell_;
  std::vector<FinishedRun> results_;
  std::deque<std::size_t> waiting_;
  int at_once_;
  std::vector<Active> active_;
};

/// Memory of a run. Ranks take 1.6 times a whole model each: measured with 20,000 and 60,000 linked
/// spheres on two and on four ranks.  [bytes]
double taken_by(double model, int ranks) {
  constexpr double own = 25e6, of_rank = 1.6;
  return ranks > 1 ? ranks * (own + of_rank * model) : own + model;
}

}  // namespace

bool FinishedRun::ended_mute() const {
  return !complete() && message.starts_with(mute_end(exit_code));
}

std::string log_beside(const std::string& folder) {
  return folder + ".log";
}

Workers workers_for(int asked, std::size_t runs, double bytes, int ranks) {
  const int cores = std::max(1, omp_get_num_procs());
  const double room = bytes > 0.0 ? available_memory() / taken_by(bytes, ranks) : 1e6;
  const int fit = static_cast<int>(std::clamp(room, 1.0, 1e6));
  Workers workers;
  workers.ranks = ranks;
  workers.jobs = std::min(asked > 0 ? asked : std::max(1, cores / ranks), fit);
  workers.jobs = std::clamp(workers.jobs, 1, std::max(1, static_cast<int>(runs)));
  workers.threads = asked > 0 ? 1 : std::max(1, cores / (workers.jobs * ranks));
  return workers;
}

std::vector<Device> gpus_for(int there, int ranks, const std::string& visible) {
  std::vector<Device> devices;
  if (ranks == 1) {
    for (int k = 0; k < there; ++k) devices.push_back({fmt::format("cuda:{}", k), ""});
    return devices;
  }
  std::vector<std::string> names;
  for (std::size_t at = 0; at < visible.size();) {
    const std::size_t end = std::min(visible.find(',', at), visible.size());
    names.push_back(visible.substr(at, end - at));
    at = end + 1;
  }
  for (int k = static_cast<int>(names.size()); k < there; ++k) names.push_back(std::to_string(k));
  const int each = std::clamp(ranks, 1, std::max(1, there));
  for (int first = 0; first + each <= there; first += each) {
    const auto begin = names.begin() + first;
    devices.push_back({"cuda", fmt::format("{}", fmt::join(begin, begin + each, ","))});
  }
  return devices;
}

std::vector<FinishedRun> run_side_by_side(
    const std::vector<PlannedRun>& runs, const Workers& workers,
    const std::function<void(std::size_t, const FinishedRun&)>& tell) {
  return Pool(runs, workers, tell).work();
}

}  // namespace breccia::laboratory
