#include "io/checkpoint.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include "exec/error.hpp"

namespace breccia {
namespace {

namespace fs = std::filesystem;

/// A folder that goes when the test ends.
class Folder {
 public:
  Folder() {
    std::string pattern = fs::temp_directory_path() / "breccia_checkpoint_XXXXXX";
    path_ = ::mkdtemp(pattern.data());
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { fs::remove_all(path_); }
  std::string operator/(const std::string& name) const { return path_ / name; }

 private:
  fs::path path_;
};

struct State {
  Buffer<double> mass;
  Buffer<Vec3> position;
  Buffer<std::uint8_t> fixed;
  Vec3Planes shear;
  Buffer<double> nothing;
  template <class Visit>
  void each_field(Visit&& field) {
    field("mass", "kg", mass);
    field("position", "m", position);
    field("fixed", "-", fixed);
    field("shear", "N", shear);
    field("nothing", "-", nothing);
  }
};

State example(Index count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  State s;
  s.mass.resize(count);
  s.position.resize(count);
  s.fixed.resize(count);
  s.shear.resize(count);
  for (Index i = 0; i < count; ++i) {
    s.mass.data()[i] = uniform(random);
    s.position.data()[i] = {uniform(random), uniform(random), uniform(random)};
    s.fixed.data()[i] = static_cast<std::uint8_t>(random() & 63U);
    s.shear.view().store(i, {uniform(random), uniform(random), uniform(random)});
  }
  return s;
}

void write_example(const std::string& path, Index count = 100, unsigned seed = 1) {
  CheckpointWriter writer;
  State s = example(count, seed);
  writer.value("step", std::int64_t{42});
  writer.value("time", 0.5);
  writer.text("case", "seed = 1\n");
  writer.fields("elements", s);
  writer.write(path);
}

std::vector<char> bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
void write_bytes(const std::string& path, const std::vector<char>& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

TEST(Checkpoint, every_kind_of_array_comes_back_to_the_bit) {
  const Folder folder;
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
  EXPECT_EQ(read.nothing.size(), 0);
  EXPECT_EQ(reader.value<std::int64_t>("step"), 42);
  EXPECT_EQ(reader.text("case"), "seed = 1\n");
  EXPECT_NE(describe_checkpoint(reader).find("step 42"), std::string::npos);
}

TEST(Checkpoint, the_same_state_gives_the_same_bytes) {
  const Folder folder;
  write_example(folder / "a.br");
  write_example(folder / "b.br");
  EXPECT_EQ(bytes_of(folder / "a.br"), bytes_of(folder / "b.br"));
}

TEST(Checkpoint, missing_sections_and_other_sizes_are_refused_by_name) {
  const Folder folder;
  write_example(folder / "a.br");
  const CheckpointReader reader(folder / "a.br");
  const auto message = [&](auto&& read) -> std::string {
    try {
      read();
    } catch (const CheckpointError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message([&] { reader.section("spin"); }).find("section spin is missing"),
            std::string::npos);
  EXPECT_NE(message([&] { reader.value<float>("time"); }).find("time has items of 8 bytes, 4"),
            std::string::npos);
  EXPECT_THROW(CheckpointReader(folder / "none.br"), IoError);
}

/// Any damage must be refused as a checkpoint, whatever it is.
void expect_refused(const std::string& path, const std::vector<char>& bytes, const char* what,
                    int n) {
  write_bytes(path, bytes);
  try {
    const CheckpointReader reader(path);
    FAIL() << what << " " << n << " was loaded";
  } catch (const CheckpointError&) {
  }
}

TEST(Checkpoint, no_damage_is_ever_loaded) {
  const Folder folder;
  write_example(folder / "good.br", 30);
  write_example(folder / "other.br", 30, 2);
  const std::vector<char> good = bytes_of(folder / "good.br"),
                          other = bytes_of(folder / "other.br");
  std::mt19937 random(7);
  const auto below = [&](std::size_t n) { return std::size_t{random()} % n; };
  const std::string path = folder / "bad.br";
  for (int n = 0; n < 6'000; ++n) {
    std::vector<char> bad = good;
    const char* what = "";
    switch (n % 6) {
      case 0:
        what = "bit flip";
        bad[below(bad.size())] ^= static_cast<char>(1U << below(8));
        break;
      case 1:
        what = "truncation";
        bad.resize(below(bad.size()));
        break;
      case 2: {
        what = "run of zeros";
        const std::size_t from = below(bad.size()),
                          to = std::min(bad.size(), from + 1 + below(200));
        std::fill(bad.begin() + static_cast<long>(from), bad.begin() + static_cast<long>(to), '\0');
        break;
      }
      case 3: {
        what = "splice";
        const std::size_t at = below(bad.size());
        bad.resize(at);
        bad.insert(bad.end(), other.begin() + static_cast<long>(at), other.end());
        break;
      }
      case 4: {
        what = "huge number";
        const std::uint64_t huge = std::uint64_t{1} << below(64);
        std::memcpy(bad.data() + below(bad.size() - 8), &huge, 8);
        break;
      }
      default:
        what = "appended bytes";
        bad.insert(bad.end(), 1 + below(100), 'x');
    }
    if (bad == good || bad == other) continue;
    expect_refused(path, bad, what, n);
    if (HasFatalFailure()) return;
  }
}

TEST(Checkpoint, a_full_disk_leaves_the_older_file_untouched) {
  const Folder folder;
  const std::string path = folder / "a.br";
  write_example(path, 10);
  const std::vector<char> before = bytes_of(path);
  const pid_t child = ::fork();
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{4096, 4096};
    ::setrlimit(RLIMIT_FSIZE, &small);
    try {
      write_example(path, 10'000);
    } catch (const IoError& error) {
      ::_exit(std::string(error.what()).find("a.br.tmp: cannot write") != std::string::npos ? 0
                                                                                            : 2);
    }
    ::_exit(1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(bytes_of(path), before);
  EXPECT_FALSE(fs::exists(path + ".tmp"));
}

TEST(Checkpoint, a_folder_that_cannot_be_written_is_named) {
  try {
    write_example("/proc/breccia/a.br");
    FAIL();
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("/proc/breccia/a.br.tmp"), std::string::npos);
  }
}

TEST(Checkpoint, a_kill_at_any_instant_leaves_the_last_acknowledged_state) {
  const Folder folder;
  const std::string path = folder / "a.br";
  std::mt19937 random(3);
  for (int trial = 0; trial < 60; ++trial) {
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

}  // namespace
}  // namespace breccia
