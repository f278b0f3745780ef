#pragma once
// Arrays of records that few items have: memory for those that have one alone.
//
// A joint that is whole keeps nothing of how it fails. Kernels make records: on the host there is
// address space for one of each item (reserve_memory() in exec/memory.hpp), so that none ever lacks
// room; on a device there is room for some more than there are. An item that finds none waits, with
// nothing done, until the host has made room.

#include <algorithm>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/pair_list.hpp"
#include "exec/buffer.hpp"

namespace breccia {

/// A RareArray as kernels see it.
template <class T>
struct RareView {
  template <class U>
  using Like = std::conditional_t<std::is_const_v<T>, const U, U>;

  View<Like<Index>>
      number;  ///< of each item: one more than the place of its record; 0: it has none
  View<T> record;
  Like<Index>* count = nullptr;  ///< of records

  /// The record of an item, or null.
  BR_HD T* find(Index i) const {
    const Index n = number[i];
    return n > 0 ? &record[n - 1] : nullptr;
  }
  /// A part of an item's record, as T{} has it where there is none. @tparam of  a member of T
  template <auto of>
  BR_HD auto part(Index i) const {
    const T* const found = find(i);
    return found != nullptr ? found->*of : T{}.*of;
  }
  /// The record of an item, made if there is none: by one thread. Null if there is no room: the
  /// item waits. Places of records depend on who came first, so that nothing may depend on them.
  BR_HD T* find_or_make(Index i) const requires(!std::is_const_v<T>) {
    if (T* const found = find(i)) return found;
    const Index place = take_place();
    if (place >= record.size) {
      number[i] = -1;
      return nullptr;
    }
    record[place] = T{};
    number[i] = place + 1;
    return &record[place];
  }
  BR_HD bool waits(Index i) const { return number[i] < 0; }
  BR_HD operator RareView<const T>() const  // NOLINT: a writable view reads as well
      requires(!std::is_const_v<T>) {
    return {number, record, count};
  }

 private:
  BR_HD Index take_place() const {
#if defined(__CUDA_ARCH__)
    return atomicAdd(count, 1);
#else
    return __atomic_fetch_add(count, 1, __ATOMIC_RELAXED);
#endif
  }
};

/// One part of the records of all items, to be read. @tparam of  a member of T
template <class T, auto of>
struct PartOfRecords {
  RareView<const T> records;
  BR_HD auto operator[](Index i) const { return records.template part<of>(i); }
};

/// Records of a device that there is room for beyond those that were made. Tests in Space::shadow
/// see items wait.
inline Index spare_records(Space space, Index size) {
  if (space == Space::shadow) return 4;
  return std::max(Index{1} << 18, size / 8);
}

/// An array of which most items have no record and read as T{}. What gives or moves records works
/// on the host alone.
template <class T>
class RareArray {
  static_assert(std::is_trivially_copyable_v<T>, "arrays cross spaces by copying bytes");

 public:
  using value_type = T;

  explicit RareArray(Space space = Space::host) : number_(space), count_(space) {}
  RareArray(const RareArray& other) : RareArray(other.space()) { copy_to(*this, other); }
  RareArray(RareArray&& other) noexcept { swap(other); }
  RareArray& operator=(RareArray other) noexcept {
    swap(other);
    return *this;
  }
  ~RareArray() { release_records(); }

  void swap(RareArray& other) noexcept {
    number_.swap(other.number_);
    count_.swap(other.count_);
    std::swap(record_, other.record_);
    std::swap(room_, other.room_);
  }

  Space space() const { return number_.space(); }
  Index size() const { return number_.size(); }
  bool empty() const { return number_.empty(); }
  /// Records that have been made.
  Index records() const { return std::min(asked_for(), room_); }
  /// Records that there is room for.
  Index room() const { return room_; }
  /// Whether items wait for room.
  bool is_short() const { return asked_for() > room_; }
  /// Makes room for at least so many more, where less than half of it is left or items wait; for no
  /// more than there are items. Views are of no use then.
  void make_room(Index more) {
    const bool waiting = is_short();
    const Index count = records();
    if (!waiting && room_ - count >= std::min(more / 2, size() - count)) return;
    hold(std::min(size(), count + std::max(more, count)));
    write_count(count);
  }

  void make_room_for_all() { hold(size()); }

  /// Keeps the first min(old, new) items; items beyond them have no record.
  void resize(Index size) {
    const bool shrinks = size < number_.size();
    number_.resize(size);
    count_.resize(1);
    hold(space() == Space::host ? size : std::min(size, spare_records(space(), size)));
    if (shrinks) settle();
  }

  RareView<T> view() { return {number_.view(), seen<T>(record_), count_.data()}; }
  RareView<const T> view() const { return {number_.view(), seen<const T>(record_), count_.data()}; }

  /// The record of an item, or null.
  const T* find(Index i) const {
    BR_ASSERT(space() == Space::host);
    return view().find(i);
  }
  T item(Index i) const {
    const T* const found = find(i);
    return found != nullptr ? *found : T{};
  }
  T& make(Index i) {
    BR_ASSERT(space() == Space::host);
    return *view().find_or_make(i);
  }
  /// Gives an item its record, if it is not that of items without.
  void set(Index i, const T& item) {
    const T none{};
    if (find(i) != nullptr || std::memcmp(&item, &none, sizeof item) != 0) make(i) = item;
  }

  /// The items with records unlike T{}, ascending, and these.
  void list(Buffer<Index>& items, Buffer<T>& records) const {
    const T none{};
    std::vector<Index> found;
    for (Index i = 0; i < size(); ++i)
      if (const T* const record = find(i);
          record != nullptr && std::memcmp(record, &none, sizeof none) != 0)
        found.push_back(i);
    copy_to(items, found);
    records.resize(items.size());
    for (Index k = 0; k < items.size(); ++k) records.data()[k] = *find(items.data()[k]);
  }

  /// The numbers of records may be given to other items; settle() must follow.
  Buffer<Index>& numbers() { return number_; }
  /// Puts records in the order of their items; those that no item has are gone.
  void settle() {
    if (count_.empty()) return;
    if (number_.empty()) return write_count(0);
    BR_ASSERT(space() == Space::host);
    RareArray settled;
    settled.resize(size());
    for (Index i = 0; i < size(); ++i)
      if (const T* const found = find(i)) settled.make(i) = *found;
    swap(settled);
  }

  friend void copy_to(RareArray& to, const RareArray& from) {
    const Index count = from.records();
    to.number_.resize(0);
    to.resize(from.size());
    copy_to(to.number_, from.number_);
    to.write_count(0);
    to.hold(count);
    copy_bytes(to.record_, to.space(), from.record_, from.space(), bytes(count));
    to.write_count(count);
    to.make_room(spare_records(to.space(), to.size()));
  }

 private:
  static std::size_t bytes(Index count) { return static_cast<std::size_t>(count) * sizeof(T); }
  template <class U>
  View<U> seen(U* records) const {
    View<U> view;
    view.data = records;
    view.size = room_;
    view.space = space();
    return view;
  }
  /// Records that were made, and items that found no room.
  Index asked_for() const {
    Index count = 0;
    if (count_.size() > 0) copy_bytes(&count, Space::host, count_.data(), space(), sizeof count);
    return count;
  }
  void write_count(Index count) {
    copy_bytes(count_.data(), space(), &count, Space::host, sizeof count);
  }
  void hold(Index room) {
    if (room <= room_) return;
    const Index count = records();
    void* const larger =
        space() == Space::host ? reserve_memory(bytes(room)) : allocate(space(), bytes(room));
    copy_bytes(larger, space(), record_, space(), bytes(count));
    release_records();
    record_ = static_cast<T*>(larger);
    room_ = room;
  }
  void release_records() noexcept {
    if (space() == Space::host)
      release_reserved(record_, bytes(room_));
    else
      release(space(), record_);
  }

  Buffer<Index> number_, count_;
  T* record_ = nullptr;
  Index room_ = 0;
};

/// Item i gets the record of the old item `source[i]`, or none where that is -1. On the host.
template <class T>
void gather(const Exec& exec, const Buffer<Index>& source, RareArray<T>& items) {
  gather(exec, source, items.numbers());
  items.settle();
}

template <class T>
RareArray<T> host_copy(const RareArray<T>& array) {
  RareArray<T> copy;
  copy_to(copy, array);
  return copy;
}

/// Whether an array is one of records that few items have: its type is RareArray.
template <class Array>
inline constexpr bool is_rare = false;
template <class T>
inline constexpr bool is_rare<RareArray<T>> = true;

}  // namespace breccia
