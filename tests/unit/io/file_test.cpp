#include "io/file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace {

std::string reason(const std::string& path, std::uint64_t limit) {
  try {
    read_whole_file(path, limit);
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
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
  EXPECT_FALSE(std::filesystem::exists(path + ".tmp"));
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
  EXPECT_FALSE(std::filesystem::exists(path + ".tmp"));
}

}  // namespace
}  // namespace breccia
