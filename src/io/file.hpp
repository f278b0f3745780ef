#pragma once
// The one door to files: every call to open, read, write, sync and rename a file is made here.
//
// Each failure is an IoError "path: cannot <what>: <reason>". Calls that a signal interrupts are
// continued; a failed sync is never tried again, since the system forgets what it could not write.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace breccia {

using Bytes = std::span<const std::byte>;

inline Bytes bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

/// An open regular file.
class File {
 public:
  enum class Use {
    read,
    create,  ///< there must be none
    append,  ///< makes it if there is none
    change,  ///< there must be one
  };

  /// Writes through no link that somebody has put in the place of the file.
  /// @param called  the file's name in messages; empty: its path
  /// @throws IoError if it cannot be opened, or is a folder, a pipe or a device
  File(const std::string& path, Use use, const std::string& called = "");
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File();

  std::uint64_t size() const;
  /// Fills `to` from `offset` on. Returns how many bytes there were: fewer only at the end.
  std::size_t read(std::span<std::byte> to, std::uint64_t offset) const;
  void write(Bytes bytes);
  /// Waits until the disk has everything.
  void sync();
  void cut(std::uint64_t size);
  /// Whether it still stands under the path that it was opened by.
  bool in_place() const;
  /// Tells of failures that a destructor would hide.
  void close();

 private:
  [[noreturn]] void fail(const char* what) const;

  std::string path_, called_;
  int file_ = -1;
};

/// Writes the pieces, one after the other, under a temporary name in the same folder that nobody
/// can guess, then renames it: under its name stands either the old file or the new one, whatever
/// happens to the program.
/// @throws IoError, also if something else than a regular file stands there: what was at `path` is
///         then untouched and nothing else is left
void replace_file(const std::string& path, std::span<const Bytes> pieces);

/// As replace_file, and what stands there survives a power cut: the disk has it, it was read back
/// and compared before it took its name, and the folder is synced. Refuses at once what the disk
/// has no room for.
void replace_durably(const std::string& path, std::span<const Bytes> pieces);

/// Writes over the bytes of a file, in the room that it has on the disk: a last resort where the
/// disk is too full for a second one. @throws IoError; what does not fit into that room is not
/// begun
void overwrite(const std::string& path, Bytes bytes);

/// Removes what a killed program left in the folder of files that it was replacing. Nobody else may
/// be writing there.
void remove_leftovers(const std::string& folder);

}  // namespace breccia
