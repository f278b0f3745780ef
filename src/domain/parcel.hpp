#pragma once
// Arrays in a message, one after the other, each behind its length.

#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "domain/communicator.hpp"

namespace breccia {

inline void put_bytes(Message& message, const void* bytes, std::size_t count) {
  const std::size_t before = message.size();
  message.resize(before + count);
  if (count > 0) std::memcpy(message.data() + before, bytes, count);
}
template <class T>
void put_value(Message& message, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  put_bytes(message, &value, sizeof value);
}
template <class T>
void put_array(Message& message, const std::vector<T>& array) {
  static_assert(std::is_trivially_copyable_v<T>);
  put_value(message, array.size());
  put_bytes(message, array.data(), array.size() * sizeof(T));
}

/// Takes out of a message what was put in, in that order.
class Unpacking {
 public:
  explicit Unpacking(std::span<const std::byte> message) : rest_(message) {}

  std::span<const std::byte> bytes(std::size_t count) {
    const std::span<const std::byte> taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }
  template <class T>
  T value() {
    T value;
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }
  template <class T>
  std::vector<T> array() {
    std::vector<T> array(value<std::size_t>());
    const std::span<const std::byte> from = bytes(array.size() * sizeof(T));
    if (!array.empty()) std::memcpy(array.data(), from.data(), from.size());
    return array;
  }

 private:
  std::span<const std::byte> rest_;
};

}  // namespace breccia
