#include "run/results/result_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace result_folder_test {

namespace fs = std::filesystem;

TEST(ResultFolder, IsHeldByOneRunAtATime) {
  const ScratchFolder scratch;
  const ResultFolder folder = ResultFolder::create(scratch / "out", Existing::refuse);
  replace_file(scratch / "out/summary.json", "{}");
  EXPECT_THROW(ResultFolder::open(scratch / "out"), InputError);
  EXPECT_THROW(ResultFolder::create(scratch / "out", Existing::replace), InputError);
  EXPECT_THROW(ResultFolder::check_free(scratch / "out", Existing::replace), InputError);
}

TEST(ResultFolder, ThatHoldsARunIsRefusedUnlessItIsToBeReplaced) {
  const ScratchFolder scratch;
  { const ResultFolder folder = ResultFolder::create(scratch / "out", Existing::refuse); }
  replace_file(scratch / "out/summary.json", "{}");
  replace_file(scratch / "out/notes.txt", "mine");
  EXPECT_THROW(ResultFolder::create(scratch / "out", Existing::refuse), InputError);
  const ResultFolder folder = ResultFolder::create(scratch / "out", Existing::replace);
  EXPECT_FALSE(fs::exists(scratch / "out/summary.json"));
  EXPECT_TRUE(fs::exists(scratch / "out/notes.txt"));
}

TEST(ResultFolder, NeverReplacesACaseFileThatIsNotOfARun) {
  const ScratchFolder scratch;
  replace_file(scratch / "case.toml", "mine");
  EXPECT_THROW(ResultFolder::create(scratch.path(), Existing::refuse), InputError);
  EXPECT_THROW(ResultFolder::create(scratch.path(), Existing::replace), InputError);
  EXPECT_EQ(read_whole_file(scratch / "case.toml"), "mine");
}

TEST(ResultFolder, ThatCannotBeWrittenIsNamedWithTheReason) {
  const ScratchFolder scratch;
  replace_file(scratch / "file", "");
  for (const std::string& path : {scratch / "file", scratch / "file/out", std::string("/proc/out")})
    try {
      ResultFolder::create(path, Existing::refuse);
      ADD_FAILURE() << path << " was accepted";
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
    }
}

TEST(ResultFolder, WithoutARunIsLeftAlone) {
  const ScratchFolder scratch;
  EXPECT_THROW(ResultFolder::open(scratch.path()), InputError);
  EXPECT_TRUE(fs::is_empty(scratch.path()));
  EXPECT_THROW(ResultFolder::open(scratch / "none"), IoError);
}

TEST(ResultFolder, IsNotMadeByTheCheckBeforeARun) {
  const ScratchFolder scratch;
  ResultFolder::check_free(scratch / "a/b", Existing::refuse);
  EXPECT_FALSE(fs::exists(scratch / "a"));
}

}  // namespace result_folder_test
}  // namespace breccia
