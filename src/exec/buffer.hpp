#pragma once
// Arrays that live in one space (Buffer) and what kernels see of them (View).

#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "exec/memory.hpp"
#include "exec/space.hpp"

namespace breccia {

/// Asserts what reading item i of an array asks for. Out of line, as nearly every line of a kernel
/// reads: it is called only where a first look at an index and a space does not suffice.
#if defined(BR_CHECKED) && !defined(__CUDA_ARCH__)
[[gnu::noinline]] inline void assert_readable(Index i, Index size, Space space) {
  BR_ASSERT(i >= 0 && i < size);
  BR_ASSERT(space == Space::host || inside_kernel());
}
#endif

/// An array as a kernel sees it: pointer, length and space. Reading is checked in checked builds.
template <class T>
struct View {
  T* data = nullptr;
  Index size = 0;
  Space space = Space::host;

  BR_HD T& operator[](Index i) const {
#if defined(BR_CHECKED) && !defined(__CUDA_ARCH__)
    if (static_cast<std::uint32_t>(i) >= static_cast<std::uint32_t>(size) || space != Space::host)
        [[unlikely]]
      assert_readable(i, size, space);
#endif
    return data[i];
  }
  BR_HD operator View<const T>() const  // NOLINT: a writable view reads as well
      requires(!std::is_const_v<T>) {
    View<const T> view;
    view.data = data;
    view.size = size;
    view.space = space;
    return view;
  }
};

/// A growing array of plain values in one space. New items are zero, unless a caller that writes
/// them all says so. Never shrinks its memory.
template <class T>
class Buffer {
  static_assert(std::is_trivially_copyable_v<T>, "arrays cross spaces by copying bytes");

 public:
  using value_type = T;

  explicit Buffer(Space space = Space::host) : space_(space) {}
  Buffer(Space space, Index size) : space_(space) { resize(size); }
  Buffer(const Buffer& other) : space_(other.space_) { assign(other); }
  Buffer(Buffer&& other) noexcept { swap(other); }
  Buffer& operator=(const Buffer& other) {
    if (this != &other) {
      Buffer copy(other);
      swap(copy);
    }
    return *this;
  }
  Buffer& operator=(Buffer&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Buffer() { release(space_, data_); }

  void swap(Buffer& other) noexcept {
    std::swap(space_, other.space_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

  Space space() const { return space_; }
  Index size() const { return size_; }
  bool empty() const { return size_ == 0; }

  /// Keeps the first min(old, new) items; items beyond them are zero.
  void resize(Index size) {
    const bool is_zero = grow(size);
    if (size > size_ && !is_zero)
      clear_bytes(data_ + size_, space_, static_cast<std::size_t>(size - size_) * sizeof(T));
    size_ = size;
  }
  /// Items beyond the old ones are for the caller to write: no page of their memory
  /// is taken here.
  void resize_unfilled(Index size) {
    reserve(size);
    size_ = size;
  }
  void reserve(Index capacity) { grow(capacity); }
  void clear() { size_ = 0; }
  /// Items beyond the end are what a kernel has written there, in memory that reserve() has got.
  void extend_to(Index size) {
    BR_ASSERT(size >= size_ && size <= capacity_);
    size_ = size;
  }

  View<T> view() { return make<T>(data_); }
  View<const T> view() const { return make<const T>(data_); }

  /// The items of an array of the host space; a kernel's array must be copied first.
  std::span<T> host() {
    BR_ASSERT(space_ == Space::host);
    return {data_, static_cast<std::size_t>(size_)};
  }
  std::span<const T> host() const {
    BR_ASSERT(space_ == Space::host);
    return {data_, static_cast<std::size_t>(size_)};
  }

  T* data() { return data_; }
  const T* data() const { return data_; }

 private:
  /// Makes room. Returns whether all of it beyond the items is known to be zero.
  bool grow(Index capacity) {
    if (capacity <= capacity_) return false;
    const Index grown = capacity > capacity_ + capacity_ / 2 ? capacity : capacity_ + capacity_ / 2;
    const std::size_t bytes = static_cast<std::size_t>(grown) * sizeof(T);
    T* larger = static_cast<T*>(allocate(space_, bytes));
    copy_bytes(larger, space_, data_, space_, static_cast<std::size_t>(size_) * sizeof(T));
    release(space_, data_);
    data_ = larger;
    capacity_ = grown;
    return comes_zeroed(space_, bytes);
  }
  void assign(const Buffer& other) {
    reserve(other.size_);
    size_ = other.size_;
    copy_bytes(data_, space_, other.data_, other.space_,
               static_cast<std::size_t>(size_) * sizeof(T));
  }
  template <class U>
  View<U> make(U* data) const {
    View<U> view;
    view.data = data;
    view.size = size_;
    view.space = space_;
    return view;
  }

  Space space_ = Space::host;
  T* data_ = nullptr;
  Index size_ = 0;
  Index capacity_ = 0;
};

/// So many items, which the caller writes.
template <class T>
Buffer<T> unfilled(Space space, Index size) {
  Buffer<T> items(space);
  items.resize_unfilled(size);
  return items;
}

/// The visible crossing between spaces: `to` gets the size and items of `from`, in its own space.
template <class T>
void copy_to(Buffer<T>& to, const Buffer<T>& from) {
  to.resize_unfilled(from.size());
  copy_bytes(to.data(), to.space(), from.data(), from.space(),
             static_cast<std::size_t>(from.size()) * sizeof(T));
}
template <class T, class Memory>
void copy_to(Buffer<T>& to, const std::vector<T, Memory>& from) {
  to.resize_unfilled(static_cast<Index>(from.size()));
  copy_bytes(to.data(), to.space(), from.data(), Space::host, from.size() * sizeof(T));
}
template <class T, class Memory>
void copy_to(std::vector<T, Memory>& to, const Buffer<T>& from) {
  to.resize(static_cast<std::size_t>(from.size()));
  copy_bytes(to.data(), Space::host, from.data(), from.space(), to.size() * sizeof(T));
}

}  // namespace breccia
