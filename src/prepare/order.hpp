#pragma once
// Items of a model in another order.

#include <utility>
#include <vector>

#include "exec/filling.hpp"
#include "exec/plain_vector.hpp"

namespace breccia::prepare {

/// Item `order[i]` becomes item i.
template <class T>
void permute(std::vector<T>& items, const std::vector<Index>& order) {
  std::vector<T> permuted;
  permuted.reserve(items.size());
  for (const Index i : order) permuted.push_back(items[static_cast<std::size_t>(i)]);
  items.swap(permuted);
}

template <class T>
void permute(PlainVector<T>& items, const PlainVector<Index>& order, int threads) {
  PlainVector<T> permuted;
  permuted.resize(order.size());
  each_portion(threads, static_cast<Index>(order.size()), [&](Index begin, Index end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      permuted[i] = items[static_cast<std::size_t>(order[i])];
  });
  items.swap(permuted);
}

/// Elements of a mesh in this order, and its points in the order in which elements name them.
/// @param elements  corners of each: a member of the model  @returns new numbers of the points, -1:
/// no element has it
template <class Model, class Elements>
std::vector<Index> reorder_mesh(Model& model, Elements& elements, const std::vector<Index>& order) {
  permute(elements, order);
  permute(model.group, order);
  permute(model.material, order);
  permute(model.velocity, order);
  permute(model.strength, order);
  std::vector<Index> number(model.point.size(), -1), from;
  from.reserve(model.point.size());
  for (auto& corners : elements)
    for (Index& v : corners) {
      Index& now = number[static_cast<std::size_t>(v)];
      if (now < 0) {
        now = static_cast<Index>(from.size());
        from.push_back(v);
      }
      v = now;
    }
  permute(model.point, from);
  return number;
}

}  // namespace breccia::prepare
