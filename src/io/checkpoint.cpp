#include "io/checkpoint.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <limits>

#include "exec/error.hpp"

// The file, all numbers little-endian:
//   magic 8 | format version 4 | endian mark 4 | sections 8 | length of the table 8 | digest of the
//   table 16 table: for each section: name length 4, name, count 8, item bytes 8, offset 8, digest
//   16 the sections' bytes, each at its offset digest of everything before 16 | length of the file
//   8 | magic 8

namespace breccia {
namespace {

static_assert(std::endian::native == std::endian::little, "checkpoints are written as they lie");

constexpr std::array<char, 8> magic{'b', 'r', 'e', 'c', 'c', 'i', 'a', '\n'};
constexpr std::uint32_t format_version = 1;
constexpr std::uint32_t endian_mark = 0x01020304;
constexpr std::size_t header_bytes = 8 + 4 + 4 + 8 + 8 + 16;
constexpr std::size_t footer_bytes = 16 + 8 + 8;

using Bytes = std::vector<std::byte>;
using Digest = std::array<std::byte, 16>;

Digest digest(const std::byte* bytes, std::size_t size) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(bytes, size));
  Digest result;
  std::memcpy(result.data(), canonical.digest, sizeof canonical.digest);
  return result;
}

template <class T>
void append(Bytes& file, const T& item) {
  const auto* from = reinterpret_cast<const std::byte*>(&item);
  file.insert(file.end(), from, from + sizeof item);
}
void append(Bytes& file, const void* items, std::size_t size) {
  const auto* from = static_cast<const std::byte*>(items);
  file.insert(file.end(), from, from + size);
}

std::string reason() {
  return std::strerror(errno);
}

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

void write_all(int fd, const Bytes& bytes, const std::string& path) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::write(fd, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw IoError(path + ": cannot write: " + reason());
    done += static_cast<std::size_t>(count);
  }
}

Bytes read_all(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) throw IoError(path + ": cannot open: " + reason());
  struct stat about {};
  if (::fstat(file.get(), &about) != 0) throw IoError(path + ": cannot read: " + reason());
  if (!S_ISREG(about.st_mode)) throw IoError(path + ": is not a regular file");
  Bytes bytes(static_cast<std::size_t>(about.st_size));
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::read(file.get(), bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw IoError(path + ": cannot read: " + reason());
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  bytes.resize(done);
  return bytes;
}

void sync_folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.get() < 0 || ::fsync(opened.get()) != 0)
    throw IoError(folder + ": cannot sync: " + reason());
}

/// Reads numbers from verified bounds: no read goes past the end.
class Cursor {
 public:
  Cursor(const std::byte* bytes, std::size_t size, const std::string& path)
      : bytes_(bytes), size_(size), path_(path) {}
  template <class T>
  T take() {
    T item{};
    need(sizeof item);
    std::memcpy(&item, bytes_ + at_, sizeof item);
    at_ += sizeof item;
    return item;
  }
  std::string take_text(std::size_t size) {
    need(size);
    std::string text(reinterpret_cast<const char*>(bytes_ + at_), size);
    at_ += size;
    return text;
  }

 private:
  void need(std::size_t count) const {
    if (count > size_ - at_) throw CheckpointError(path_ + ": its table of sections is too short");
  }
  const std::byte* bytes_;
  std::size_t size_;
  std::size_t at_ = 0;
  const std::string& path_;
};

}  // namespace

void CheckpointWriter::section(const std::string& name, const void* items, std::size_t count,
                               std::size_t item_bytes) {
  Section section{name, Bytes(count * item_bytes), count, item_bytes};
  if (!section.bytes.empty()) std::memcpy(section.bytes.data(), items, section.bytes.size());
  sections_.push_back(std::move(section));
}

void CheckpointWriter::write(const std::string& path) const {
  std::size_t table_bytes = 0;
  for (const Section& s : sections_) table_bytes += 4 + s.name.size() + 8 + 8 + 8 + 16;
  Bytes table;
  std::uint64_t offset = header_bytes + table_bytes;
  for (const Section& s : sections_) {
    append(table, static_cast<std::uint32_t>(s.name.size()));
    append(table, s.name.data(), s.name.size());
    append(table, s.count);
    append(table, s.item_bytes);
    append(table, offset);
    append(table, digest(s.bytes.data(), s.bytes.size()));
    offset += s.bytes.size();
  }
  Bytes file;
  file.reserve(offset + footer_bytes);
  append(file, magic);
  append(file, format_version);
  append(file, endian_mark);
  append(file, static_cast<std::uint64_t>(sections_.size()));
  append(file, static_cast<std::uint64_t>(table.size()));
  append(file, digest(table.data(), table.size()));
  append(file, table.data(), table.size());
  for (const Section& s : sections_) append(file, s.bytes.data(), s.bytes.size());
  append(file, digest(file.data(), file.size()));
  append(file, static_cast<std::uint64_t>(file.size() + 16));
  append(file, magic);

  const std::string temporary = path + ".tmp";
  try {
    {
      const Descriptor out(
          ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
      if (out.get() < 0) throw IoError(temporary + ": cannot create: " + reason());
      write_all(out.get(), file, temporary);
      if (::fsync(out.get()) != 0) throw IoError(temporary + ": cannot sync: " + reason());
    }
    if (read_all(temporary) != file)
      throw IoError(temporary + ": what was read back is not what was written");
    if (::rename(temporary.c_str(), path.c_str()) != 0)
      throw IoError(path + ": cannot rename " + temporary + " to it: " + reason());
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  sync_folder_of(path);
}

CheckpointReader::CheckpointReader(const std::string& path) : path_(path), file_(read_all(path)) {
  const auto refuse = [&](const std::string& why) { throw CheckpointError(path_ + ": " + why); };
  if (file_.size() < header_bytes + footer_bytes)
    refuse(fmt::format("has {} bytes, a checkpoint has at least {}", file_.size(),
                       header_bytes + footer_bytes));
  Cursor header(file_.data(), header_bytes, path_);
  if (header.take<std::array<char, 8>>() != magic) refuse("is no checkpoint of Breccia");
  const auto version = header.take<std::uint32_t>();
  if (version != format_version)
    refuse(fmt::format("has format version {}, this program reads version {}", version,
                       format_version));
  if (header.take<std::uint32_t>() != endian_mark) refuse("was written with another byte order");
  const auto count = header.take<std::uint64_t>();
  const auto table_bytes = header.take<std::uint64_t>();
  const auto table_digest = header.take<Digest>();

  const std::size_t body = file_.size() - footer_bytes;
  Cursor footer(file_.data() + body, footer_bytes, path_);
  const auto file_digest = footer.take<Digest>();
  const auto length = footer.take<std::uint64_t>();
  if (footer.take<std::array<char, 8>>() != magic || length != file_.size())
    refuse(fmt::format("is cut short or has bytes to spare (it has {})", file_.size()));
  if (table_bytes > body - header_bytes) refuse("its table of sections is longer than the file");
  if (digest(file_.data() + header_bytes, table_bytes) != table_digest)
    refuse("its table of sections is damaged");

  Cursor table(file_.data() + header_bytes, table_bytes, path_);
  for (std::uint64_t k = 0; k < count; ++k) {
    Section section;
    section.name = table.take_text(table.take<std::uint32_t>());
    section.count = table.take<std::uint64_t>();
    section.item_bytes = table.take<std::uint64_t>();
    const auto offset = table.take<std::uint64_t>();
    const auto expected = table.take<Digest>();
    std::uint64_t bytes = 0, end = 0;
    if (__builtin_mul_overflow(section.count, section.item_bytes, &bytes) ||
        __builtin_add_overflow(offset, bytes, &end) || end > body ||
        section.count > static_cast<std::uint64_t>(std::numeric_limits<Index>::max()))
      refuse("section " + section.name + " reaches beyond the file");
    section.bytes = {file_.data() + offset, static_cast<std::size_t>(bytes)};
    if (digest(section.bytes.data(), section.bytes.size()) != expected)
      refuse("section " + section.name + " is damaged: its digest is not what was written");
    sections_.push_back(std::move(section));
  }
  if (digest(file_.data(), body) != file_digest) refuse("is damaged between its sections");
}

bool CheckpointReader::has(const std::string& name) const {
  return std::any_of(sections_.begin(), sections_.end(),
                     [&](const Section& s) { return s.name == name; });
}

const CheckpointReader::Section& CheckpointReader::section(const std::string& name) const {
  const auto found = std::find_if(sections_.begin(), sections_.end(),
                                  [&](const Section& s) { return s.name == name; });
  if (found == sections_.end()) throw CheckpointError(path_ + ": section " + name + " is missing");
  return *found;
}

const CheckpointReader::Section& CheckpointReader::section(const std::string& name,
                                                           std::size_t item_bytes) const {
  const Section& found = section(name);
  if (found.item_bytes != item_bytes)
    throw CheckpointError(fmt::format("{}: section {} has items of {} bytes, {} are expected",
                                      path_, name, found.item_bytes, item_bytes));
  return found;
}

std::string CheckpointReader::text(const std::string& name) const {
  const Section& found = section(name, 1);
  return {reinterpret_cast<const char*>(found.bytes.data()), found.bytes.size()};
}

void CheckpointReader::copy_items(void* to, const Section& from, std::uint64_t count,
                                  const std::string& name) {
  if (from.count != count)
    throw CheckpointError(
        fmt::format("section {} has {} items, {} are expected", name, from.count, count));
  if (!from.bytes.empty()) std::memcpy(to, from.bytes.data(), from.bytes.size());
}

std::string describe_checkpoint(const CheckpointReader& reader) {
  std::string text;
  if (reader.has("step") && reader.has("time"))
    text += fmt::format("step {}, t = {:.6e} s\n", reader.value<std::int64_t>("step"),
                        reader.value<double>("time"));
  std::uint64_t total = 0;
  for (const auto& s : reader.sections()) {
    text += fmt::format("  {:<28} {:>12} x {:>4} B\n", s.name, s.count, s.item_bytes);
    total += s.bytes.size();
  }
  return text + fmt::format("{} sections, {} bytes, every digest holds\n", reader.sections().size(),
                            total);
}

}  // namespace breccia
