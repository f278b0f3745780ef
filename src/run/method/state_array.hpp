#pragma once
// Arrays of a running simulation as other programs see them: numbers with a shape, where they lie.
//
// The lists are those of each_field, so that an array that a state carries is there by itself. On
// the host its numbers are the state's own; those of a device are copied first, unless they are
// wanted where they lie.

#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "core/fields.hpp"
#include "core/rare_array.hpp"
#include "math/mat3.hpp"
#include "math/vec.hpp"
#include "math/vec2.hpp"

namespace breccia {

enum class NumberType : std::uint8_t { float64, float32, int32, int16, uint8 };

template <class T>
constexpr NumberType number_type() {
  if constexpr (std::is_enum_v<T>) {
    return number_type<std::underlying_type_t<T>>();
  } else if constexpr (std::is_same_v<T, double>) {
    return NumberType::float64;
  } else if constexpr (std::is_same_v<T, float>) {
    return NumberType::float32;
  } else if constexpr (std::is_same_v<T, std::int32_t>) {
    return NumberType::int32;
  } else if constexpr (std::is_same_v<T, std::int16_t>) {
    return NumberType::int16;
  } else {
    static_assert(std::is_same_v<T, std::uint8_t>);
    return NumberType::uint8;
  }
}

/// A named array of the state: item i, component j is at data + i strides[0] + j strides[1] + ...
struct StateArray {
  std::string name, unit;
  NumberType type = NumberType::float64;
  const void* data = nullptr;          ///< null where only the name was asked for
  std::vector<std::int64_t> shape;     ///< items first
  std::vector<std::int64_t> strides;   ///<  [bytes]
  std::shared_ptr<const void> memory;  ///< that holds the numbers; null: the simulation does
  bool on_device = false;              ///< `data` is memory of the GPU in use
};

/// Where numbers of a device are wanted.
enum class Wanted : std::uint8_t { on_host, where_they_lie };

/// Numbers that make up one item of an array: their type and shape. Other items are not shown.
template <class T>
struct ItemLayout;
template <class T>
requires std::is_arithmetic_v<T> || std::is_enum_v<T>
struct ItemLayout<T> {
  using Number = T;
  static std::vector<std::int64_t> shape() { return {}; }
};
template <class R>
struct ItemLayout<Vec3Of<R>> {
  using Number = R;
  static std::vector<std::int64_t> shape() { return {3}; }
};
template <class R>
struct ItemLayout<Vec2Of<R>> {
  using Number = R;
  static std::vector<std::int64_t> shape() { return {2}; }
};
template <class R>
struct ItemLayout<QuaternionOf<R>> {
  using Number = R;
  static std::vector<std::int64_t> shape() { return {4}; }
};
template <class R>
struct ItemLayout<Sym2Of<R>> {
  using Number = R;
  static std::vector<std::int64_t> shape() { return {3}; }
};
template <class R>
struct ItemLayout<Sym3Of<R>> {
  using Number = R;
  static std::vector<std::int64_t> shape() { return {6}; }
};

/// Gathers the arrays of a world: all names, or the one array that is wanted.
class StateArrays {
 public:
  /// @param wanted  name of an array; empty: names, units and shapes of all, without data
  explicit StateArrays(std::string wanted, Wanted where = Wanted::on_host)
      : wanted_(std::move(wanted)), where_(where) {}

  std::vector<StateArray> found;

  bool wants(const std::string& name) const { return wanted_.empty() || name == wanted_; }

  /// The arrays of a state under a prefix such as "joints.".
  template <class State>
  void add_fields(const std::string& prefix, State& state) {
    state.each_field([&](const char* name, const char* unit, auto& array) {
      if constexpr (is_rare<std::remove_cvref_t<decltype(array)>>)
        add_records(prefix, array);
      else
        add(prefix + name, unit, array);
    });
  }
  template <class T>
  void add(const std::string& name, const char* unit, const Buffer<T>& array) {
    if constexpr (requires { ItemLayout<T>::shape(); }) add_part<T, T>(name, unit, array, 0);
  }
  /// Vectors by component: item i has its components a plane apart.
  template <class Number>
  void add(const std::string& name, const char* unit, const PlanesOf<Number>& planes) {
    if (!wants(name)) return;
    constexpr auto size = std::int64_t{sizeof(Number)};
    StateArray& array = place(name, unit, planes.items());
    array.type = number_type<Number>();
    array.shape = {planes.size(), 3};
    array.strides = {size, size * planes.size()};
  }
  /// The part of each item that begins `offset` bytes into it, `each` times in equal distances.
  template <class Part, class T>
  void add_part(const std::string& name, const char* unit, const Buffer<T>& items,
                std::size_t offset, std::int64_t each = 1, std::size_t distance = 0) {
    if (!wants(name)) return;
    using Layout = ItemLayout<Part>;
    constexpr auto size = std::int64_t{sizeof(typename Layout::Number)};
    StateArray& array = place(name, unit, items);
    array.type = number_type<typename Layout::Number>();
    if (array.data != nullptr) array.data = static_cast<const char*>(array.data) + offset;
    array.shape = {items.size()};
    array.strides = {sizeof(T)};
    if (each > 1) {
      array.shape.push_back(each);
      array.strides.push_back(static_cast<std::int64_t>(distance));
    }
    for (const std::int64_t count : Layout::shape()) {
      array.shape.push_back(count);
      array.strides.push_back(size);
    }
  }
  /// Values that are worked out when they are wanted: work() gives one an item.
  template <class Work>
  void add_found(const std::string& name, const char* unit, Index count, const Work& work) {
    using T = typename decltype(work())::value_type;
    if (!wants(name)) return;
    constexpr auto size = std::int64_t{sizeof(typename ItemLayout<T>::Number)};
    StateArray& array = found.emplace_back();
    array.name = name;
    array.unit = unit;
    array.type = number_type<typename ItemLayout<T>::Number>();
    array.shape = {count};
    array.strides = {sizeof(T)};
    for (const std::int64_t components : ItemLayout<T>::shape()) {
      array.shape.push_back(components);
      array.strides.push_back(size);
    }
    if (wanted_.empty()) return;
    const auto values = std::make_shared<decltype(work())>(work());
    array.data = values->data();
    array.memory = values;
  }

 private:
  /// The members of records, of all items.
  template <class T>
  void add_records(const std::string& prefix, const RareArray<T>& records) {
    T::each_member([&](const char* member, const char* unit, auto of) {
      using Value = std::remove_cvref_t<decltype(std::declval<const T&>().*of)>;
      if constexpr (requires { ItemLayout<Value>::shape(); })
        add_found(prefix + member, unit, records.size(), [&] {
          const RareArray<T> host = host_copy(records);
          std::vector<Value> values;
          values.reserve(static_cast<std::size_t>(host.size()));
          for (Index i = 0; i < host.size(); ++i) {
            const T* const record = host.find(i);
            values.push_back(record != nullptr ? record->*of : T{}.*of);
          }
          return values;
        });
    });
  }
  template <class T>
  StateArray& place(const std::string& name, const char* unit, const Buffer<T>& items) {
    StateArray& array = found.emplace_back();
    array.name = name;
    array.unit = unit;
    if (wanted_.empty()) return array;
    if (items.space() == Space::host || where_ == Wanted::where_they_lie) {
      array.data = items.data();
      array.on_device = items.space() == Space::cuda;
    } else {
      const auto copy = std::make_shared<Buffer<T>>(host_copy(items));
      array.data = copy->data();
      array.memory = copy;
    }
    return array;
  }

  std::string wanted_;
  Wanted where_;
};

}  // namespace breccia
