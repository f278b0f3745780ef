#include "io/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <limits>

#include "exec/error.hpp"
#include "io/file.hpp"

// The file, all numbers little-endian:
//   head    magic 8, format version 4, byte order mark 4, sections 8, bytes of the table 8,
//           digest of the table 16
//   table   for each section: bytes of the name 4, name, items 8, bytes an item 8, offset 8,
//           digest 16
//   body    the sections' bytes, in the order of the table, without gaps
//   foot    digest of everything before 16, bytes of the file 8, magic 8

namespace breccia {
namespace {

static_assert(std::endian::native == std::endian::little, "checkpoints are written as they lie");

using Magic = std::array<char, 8>;
constexpr Magic magic{'b', 'r', 'e', 'c', 'c', 'i', 'a', '\n'};
constexpr std::uint32_t format_version = 1;
constexpr std::uint32_t byte_order = 0x01020304;
constexpr std::size_t head_bytes = 8 + 4 + 4 + 8 + 8 + 16;
constexpr std::size_t foot_bytes = 16 + 8 + 8;
constexpr std::uint64_t longest_table = std::uint64_t{1} << 24;  ///< some 300,000 sections  [bytes]

void append(std::vector<std::byte>& file, Bytes bytes) {
  file.insert(file.end(), bytes.begin(), bytes.end());
}
template <class T>
void append_item(std::vector<std::byte>& file, const T& item) {
  append(file, std::as_bytes(std::span(&item, 1)));
}

/// Takes numbers and names from the front of bytes; `overrun` says that they had ended before.
struct Cursor {
  Bytes rest;
  bool overrun = false;

  Bytes take_bytes(std::size_t count) {
    overrun = overrun || count > rest.size();
    if (overrun) return {};
    const Bytes taken = rest.first(count);
    rest = rest.subspan(count);
    return taken;
  }
  template <class T>
  T take() {
    T item{};
    const Bytes taken = take_bytes(sizeof item);
    if (!taken.empty()) std::memcpy(&item, taken.data(), sizeof item);
    return item;
  }
  std::string take_text(std::size_t size) {
    const Bytes taken = take_bytes(size);
    return {reinterpret_cast<const char*>(taken.data()), taken.size()};
  }
};

std::string mismatch(const Digest& got, const Digest& expected) {
  return fmt::format("digest {}, expected {}", digest_text(got), digest_text(expected));
}

}  // namespace

bool is_checkpoint(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Magic begins{};
  file.read(begins.data(), begins.size());
  return file && begins == magic;
}

void CheckpointWriter::section(const std::string& name, const void* items, std::size_t count,
                               std::size_t item_bytes, Space space) {
  Section section{name, std::vector<std::byte>(count * item_bytes), {}, count, item_bytes};
  copy_bytes(section.own.data(), Space::host, items, space, section.own.size());
  sections_.push_back(std::move(section));
}

void CheckpointWriter::adopt(const std::string& prefix, CheckpointWriter other) {
  for (Section& s : other.sections_) {
    s.name = prefix + s.name;
    sections_.push_back(std::move(s));
  }
}

std::string CheckpointWriter::first_difference(const CheckpointWriter& other) const {
  for (std::size_t k = 0; k < std::max(sections_.size(), other.sections_.size()); ++k) {
    if (k >= sections_.size() || k >= other.sections_.size()) return "the number of arrays";
    const Section &here = sections_[k], &there = other.sections_[k];
    if (here.name != there.name || here.count != there.count)
      return fmt::format("the length of {}", here.name);
    const Bytes one = here.bytes(), other_one = there.bytes();
    const auto at = std::mismatch(one.begin(), one.end(), other_one.begin()).first;
    if (at != one.end())
      return fmt::format("{}, item {} of {}", here.name,
                         static_cast<std::size_t>(at - one.begin()) / here.item_bytes, here.count);
  }
  return {};
}

std::map<std::string, Digest> CheckpointWriter::digests(
    const std::vector<std::string>& names) const {
  std::map<std::string, Digest> found;
  for (const Section& s : sections_)
    if (std::find(names.begin(), names.end(), s.name) != names.end())
      found.emplace(s.name, digest(s.bytes()));
  return found;
}

void CheckpointWriter::write(const std::string& path) const {
  std::size_t table_bytes = 0;
  for (const Section& s : sections_) table_bytes += 4 + s.name.size() + 8 + 8 + 8 + 16;
  std::vector<std::byte> table;
  std::uint64_t offset = head_bytes + table_bytes;
  for (const Section& s : sections_) {
    append_item(table, static_cast<std::uint32_t>(s.name.size()));
    append(table, bytes_of(s.name));
    append_item(table, s.count);
    append_item(table, s.item_bytes);
    append_item(table, offset);
    append_item(table, digest(s.bytes()));
    offset += s.bytes().size();
  }
  std::vector<std::byte> head;
  append_item(head, magic);
  append_item(head, format_version);
  append_item(head, byte_order);
  append_item(head, static_cast<std::uint64_t>(sections_.size()));
  append_item(head, static_cast<std::uint64_t>(table.size()));
  append_item(head, digest(table));

  std::vector<Bytes> pieces{head, table};
  for (const Section& s : sections_) pieces.push_back(s.bytes());
  RunningDigest whole;
  for (const Bytes piece : pieces) whole.add(piece);
  std::vector<std::byte> foot;
  append_item(foot, whole.value());
  append_item(foot, offset + foot_bytes);
  append_item(foot, magic);
  pieces.emplace_back(foot);
  replace_durably(path, pieces);
}

/// Head and foot of the file, once they have been found to fit it.
struct CheckpointReader::Frame {
  std::uint64_t sections, table_bytes, body_end, length;
  Digest table, whole;
};

void CheckpointReader::refuse(const std::string& why) const {
  throw CheckpointError(path_ + ": " + why);
}

void CheckpointReader::refuse_size(const std::string& prefix, const std::string& name, Index size,
                                   Index expected) const {
  refuse(fmt::format("section {}.{} has {} items, the others of {} have {}", prefix, name, size,
                     prefix, expected));
}

void CheckpointReader::refuse_places(const std::string& name, std::span<const Index> places,
                                     Index size) const {
  for (std::size_t k = 0; k < places.size(); ++k)
    if (places[k] < (k > 0 ? places[k - 1] + 1 : 0) || places[k] >= size)
      refuse(fmt::format("section {} leads to {} (item {}), expected ascending places below {}",
                         name, places[k], k, size));
}

CheckpointReader::CheckpointReader(const std::string& path) : path_(path) {
  const File file(path, File::Use::read);
  const auto read = [&](std::span<std::byte> to, std::uint64_t offset) {
    if (file.read(to, offset) != to.size()) refuse("ended while it was read");
  };
  const std::uint64_t length = file.size();
  if (length < head_bytes + foot_bytes)
    refuse(
        fmt::format("has {} bytes, a checkpoint has at least {}", length, head_bytes + foot_bytes));

  std::array<std::byte, head_bytes> head_of_file;
  read(head_of_file, 0);
  Cursor head{head_of_file};
  if (head.take<Magic>() != magic) refuse("is no checkpoint of Breccia");
  if (const auto version = head.take<std::uint32_t>(); version != format_version)
    refuse(fmt::format("has format version {}, expected {}", version, format_version));
  if (head.take<std::uint32_t>() != byte_order) refuse("was written with another byte order");
  Frame frame{};
  frame.sections = head.take<std::uint64_t>();
  frame.table_bytes = head.take<std::uint64_t>();
  frame.table = head.take<Digest>();
  frame.length = length;
  frame.body_end = length - foot_bytes;

  std::array<std::byte, foot_bytes> foot_of_file;
  read(foot_of_file, frame.body_end);
  Cursor foot{foot_of_file};
  frame.whole = foot.take<Digest>();
  const auto written = foot.take<std::uint64_t>();
  if (foot.take<Magic>() != magic)
    refuse(
        fmt::format("is cut short: {} bytes, and the last are not those of a checkpoint", length));
  if (written != length) refuse(fmt::format("has {} bytes, expected {}", length, written));
  const std::uint64_t room = std::min(frame.body_end - head_bytes, longest_table);
  if (frame.table_bytes > room)
    refuse(fmt::format("has a table of sections of {} bytes, expected at most {}",
                       frame.table_bytes, room));

  std::vector<std::byte> table(static_cast<std::size_t>(frame.table_bytes));
  read(table, head_bytes);
  read_table(table, frame);

  file_.resize(static_cast<std::size_t>(length));
  read(file_, 0);
  const Bytes all = file_;
  std::uint64_t offset = head_bytes + frame.table_bytes;
  for (Section& s : sections_) {
    const std::uint64_t bytes = s.count * s.item_bytes;
    s.bytes = all.subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(bytes));
    offset += bytes;
    if (const Digest got = digest(s.bytes); got != s.digest)
      refuse("section " + s.name + " is damaged: " + mismatch(got, s.digest));
  }
  const Digest got = digest(all.first(static_cast<std::size_t>(frame.body_end)));
  if (got != frame.whole) refuse("is damaged: " + mismatch(got, frame.whole));
}

CheckpointReader::CheckpointReader(const CheckpointWriter& held) : path_("a state in memory") {
  for (const CheckpointWriter::Section& s : held.sections_)
    sections_.push_back({s.name, s.count, s.item_bytes, s.bytes()});
}

CheckpointReader CheckpointReader::below(const std::string& prefix) const {
  CheckpointReader part;
  part.path_ = path_;
  for (const Section& s : sections_)
    if (s.name.starts_with(prefix)) {
      part.sections_.push_back(s);
      part.sections_.back().name.erase(0, prefix.size());
    }
  return part;
}

void CheckpointReader::read_table(const std::vector<std::byte>& bytes, const Frame& frame) {
  if (const Digest got = digest(bytes); got != frame.table)
    refuse("its table of sections is damaged: " + mismatch(got, frame.table));
  Cursor table{bytes};
  std::uint64_t end = head_bytes + frame.table_bytes;
  for (std::uint64_t k = 0; k < frame.sections; ++k) {
    Section section;
    section.name = table.take_text(table.take<std::uint32_t>());
    section.count = table.take<std::uint64_t>();
    section.item_bytes = table.take<std::uint64_t>();
    const auto offset = table.take<std::uint64_t>();
    section.digest = table.take<Digest>();
    if (table.overrun)
      refuse(fmt::format("its table ends within section {} of {}", k + 1, frame.sections));
    if (offset != end)
      refuse(fmt::format("section {} begins at byte {}, expected {}", section.name, offset, end));
    std::uint64_t size = 0;
    if (__builtin_mul_overflow(section.count, section.item_bytes, &size) ||
        size > frame.body_end - end ||
        section.count > static_cast<std::uint64_t>(std::numeric_limits<Index>::max()))
      refuse(fmt::format("section {} has {} items of {} bytes, {} bytes are there", section.name,
                         section.count, section.item_bytes, frame.body_end - end));
    end += size;
    sections_.push_back(std::move(section));
  }
  if (!table.rest.empty() || end != frame.body_end)
    refuse(fmt::format("its {} sections end at byte {}, expected {}", frame.sections, end,
                       frame.body_end));
}

bool CheckpointReader::has(const std::string& name) const {
  return std::any_of(sections_.begin(), sections_.end(),
                     [&](const Section& s) { return s.name == name; });
}

const CheckpointReader::Section& CheckpointReader::section(const std::string& name) const {
  const auto found = std::find_if(sections_.begin(), sections_.end(),
                                  [&](const Section& s) { return s.name == name; });
  if (found == sections_.end()) refuse("section " + name + " is missing");
  return *found;
}

const CheckpointReader::Section& CheckpointReader::section(const std::string& name,
                                                           std::size_t item_bytes) const {
  const Section& found = section(name);
  if (found.item_bytes != item_bytes)
    refuse(fmt::format("section {} has items of {} bytes, expected {}", name, found.item_bytes,
                       item_bytes));
  return found;
}

std::string CheckpointReader::text(const std::string& name) const {
  const Section& found = section(name, 1);
  return {reinterpret_cast<const char*>(found.bytes.data()), found.bytes.size()};
}

void CheckpointReader::copy_items(void* to, const Section& from, std::uint64_t count) const {
  if (from.count != count)
    refuse(fmt::format("section {} has {} items, expected {}", from.name, from.count, count));
  if (!from.bytes.empty()) std::memcpy(to, from.bytes.data(), from.bytes.size());
}

}  // namespace breccia
