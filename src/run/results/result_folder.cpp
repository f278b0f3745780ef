#include "run/results/result_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "exec/error.hpp"
#include "io/file.hpp"

namespace breccia {
namespace {

namespace fs = std::filesystem;

constexpr const char* lock_name = ".lock";

/// Everything a run writes into its folder.
constexpr std::array written_by_runs{"summary.json",     "case.toml",
                                     "history.csv",      "steps.csv",
                                     "log.jsonl",        "pictures",
                                     "fields",           "checkpoints",
                                     "result.pvd",       "elements.pvd",
                                     "links.pvd",        "contacts.pvd",
                                     "walls.pvd",        "contacts.hdf.series",
                                     "walls.hdf.series", "bolts.pvd",
                                     "bolts.hdf.series", "report.html",
                                     "curves.svg",       "render.png",
                                     "crash.br",         "elements.hdf.series",
                                     "links.hdf.series"};

bool holds_run(const std::string& path) {
  for (const char* name : {"summary.json", "history.csv", "checkpoints"})
    if (fs::exists(fs::path(path) / name)) return true;
  return false;
}

/// A case file where no run is: the user's own, which nothing may replace.
bool holds_input(const std::string& path) {
  return fs::exists(fs::path(path) / "case.toml") && !holds_run(path);
}

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  throw IoError(fmt::format("{}: cannot be written: {}", path, reason));
}

/// The locked file. @throws InputError if another process holds it
int lock(const std::string& path, int flags) {
  const std::string name = path + "/" + lock_name;
  const int file = ::open(name.c_str(), flags | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (file < 0) {
    if (errno == ENOENT && (flags & O_CREAT) == 0) return -1;
    fail(name, errno == ELOOP ? "it is a link" : std::strerror(errno));
  }
  if (::flock(file, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return file;
  std::array<char, 256> text{};
  const ssize_t length = ::read(file, text.data(), text.size() - 1);
  ::close(file);
  std::string owner(text.data(), length > 0 ? static_cast<std::size_t>(length) : 0);
  while (!owner.empty() && owner.back() == '\n') owner.pop_back();
  throw InputError(fmt::format("{}: another run writes into this folder{}; nothing was run", path,
                               owner.empty() ? "" : " (" + owner + ")"));
}

void note_owner(int file) {
  std::array<char, 200> host{};
  ::gethostname(host.data(), host.size() - 1);
  const std::string owner = fmt::format("process {} on {}\n", ::getpid(), host.data());
  // A lock without its owner's name still locks.
  if (::ftruncate(file, 0) != 0 || ::pwrite(file, owner.data(), owner.size(), 0) < 0) return;
}

/// Files that killed runs left behind here.
void remove_leftovers_of_runs(const std::string& path) {
  remove_leftovers(path);
  for (const char* folder : {"pictures", "fields", "checkpoints"})
    remove_leftovers(path + "/" + folder);
}

}  // namespace

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (!error && !fs::is_directory(path)) error = std::make_error_code(std::errc::not_a_directory);
  if (error) fail(path, error.message());
}

void ResultFolder::check_free(const std::string& path, Existing existing) {
  std::error_code error;
  if (fs::exists(path, error)) {
    if (!fs::is_directory(path, error)) fail(path, "it is not a folder");
    const int file = lock(path, O_RDWR);
    if (file >= 0) ::close(file);
    if (holds_input(path))
      throw InputError(path +
                       ": this folder holds a case.toml and no run; nothing was run\n"
                       "  -o names another folder for the results");
    if (existing == Existing::refuse && holds_run(path))
      throw InputError(
          fmt::format("{0}: this folder already holds a run; nothing was run\n"
                      "  'breccia resume {0}' goes on with it, --force replaces it, -o names "
                      "another folder",
                      path));
  }
  fs::path parent = fs::absolute(path).lexically_normal();
  while (!fs::exists(parent, error) && parent.has_relative_path()) parent = parent.parent_path();
  if (!fs::is_directory(parent, error)) fail(path, parent.string() + " is not a folder");
  if (::access(parent.c_str(), W_OK | X_OK) != 0) fail(path, std::strerror(errno));
}

ResultFolder ResultFolder::create(const std::string& path, Existing existing) {
  check_free(path, existing);
  make_folder(path);
  const int file = lock(path, O_RDWR | O_CREAT);
  note_owner(file);
  ResultFolder folder(path, file);
  if (existing == Existing::refuse && holds_run(path))
    throw InputError(path + ": another run just started in this folder; nothing was run");
  for (const char* name : written_by_runs) {
    std::error_code error;
    if (existing == Existing::replace) fs::remove_all(fs::path(path) / name, error);
    if (error) fail(folder.file(name), error.message());
  }
  remove_leftovers_of_runs(path);
  return folder;
}

ResultFolder ResultFolder::open(const std::string& path) {
  if (!fs::is_directory(path))
    throw IoError(fmt::format("{}: cannot be read: there is no such folder", path));
  if (!holds_run(path)) throw InputError(path + ": this folder holds no run; nothing was run");
  const int file = lock(path, O_RDWR | O_CREAT);
  note_owner(file);
  remove_leftovers_of_runs(path);
  return ResultFolder(path, file);
}

bool ResultFolder::is_locked(const std::string& path) {
  const int file = ::open((path + "/" + lock_name).c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (file < 0) return false;
  const bool locked = ::flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(file);
  return locked;
}

ResultFolder::ResultFolder(ResultFolder&& other) noexcept
    : path_(std::move(other.path_)), lock_(std::exchange(other.lock_, -1)) {}

ResultFolder::~ResultFolder() {
  if (lock_ >= 0) ::close(lock_);
}

}  // namespace breccia
