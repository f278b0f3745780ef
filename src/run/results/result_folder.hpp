#pragma once
// The folder a run writes into: held by one run at a time, never overwritten by accident.

#include <string>

namespace breccia {

/// Choice about a run that a folder already holds.
enum class Existing { refuse, replace };

/// A result folder that this process has locked; the lock ends with the object or the process.
class ResultFolder {
 public:
  /// Tells, without writing anything, that a run could not start in the folder.
  /// @throws InputError if it holds a run (Existing::refuse) or another process runs in it,
  ///         IoError if it is not a folder or cannot be written
  static void check_free(const std::string& path, Existing existing);

  /// Makes the folder for a new run, locks it, removes what a former run left there
  /// (Existing::replace).
  /// @throws as check_free
  static ResultFolder create(const std::string& path, Existing existing);

  /// Locks the folder of a run that is to go on.
  /// @throws IoError if there is none, InputError if it holds no run or another process runs in it
  static ResultFolder open(const std::string& path);

  /// Whether a process runs in the folder now; false if that cannot be found out.
  static bool is_locked(const std::string& path);

  ResultFolder(ResultFolder&& other) noexcept;
  ResultFolder& operator=(ResultFolder&&) = delete;
  ~ResultFolder();

  const std::string& path() const { return path_; }
  /// The path of a file in the folder.
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  ResultFolder(const std::string& path, int lock) : path_(path), lock_(lock) {}
  std::string path_;
  int lock_;
};

/// Makes the folder and its parents if they do not exist. @throws IoError naming path and reason
void make_folder(const std::string& path);

}  // namespace breccia
