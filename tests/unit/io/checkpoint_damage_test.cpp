#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <random>

#include "exec/error.hpp"
#include "io/checkpoint.hpp"
#include "unit/io/checkpoint_example.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace checkpoint_damage_test {

using namespace checkpoint_test;
using Content = std::vector<char>;

/// Reason why the reader refuses a content, empty if it loads it.
std::string refusal(const std::string& path, const Content& content) {
  write_content(path, content);
  try {
    const CheckpointReader reader(path);
    return "";
  } catch (const CheckpointError& error) {
    return error.what();
  }
}

/// Damages a content at random, in the ways of disks, networks and hands. Returns the way.
class Damage {
 public:
  explicit Damage(Content other) : other_(std::move(other)) {}

  const char* apply(Content& bad) {
    switch (below(8)) {
      case 0:
        bad[below(bad.size())] ^= static_cast<char>(1U << below(8));
        return "a flipped bit";
      case 1:
        bad.resize(below(bad.size()));
        return "a truncation";
      case 2: {
        const std::size_t from = below(bad.size());
        std::fill_n(bad.begin() + at(from), 1 + below(bad.size() - from), '\0');
        return "a run of zeros";
      }
      case 3: {
        const std::size_t pages = bad.size() / page;
        const auto first = bad.begin() + at(page * below(pages));
        std::swap_ranges(first, first + page, bad.begin() + at(page * below(pages)));
        return "swapped pages";
      }
      case 4: {
        const std::size_t cut = below(std::min(bad.size(), other_.size()));
        bad.resize(cut);
        bad.insert(bad.end(), other_.begin() + at(cut), other_.end());
        return "two halves of two files";
      }
      case 5: {
        const std::uint64_t huge = (std::uint64_t{random_()} << 32U | random_()) >> below(64);
        std::memcpy(bad.data() + below(bad.size() - 8), &huge, 8);
        return "an oversized number";
      }
      case 6: {
        const std::size_t from = below(bad.size() - 8);
        std::generate_n(bad.begin() + at(from), 1 + below(bad.size() - from),
                        [&] { return static_cast<char>(random_()); });
        return "a run of noise";
      }
      default:
        bad.insert(bad.end(), 1 + below(100), 'x');
        return "bytes to spare";
    }
  }

 private:
  static constexpr std::ptrdiff_t page = 4096;
  static std::ptrdiff_t at(std::size_t place) { return static_cast<std::ptrdiff_t>(place); }
  std::size_t below(std::size_t n) { return std::size_t{random_()} % n; }

  Content other_;
  std::mt19937 random_{7};
};

TEST(CheckpointDamage, twenty_thousand_damaged_files_are_all_refused) {
  const ScratchFolder folder;
  write_example(folder / "good.br", 300);
  write_example(folder / "other.br", 300, 2);
  const Content good = content_of(folder / "good.br"), other = content_of(folder / "other.br");
  ASSERT_GE(good.size(), 16'384U);
  Damage damage(other);
  struct rusage before {
  }, after{};
  ::getrusage(RUSAGE_SELF, &before);
  for (int n = 0; n < 20'000; ++n) {
    Content bad = good;
    const char* const way = damage.apply(bad);
    if (bad == good || bad == other) continue;
    const std::string why = refusal(folder / "bad.br", bad);
    ASSERT_EQ(why.find(folder / "bad.br: "), 0U) << way << ", trial " << n << ": " << why;
  }
  ::getrusage(RUSAGE_SELF, &after);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // which keep what was freed
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 20'000) << "kB more than before";
#endif
}

TEST(CheckpointDamage, each_byte_counts) {
  const ScratchFolder folder;
  write_example(folder / "good.br", 3);
  const Content good = content_of(folder / "good.br");
  for (std::size_t k = 0; k < good.size(); ++k) {
    Content bad = good;
    bad[k] ^= 0x10;
    ASSERT_NE(refusal(folder / "bad.br", bad), "") << "byte " << k;
  }
}

TEST(CheckpointDamage, a_damaged_section_is_named_with_both_digests) {
  const ScratchFolder folder;
  const double mass = 2.5;
  CheckpointWriter writer;
  writer.value("step", std::int64_t{7});
  writer.value("mass", mass);
  writer.write(folder / "a.br");
  Content bad = content_of(folder / "a.br");
  const auto* const bytes = reinterpret_cast<const char*>(&mass);
  const auto place = std::search(bad.begin(), bad.end(), bytes, bytes + sizeof mass);
  ASSERT_NE(place, bad.end());
  *place ^= 1;
  const Digest written = digest(std::as_bytes(std::span(&mass, 1)));
  const Digest found = digest(std::as_bytes(std::span(&*place, sizeof mass)));
  EXPECT_EQ(refusal(folder / "a.br", bad), folder / "a.br: section mass is damaged: digest " +
                                               digest_text(found) + ", expected " +
                                               digest_text(written));
}

/// Where numbers stand in the file; src/io/checkpoint.cpp draws it.
constexpr std::size_t head_bytes = 48, foot_bytes = 32, name_bytes = 4;

void put(Content& content, std::size_t place, const Digest& digest) {
  std::memcpy(content.data() + place, digest.data(), digest.size());
}

/// Gives a changed file digests of its table and of itself that hold.
void seal(Content& content, std::size_t table_bytes) {
  const Bytes all = std::as_bytes(std::span(content));
  put(content, 32, digest(all.subspan(head_bytes, table_bytes)));
  put(content, content.size() - foot_bytes, digest(all.first(content.size() - foot_bytes)));
}

TEST(CheckpointDamage, counts_sizes_and_offsets_are_checked_even_where_digests_hold) {
  const ScratchFolder folder;
  CheckpointWriter writer;
  const std::vector<double> items(5, 1.0);
  writer.section("a", items.data(), 5, 8);
  writer.section("b", items.data(), 3, 8);
  writer.write(folder / "good.br");
  const Content good = content_of(folder / "good.br");
  constexpr std::size_t entry = name_bytes + 1 + 3 * 8 + 16, table_bytes = 2 * entry;
  Content same = good;
  seal(same, table_bytes);
  ASSERT_EQ(same, good);

  std::vector<std::size_t> numbers{16, 24};  // sections, bytes of the table
  for (std::size_t section = 0; section < 2; ++section)
    for (std::size_t number = 0; number < 3; ++number)  // items, bytes an item, offset
      numbers.push_back(head_bytes + section * entry + name_bytes + 1 + 8 * number);
  for (const std::size_t place : numbers)
    for (unsigned bit = 0; bit < 64; ++bit) {
      Content bad = good;
      bad[place + bit / 8] ^= static_cast<char>(1U << bit % 8);
      seal(bad, table_bytes);
      ASSERT_NE(refusal(folder / "bad.br", bad), "") << "byte " << place << ", bit " << bit;
    }
  for (const std::size_t place : {head_bytes, head_bytes + entry})  // bytes of the name
    for (unsigned bit = 0; bit < 32; ++bit) {
      Content bad = good;
      bad[place + bit / 8] ^= static_cast<char>(1U << bit % 8);
      seal(bad, table_bytes);
      ASSERT_NE(refusal(folder / "bad.br", bad), "") << "byte " << place << ", bit " << bit;
    }
}

TEST(CheckpointDamage, items_that_multiply_to_a_small_number_of_bytes_are_refused) {
  const ScratchFolder folder;
  CheckpointWriter writer;
  writer.text("a", "12345678");
  writer.write(folder / "a.br");
  Content bad = content_of(folder / "a.br");
  const std::uint64_t item_bytes = (std::uint64_t{1} << 61) + 1;  // times 8: 8 modulo 2^64
  std::memcpy(bad.data() + head_bytes + name_bytes + 1 + 8, &item_bytes, 8);
  seal(bad, name_bytes + 1 + 3 * 8 + 16);
  EXPECT_NE(refusal(folder / "a.br", bad).find("section a has 8 items of 2305843009213693953"),
            std::string::npos);
}

TEST(CheckpointDamage, a_terabyte_of_nothing_is_refused_before_memory_is_asked_for) {
  const ScratchFolder folder;
  const std::string path = folder / "a.br";
  write_example(path);
  const Content good = content_of(path);
  constexpr std::uint64_t terabyte = std::uint64_t{1} << 40;
  std::filesystem::resize_file(path, terabyte);
  EXPECT_THROW(CheckpointReader{path}, CheckpointError);

  // Its frame holds and gives the table all the room.
  const std::uint64_t table_bytes = terabyte - head_bytes - foot_bytes;
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(24).write(reinterpret_cast<const char*>(&table_bytes), 8);
  file.seekp(static_cast<std::streamoff>(terabyte - 16));
  file.write(reinterpret_cast<const char*>(&terabyte), 8);
  file.write(good.data(), 8);  // the magic
  file.close();
  EXPECT_THROW(CheckpointReader{path}, CheckpointError);
}

}  // namespace checkpoint_damage_test
}  // namespace breccia
