#pragma once
// A state on disk: sections of raw items, each with a digest, written so that a kill loses nothing.

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "core/fields.hpp"
#include "core/rare_array.hpp"
#include "io/digest.hpp"

namespace breccia {

/// Collects the sections of a checkpoint and writes them at once.
class CheckpointWriter {
 public:
  /// Arrays of the host. copied: they may change. left: they stay as they are, and
  /// where they are, until the writer has written; it holds no copy of them.
  enum class Arrays : std::uint8_t { copied, left };
  explicit CheckpointWriter(Arrays arrays = Arrays::copied) : arrays_(arrays) {}
  Arrays arrays() const { return arrays_; }

  /// A section of `count` items of `item_bytes` each; the bytes are copied.
  void section(const std::string& name, const void* items, std::size_t count,
               std::size_t item_bytes, Space space = Space::host);

  template <class T>
  void value(const std::string& name, const T& item) {
    static_assert(std::is_trivially_copyable_v<T>);
    section(name, &item, 1, sizeof(T));
  }
  void text(const std::string& name, const std::string& characters) {
    section(name, characters.data(), characters.size(), 1);
  }

  /// Every array of a state, as sections "<prefix>.<array>", in the order of its each_field. Of
  /// records that few items have: the places of these items, ascending, and for each member of a
  /// record a section "<prefix>.<member>".
  template <class State>
  void fields(const std::string& prefix, State& state) {
    state.each_field([&](const char* name, const char*, auto& array) {
      if constexpr (is_rare<std::remove_cvref_t<decltype(array)>>)
        write_records(prefix, name, array);
      else
        write_array(prefix + "." + name, array);
    });
  }

  /// All sections of another writer, as PREFIX<section>.
  void adopt(const std::string& prefix, CheckpointWriter other);

  /// Where two states that were collected alike differ first, as "elements.force, item 7 of 20";
  /// empty: nowhere.
  std::string first_difference(const CheckpointWriter& other) const;
  /// Of the named sections those that were collected.
  std::map<std::string, Digest> digests(const std::vector<std::string>& names) const;

  /// Writes by replace_durably of io/file.hpp: to a temporary name, synced, read back, renamed.
  /// @throws IoError naming path and reason; an older file at `path` is then untouched
  void write(const std::string& path) const;

 private:
  template <class T>
  void write_array(const std::string& name, const Buffer<T>& array) {
    const auto count = static_cast<std::size_t>(array.size());
    if (arrays_ == Arrays::left && array.space() == Space::host)
      sections_.push_back({name, {}, std::as_bytes(array.host()), count, sizeof(T)});
    else
      section(name, array.data(), count, sizeof(T), array.space());
  }
  template <class Number>
  void write_array(const std::string& name, const PlanesOf<Number>& array) {
    write_array(name, array.items());
  }
  template <class T>
  void write_records(const std::string& prefix, const char* name, const RareArray<T>& array) {
    const RareArray<T> host = host_copy(array);
    Buffer<Index> items;
    Buffer<T> records;
    host.list(items, records);
    section(prefix + "." + name, items.data(), at(items.size()), sizeof(Index));
    T::each_member([&](const char* member, const char*, auto of) {
      std::vector<std::remove_cvref_t<decltype(records.data()->*of)>> values;
      for (const T& record : records.host()) values.push_back(record.*of);
      section(prefix + "." + member, values.data(), values.size(), sizeof values[0]);
    });
  }

  struct Section {
    std::string name;
    std::vector<std::byte> own;  ///< copied bytes
    Bytes left;                  ///< where none are: an array that is left where it is
    std::uint64_t count = 0;
    std::uint64_t item_bytes = 0;

    Bytes bytes() const { return own.empty() ? left : Bytes(own); }
  };
  Arrays arrays_;
  std::vector<Section> sections_;
  friend class CheckpointReader;
};

/// Whether a file begins as checkpoints and models do, whatever its name.
bool is_checkpoint(const std::string& path);

/// A checkpoint that has been read and fully verified.
class CheckpointReader {
 public:
  /// Memory: the size of the file, asked for only after its frame and table have been verified.
  /// @throws IoError if the file cannot be read, CheckpointError naming what is wrong and the
  ///         section if it is damaged, truncated or of another version
  explicit CheckpointReader(const std::string& path);
  /// Reads what a writer holds, which must outlive it: a state that is kept in memory.
  explicit CheckpointReader(const CheckpointWriter& held);
  // The sections' bytes lie in the reader: it can be moved, not copied.
  CheckpointReader(CheckpointReader&&) = default;
  CheckpointReader& operator=(CheckpointReader&&) = default;

  struct Section {
    std::string name;
    std::uint64_t count = 0;
    std::uint64_t item_bytes = 0;
    Bytes bytes;
    Digest digest{};
  };
  /// The sections PREFIX<section> alone, as <section>; it reads what this one holds, which must
  /// outlive it.
  CheckpointReader below(const std::string& prefix) const;
  const std::vector<Section>& sections() const { return sections_; }
  bool has(const std::string& name) const;
  /// @throws CheckpointError if it is missing
  const Section& section(const std::string& name) const;
  /// @throws CheckpointError if it is missing or its items are not of `item_bytes`
  const Section& section(const std::string& name, std::size_t item_bytes) const;

  template <class T>
  T value(const std::string& name) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const Section& found = section(name, sizeof(T));
    T item{};
    copy_items(&item, found, 1);
    return item;
  }
  std::string text(const std::string& name) const;

  /// Fills every array of a state from the sections that CheckpointWriter::fields wrote.
  /// One that State::older_files_lack() keeps what it holds where the file has none. Older files
  /// hold records of all items, and no section that names those that have one.
  /// @throws CheckpointError if another is missing, or they are not equally long
  template <class State>
  void fields(const std::string& prefix, State& state) const {
    Index size = -1;
    state.each_field([&](const char* name, const char*, auto& array) {
      if constexpr (requires { State::older_files_lack(name); })
        if (State::older_files_lack(name) && !has(prefix + "." + name)) return;
      if constexpr (is_rare<std::remove_cvref_t<decltype(array)>>)
        return read_records(prefix, name, array, size);
      else
        read_array(prefix + "." + name, array);
      if (size >= 0 && array.size() != size) refuse_size(prefix, name, array.size(), size);
      size = array.size();
    });
  }

 private:
  CheckpointReader() = default;
  struct Frame;
  void read_table(const std::vector<std::byte>& bytes, const Frame& frame);
  void copy_items(void* to, const Section& from, std::uint64_t count) const;
  [[noreturn]] void refuse(const std::string& why) const;
  [[noreturn]] void refuse_size(const std::string& prefix, const std::string& name, Index size,
                                Index expected) const;
  template <class T>
  void read_array(const std::string& name, Buffer<T>& array) const {
    const Section& found = section(name, sizeof(T));
    Buffer<T> host;
    host.resize(static_cast<Index>(found.count));
    copy_items(host.data(), found, found.count);
    copy_to(array, host);
  }
  template <class Number>
  void read_array(const std::string& name, PlanesOf<Number>& array) const {
    const Section& found = section(name, sizeof(Number));
    if (found.count % 3 != 0) refuse("section " + name + " is not of whole vectors");
    array.resize(static_cast<Index>(found.count / 3));
    read_array(name, array.items());
  }

  /// @param size  of the state's other arrays
  template <class T>
  void read_records(const std::string& prefix, const char* name, RareArray<T>& array,
                    Index size) const {
    BR_ASSERT(size >= 0);
    const std::string listed = prefix + "." + name;
    Buffer<Index> items;
    if (has(listed)) {
      read_array(listed, items);
      refuse_places(listed, items.host(), size);
    } else {
      items.resize(size);
      for (Index i = 0; i < size; ++i) items.data()[i] = i;
    }
    Buffer<T> records(Space::host, items.size());
    T::each_member([&](const char* member, const char*, auto of) {
      using Value = std::remove_cvref_t<decltype(records.data()->*of)>;
      Buffer<Value> values;
      read_array(prefix + "." + member, values);
      if (values.size() != items.size()) refuse_size(prefix, member, values.size(), items.size());
      for (Index i = 0; i < items.size(); ++i) records.data()[i].*of = values.data()[i];
    });
    RareArray<T> host;
    host.resize(size);
    for (Index i = 0; i < items.size(); ++i) host.set(items.data()[i], records.data()[i]);
    copy_to(array, host);
  }
  /// Places that do not ascend or lead beyond `size`.
  void refuse_places(const std::string& name, std::span<const Index> places, Index size) const;

  std::string path_;
  std::vector<std::byte> file_;
  std::vector<Section> sections_;
};

}  // namespace breccia
