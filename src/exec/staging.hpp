#pragma once
// Memory of the host through which bytes go to a device and come from it.

#include <cstddef>

#include "exec/space.hpp"

namespace breccia {

/// Bytes on the host, page-locked if they go to a GPU and back: such copies take the bus at its
/// full speed, and no detour. What they hold is for one journey: copies of this object begin empty.
class Staging {
 public:
  Staging() = default;
  Staging(const Staging&) {}
  Staging& operator=(const Staging& other) {
    if (this != &other) give_up();
    return *this;
  }
  Staging(Staging&& other) noexcept { swap(other); }
  Staging& operator=(Staging&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Staging() { give_up(); }

  /// At least so many bytes on the way to or from `space`; what lay here may be lost.
  /// @throws std::bad_alloc
  void make_room(Space space, std::size_t bytes);
  std::byte* data() const { return data_; }

 private:
  void give_up() noexcept;
  void swap(Staging& other) noexcept;

  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  Space beyond_ = Space::host;
};

}  // namespace breccia
