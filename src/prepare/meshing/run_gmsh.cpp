#include "prepare/meshing/run_gmsh.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <vector>

#include "exec/error.hpp"
#include "io/whole_file.hpp"

extern char** environ;

namespace breccia::prepare {
namespace {

/// Runs a program and waits for it; what it prints goes to a file.
/// @returns its exit status, 128 and the signal's number if one ended it, or -1 and errno if it
///          could not be started
int run_program(std::vector<std::string> words, const std::string& output,
                const std::string& settings_folder) {
  std::vector<std::string> variables;  // no settings of the user: the same mesh for everyone
  for (char** v = environ; *v != nullptr; ++v)
    if (std::strncmp(*v, "GMSH_HOME=", 10) != 0 && std::strncmp(*v, "OMP_", 4) != 0)
      variables.emplace_back(*v);
  variables.push_back("GMSH_HOME=" + settings_folder);
  const auto pointers = [](std::vector<std::string>& texts) {
    std::vector<char*> list;
    for (std::string& text : texts) list.push_back(text.data());
    list.push_back(nullptr);
    return list;
  };
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, 1, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&files, 1, 2);
  pid_t process = 0;
  const int error = posix_spawnp(&process, words[0].c_str(), &files, nullptr,
                                 pointers(words).data(), pointers(variables).data());
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) {
    errno = error;
    return -1;
  }
  int status = 0;
  while (waitpid(process, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// The lines in which gmsh says what went wrong, or its last ones.
std::string complaint(const std::string& output) {
  std::vector<std::string> lines, errors;
  for (std::size_t at = 0; at < output.size();) {
    const std::size_t end = std::min(output.find('\n', at), output.size());
    const std::string line = output.substr(at, end - at);
    if (!line.empty()) lines.push_back(line);
    if (line.starts_with("Error")) errors.push_back(line);
    at = end + 1;
  }
  const std::vector<std::string>& said = errors.empty() ? lines : errors;
  std::string text;
  for (std::size_t k = said.size() > 5 ? said.size() - 5 : 0; k < said.size(); ++k)
    text += "\n    " + said[k];
  return text.empty() ? " without a word" : ":" + text;
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "breccia-mesh-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw IoError(fmt::format("{}: cannot make the folder: {}", name, std::strerror(errno)));
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string run_gmsh(const GmshTask& task, const TemporaryFolder& folder) {
  const std::string mesh = folder.file("mesh.msh"), output = folder.file("output.txt");
  const std::string &what = task.what, &program = task.program;
  std::vector<std::string> words{program,
                                 fmt::format("-{}", task.dimension),
                                 "-format",
                                 "msh41",
                                 "-bin",
                                 "-nt",
                                 "1",
                                 "-v",
                                 "2",
                                 "-setnumber",
                                 "Mesh.RandomSeed",
                                 std::to_string(task.seed % 2147483647 + 1)};
  if (task.edge > 0.0) words.insert(words.end(), {"-clmax", fmt::format("{}", task.edge)});
  words.insert(words.end(), {"-o", mesh, task.geo});
  const int status = run_program(words, output, folder.path());
  if (status == -1 && errno == ENOENT) throw InputError(no_mesher(what, program));
  if (status == -1)
    throw InputError(fmt::format("{}: cannot start {}: {}", what, program, std::strerror(errno)));
  const std::string said = read_whole_file(output);
  if (status != 0 || !std::filesystem::exists(mesh))
    throw InputError(
        fmt::format("{}: {} failed with status {}{}", what, program, status, complaint(said)));
  if (said.find("Error") != std::string::npos)
    throw InputError(fmt::format("{}: {} met an error{}", what, program, complaint(said)));
  const std::string content = read_whole_file(mesh);
  if (content.find("$Nodes") == std::string::npos)
    throw InputError(fmt::format("{}: {} made no mesh of it; does it draw a {}?", what, program,
                                 task.dimension == 2 ? "surface" : "volume"));
  return content;
}

std::string on_path(const std::string& program) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string file = folder + "/" + program;
    if (::access(file.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(file)) return file;
  }
  return "";
}

std::string no_mesher(const std::string& what, const std::string& program) {
  return fmt::format(
      "{} needs the program {} to make its mesh, and it is not installed; install it (Debian and "
      "Ubuntu: apt install gmsh), or use structured = true or shape = \"mesh\"",
      what, program);
}

}  // namespace breccia::prepare
