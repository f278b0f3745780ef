#include "io/file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <filesystem>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace file_test {

namespace fs = std::filesystem;

std::string reason(const std::string& path, std::uint64_t limit) {
  try {
    read_whole_file(path, limit);
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

std::ptrdiff_t entries_of(const ScratchFolder& folder) {
  return std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator());
}

TEST(File, pieces_follow_each_other_and_replace_what_was_there) {
  const ScratchFolder folder;
  const std::string path = folder / "a", large(3'000'000, 'y');
  replace_durably(path, std::string("an older and longer text"));
  const Bytes pieces[] = {bytes_of("one, "), bytes_of(""), bytes_of("two"), bytes_of(large)};
  replace_durably(path, pieces);
  EXPECT_EQ(read_whole_file(path), "one, two" + large);
  replace_file(path, std::span(pieces).first(1));
  EXPECT_EQ(read_whole_file(path), "one, ");
  EXPECT_EQ(entries_of(folder), 1);
}

TEST(File, a_file_longer_than_the_limit_is_refused) {
  const ScratchFolder folder;
  const std::string path = folder / "a";
  replace_file(path, "12345");
  EXPECT_EQ(read_whole_file(path, 5), "12345");
  EXPECT_EQ(reason(path, 4), path + ": cannot read: it is longer than 4 bytes");
  EXPECT_GT(read_whole_file("/proc/self/maps").size(), 100U);  // a file that tells no size
  EXPECT_NE(reason("/proc/self/maps", 100), "");
}

TEST(File, pipes_folders_and_devices_are_refused_at_once) {
  const ScratchFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  for (const std::string& path : {folder / "pipe", folder.path(), std::string("/dev/zero")})
    EXPECT_EQ(reason(path, 10), path + ": cannot read: it is not a regular file");
  EXPECT_EQ(reason(folder / "none", 10), folder / "none: cannot read: No such file or directory");
}

TEST(File, what_the_disk_has_no_room_for_is_not_begun) {
  const ScratchFolder folder;
  const std::string path = folder / "a";
  const std::byte first{};
  const Bytes exabyte(&first, std::size_t{1} << 60);  // not there, and so never to be read
  try {
    replace_durably(path, {&exabyte, 1});
    FAIL() << "an exabyte was written";
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("are free on its disk"), std::string::npos);
  }
  EXPECT_EQ(entries_of(folder), 0);
}

std::string refusal_to_replace(const std::string& path) {
  try {
    replace_file(path, "new");
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

TEST(File, what_is_no_regular_file_is_never_replaced) {
  const ScratchFolder folder;
  const std::string pipe = folder / "pipe", link = folder / "link", inner = folder / "folder";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  ASSERT_EQ(::symlink("/dev/null", link.c_str()), 0);
  fs::create_directory(inner);
  EXPECT_EQ(refusal_to_replace(pipe), pipe + ": cannot write: it is a pipe");
  EXPECT_EQ(refusal_to_replace(link), link + ": cannot write: it is a link");
  EXPECT_EQ(refusal_to_replace(inner), inner + ": cannot write: it is a folder");
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(entries_of(folder), 3);
  const std::string device = folder / "device";  // made by those who may, as they may replace it
  if (::mknod(device.c_str(), S_IFCHR | 0600, ::makedev(1, 3)) != 0) return;
  EXPECT_EQ(refusal_to_replace(device), device + ": cannot write: it is a device");
  EXPECT_TRUE(fs::is_character_file(device));
}

}  // namespace file_test
}  // namespace breccia
