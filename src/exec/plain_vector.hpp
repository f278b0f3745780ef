#pragma once
// Vectors of plain values whose first values threads write.

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace breccia {

/// Memory for plain values; resize() leaves new ones to be written by the caller.
template <class T>
struct LeaveUnfilled : std::allocator<T> {
  static_assert(std::is_trivially_copyable_v<T>);
  template <class Other>
  struct rebind {
    using other = LeaveUnfilled<Other>;
  };
  LeaveUnfilled() = default;
  template <class Other>
  LeaveUnfilled(const LeaveUnfilled<Other>&) noexcept {}

  template <class Item>
  void construct(Item*) noexcept {}
  template <class Item, class... From>
  void construct(Item* at, From&&... from) {
    ::new (static_cast<void*>(at)) Item(std::forward<From>(from)...);
  }
};

/// A vector whose resize() takes memory alone: what is in new items is for the caller to write, so
/// that each page is first written to by the thread that fills it.
template <class T>
using PlainVector = std::vector<T, LeaveUnfilled<T>>;

}  // namespace breccia
