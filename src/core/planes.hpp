#pragma once
// Vectors stored by component: three planes of numbers, read and written in order by links and
// pairs.
//
// Neighbouring links are processed together (a warp, or the lanes of a processor's vector), so each
// component lies contiguous. Elements, which are gathered at random, keep whole vectors instead.

#include "exec/buffer.hpp"
#include "math/lanes.hpp"

namespace breccia {

template <class T>
struct PlanesView {
  View<T> items;  ///< the x plane, then y, then z
  Index stride = 0;

  BR_HD Vec3 operator[](Index i) const {
    return {items[i], items[stride + i], items[2 * stride + i]};
  }
  BR_HD void store(Index i, const Vec3& v) const {
    items[i] = static_cast<T>(v.x);
    items[stride + i] = static_cast<T>(v.y);
    items[2 * stride + i] = static_cast<T>(v.z);
  }
};

/// Vectors first, first + 1, ... of planes.
template <class R, class T>
BR_HD inline Vec3Of<R> load(const PlanesView<T>& planes, Index first) {
  const View<T>& items = planes.items;
  return {load<R>(items, first), load<R>(items, planes.stride + first),
          load<R>(items, 2 * planes.stride + first)};
}
/// Loads vectors where this call stands (load_now).
template <class R, class T>
BR_HD inline Vec3Of<R> load_now(const PlanesView<T>& planes, Index first) {
  const View<T>& items = planes.items;
  return {load_now<R>(items, first), load_now<R>(items, planes.stride + first),
          load_now<R>(items, 2 * planes.stride + first)};
}
template <class R, class T>
BR_HD inline void store(const PlanesView<T>& planes, Index first, const Vec3Of<R>& v) {
  store(planes.items, first, v.x);
  store(planes.items, planes.stride + first, v.y);
  store(planes.items, 2 * planes.stride + first, v.z);
}

/// An array of vectors, by component. Computed with in double, whatever they are stored in.
template <class Number>
class PlanesOf {
 public:
  using value_type = Vec3;
  explicit PlanesOf(Space space = Space::host) : items_(space) {}

  Space space() const { return items_.space(); }
  Index size() const { return stride_; }

  /// Keeps the first min(old, new) vectors; vectors beyond them are zero.
  void resize(Index size) {
    if (size == stride_) return;
    Buffer<Number> items(items_.space(), 3 * size);
    const Index kept = size < stride_ ? size : stride_;
    for (Index plane = 0; plane < 3; ++plane)
      if (kept > 0)
        copy_bytes(items.data() + plane * size, items.space(), items_.data() + plane * stride_,
                   items_.space(), static_cast<std::size_t>(kept) * sizeof(Number));
    items_.swap(items);
    stride_ = size;
  }

  PlanesView<Number> view() { return {items_.view(), stride_}; }
  PlanesView<const Number> view() const { return {items_.view(), stride_}; }

  const Buffer<Number>& items() const { return items_; }
  Buffer<Number>& items() { return items_; }

  friend void copy_to(PlanesOf& to, const PlanesOf& from) {
    copy_to(to.items_, from.items_);
    to.stride_ = from.stride_;
  }

 private:
  Buffer<Number> items_;
  Index stride_ = 0;
};
using Vec3Planes = PlanesOf<double>;

}  // namespace breccia
