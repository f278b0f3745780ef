#pragma once
// The program as a process of its own.

#include <sys/wait.h>
#include <unistd.h>

#include <string>

#include "paths.hpp"

namespace breccia {

/// Starts `breccia` by a shell with these arguments; both streams go to `output`.
/// @param first  commands of the shell before it, as in "ulimit -f 8;"
inline pid_t start_program(const std::string& arguments, const std::string& output = "/dev/null",
                           const std::string& first = "") {
  const std::string command =
      first + " exec '" + program + "' " + arguments + " > " + output + " 2>&1";
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    ::_exit(127);
  }
  return child;
}

/// The exit code, or minus the number of the signal that killed it.
inline int wait_for(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

}  // namespace breccia
