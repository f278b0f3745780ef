#include "io/checkpoint.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <random>

#include "exec/error.hpp"
#include "unit/io/checkpoint_example.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace checkpoint_test {

namespace fs = std::filesystem;
using namespace checkpoint_test;

TEST(Checkpoint, every_kind_of_array_comes_back_to_the_bit) {
  const ScratchFolder folder;
  write_example(folder / "a.br");
  const CheckpointReader reader(folder / "a.br");
  State read;
  reader.fields("elements", read);
  State expected = example(100, 1);
  ASSERT_EQ(read.mass.size(), 100);
  EXPECT_EQ(0, std::memcmp(read.mass.data(), expected.mass.data(), 800));
  EXPECT_EQ(0, std::memcmp(read.position.data(), expected.position.data(), 2400));
  EXPECT_EQ(0, std::memcmp(read.fixed.data(), expected.fixed.data(), 100));
  EXPECT_EQ(read.shear.size(), 100);
  EXPECT_EQ(0, std::memcmp(read.shear.items().data(), expected.shear.items().data(), 2400));
  EXPECT_EQ(read.id.data()[99], 99);
  reader.fields("nothing", read);
  EXPECT_EQ(read.shear.size(), 0);
  EXPECT_EQ(reader.value<std::int64_t>("step"), 42);
  EXPECT_EQ(reader.text("case"), "seed = 1\n");
}

TEST(Checkpoint, the_same_state_gives_the_same_bytes) {
  const ScratchFolder folder;
  write_example(folder / "a.br");
  write_example(folder / "b.br");
  EXPECT_EQ(content_of(folder / "a.br"), content_of(folder / "b.br"));
}

template <class Read>
std::string refusal(const Read& read) {
  try {
    read();
  } catch (const CheckpointError& error) {
    return error.what();
  }
  return "";
}

TEST(Checkpoint, missing_sections_and_other_sizes_are_refused_by_name) {
  const ScratchFolder folder;
  const std::string path = folder / "a.br";
  write_example(path);
  const CheckpointReader reader(path);
  EXPECT_EQ(refusal([&] { reader.section("spin"); }), path + ": section spin is missing");
  EXPECT_EQ(refusal([&] { reader.value<float>("time"); }),
            path + ": section time has items of 8 bytes, expected 4");
  EXPECT_EQ(refusal([&] { reader.value<char>("case"); }),
            path + ": section case has 9 items, expected 1");
  EXPECT_THROW(CheckpointReader(folder / "none.br"), IoError);
}

/// A state that a later program has given another array.
struct LaterState : State {
  Buffer<double> seen;
  template <class Visit>
  void each_field(Visit&& field) {
    State::each_field(field);
    field("seen", "s", seen);
  }
  static bool older_files_lack(std::string_view array) { return array == "seen"; }
};

TEST(Checkpoint, what_older_files_lack_keeps_what_it_holds) {
  const ScratchFolder folder;
  write_example(folder / "a.br");
  LaterState later;
  copy_to(later.seen, std::vector<double>(100, -1.0));
  CheckpointReader(folder / "a.br").fields("elements", later);
  EXPECT_EQ(later.mass.size(), 100);
  EXPECT_EQ(later.seen.data()[99], -1.0);

  later.seen.data()[99] = 7.0;
  CheckpointWriter writer;
  writer.fields("elements", later);
  writer.write(folder / "b.br");
  later.seen.data()[99] = -1.0;
  CheckpointReader(folder / "b.br").fields("elements", later);
  EXPECT_EQ(later.seen.data()[99], 7.0);
}

/// Arrays that are left are written as they are then, copied ones as they were.
TEST(Checkpoint, arrays_that_are_left_where_they_are_are_not_copied) {
  const ScratchFolder folder;
  State s = example(10, 1);
  const double before = s.mass.data()[3];
  CheckpointWriter copied, left(CheckpointWriter::Arrays::left);
  copied.fields("elements", s);
  left.fields("elements", s);
  EXPECT_EQ(copied.first_difference(left), "");
  CheckpointWriter pair(CheckpointWriter::Arrays::left);
  pair.adopt("first.", left);
  s.mass.data()[3] = before + 1.0;
  EXPECT_EQ(copied.first_difference(left), "elements.mass, item 3 of 10");
  const auto mass_in = [&](const CheckpointWriter& writer, const std::string& prefix) {
    writer.write(folder / "a.br");
    State read;
    CheckpointReader(folder / "a.br").fields(prefix, read);
    return read.mass.data()[3];
  };
  EXPECT_EQ(mass_in(copied, "elements"), before);
  EXPECT_EQ(mass_in(left, "elements"), before + 1.0);
  EXPECT_EQ(mass_in(pair, "first.elements"), before + 1.0);
}

TEST(Checkpoint, a_state_whose_arrays_differ_in_length_is_refused) {
  const ScratchFolder folder;
  const std::string path = folder / "a.br";
  State s = example(10, 1);
  s.id.resize(9);
  CheckpointWriter writer;
  writer.fields("elements", s);
  writer.write(path);
  const CheckpointReader reader(path);
  EXPECT_EQ(refusal([&] { reader.fields("elements", s); }),
            path + ": section elements.id has 9 items, the others of elements have 10");
}

/// Runs `act` in a child process, which leaves with its result.
template <class Act>
int in_child(const Act& act) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(act());
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

std::ptrdiff_t entries_of(const ScratchFolder& folder) {
  return std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator());
}

constexpr int wrote = 1, refused_by_name = 2, something_else = 3;

int attempt(const std::string& path, Index count) {
  try {
    write_example(path, count, 2);
    return wrote;
  } catch (const IoError& error) {
    return std::string(error.what()).find(path) == 0 ? refused_by_name : something_else;
  } catch (...) {
    return something_else;
  }
}

TEST(Checkpoint, a_write_that_breaks_off_anywhere_leaves_the_older_file_untouched) {
  const ScratchFolder folder;
  const std::string path = folder / "a.br", elsewhere = folder / "b.br";
  write_example(path, 10);
  write_example(elsewhere, 100, 2);
  const std::vector<char> before = content_of(path);
  const std::size_t size = content_of(elsewhere).size();
  for (std::size_t limit = 0; limit < size; limit += 97) {
    const int status = in_child([&] {
      ::signal(SIGXFSZ, SIG_IGN);
      const rlimit small{limit, limit};
      ::setrlimit(RLIMIT_FSIZE, &small);
      return attempt(path, 100);
    });
    ASSERT_EQ(WEXITSTATUS(status), refused_by_name) << "after " << limit << " bytes";
    ASSERT_EQ(content_of(path), before) << "after " << limit << " bytes";
    ASSERT_EQ(entries_of(folder), 2) << "after " << limit << " bytes";
  }
}

TEST(Checkpoint, a_full_disk_leaves_the_older_file_untouched) {
  const ScratchFolder folder;
  // A disk of 1 MB in a name space of the child's own; where mounting is not allowed there is none.
  const int status = in_child([&] {
    if (::unshare(CLONE_NEWNS) != 0 ||
        ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        ::mount("tmpfs", folder.path().c_str(), "tmpfs", 0, "size=1m") != 0)
      return 0;
    const std::string path = folder / "a.br";
    write_example(path, 1000);
    const std::vector<char> before = content_of(path);
    if (attempt(path, 100'000) != refused_by_name) return 10;
    if (content_of(path) != before || entries_of(folder) != 1) return 11;
    return attempt(path, 1000) == wrote ? 0 : 12;
  });
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_TRUE(WIFEXITED(status));
}

TEST(Checkpoint, a_place_that_cannot_be_written_is_named) {
  const ScratchFolder folder;
  write_example(folder / "file", 1);
  EXPECT_EQ(attempt("/proc/breccia/a.br", 1), refused_by_name);
  EXPECT_EQ(attempt(folder / "file/a.br", 1), refused_by_name);
  fs::create_directories(folder / "a.br/inside");
  EXPECT_EQ(attempt(folder / "a.br", 1), refused_by_name);
  EXPECT_EQ(entries_of(folder), 2);  // "file" and "a.br"
}

TEST(Checkpoint, a_kill_at_any_instant_leaves_the_last_acknowledged_state) {
  const ScratchFolder folder;
  const std::string path = folder / "a.br";
  std::mt19937 random(3);
  for (int trial = 0; trial < 100; ++trial) {
    int acknowledged[2];
    ASSERT_EQ(::pipe(acknowledged), 0);
    const pid_t child = ::fork();
    if (child == 0) {
      for (std::int64_t n = 1;; ++n) {
        CheckpointWriter writer;
        State s = example(2000, 1);
        writer.value("n", n);
        writer.fields("elements", s);
        writer.write(path);
        if (::write(acknowledged[1], &n, sizeof n) < 0) ::_exit(1);
      }
    }
    ::usleep(5'000 + static_cast<unsigned>(random() % 20'000));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    ::close(acknowledged[1]);
    std::int64_t last = 0, n = 0;
    while (::read(acknowledged[0], &n, sizeof n) == sizeof n) last = n;
    ::close(acknowledged[0]);
    if (last == 0) continue;
    EXPECT_GE(CheckpointReader(path).value<std::int64_t>("n"), last);
  }
}

}  // namespace checkpoint_test
}  // namespace breccia
