#pragma once
// Arrays whose numbers lead to items of other arrays.
//
// A method declares each of its own once, in each_relation(world, visit): migration renumbers by
// that list and lets items follow what they lead to, loading checks by it.

#include <cstring>
#include <vector>

#include "exec/buffer.hpp"

namespace breccia {

/// The target of a relation: elements (or triangles), which have new places wherever they change
/// ranks, or what lies alike on all ranks.
enum class RelationTo : std::uint8_t { elements, common };
/// Where its numbers come from: the model that the case builds, or the last search.
enum class RelationFrom : std::uint8_t { model, search };

/// An array of places in memory.
/// @tparam Array  Buffer<Index>, const or not
template <class Array>
struct Relation {
  const char* state;  ///< what has the array, as checkpoints name it
  const char* name;   ///< of the array
  Array& numbers;
  RelationFrom from;
  RelationTo to;
  Index count;     ///< of what it may lead to
  Index per_item;  ///< numbers of each of these: of triangles by their edges 3
  Index least;     ///< -1 where a number may lead nowhere, else 0

  bool holds(Index number) const { return number >= least && number < count * per_item; }
};

/// Where numbers lead to.
struct RelationEnd {
  RelationTo to;
  Index count;
  Index per_item = 1;
  Index least = 0;
};
template <class Array>
Relation<Array> relation(const char* state, const char* name, Array& numbers, RelationFrom from,
                         const RelationEnd& end) {
  return {state, name, numbers, from, end.to, end.count, end.per_item, end.least};
}

/// Elements get other numbers, where relations of a world on the host name them.
template <class World, class Number>
void renumber_relations(World& w, Number&& number) {
  each_relation(w, [&](const auto& r) {
    if (r.to != RelationTo::elements) return;
    if (r.per_item == 1)
      for (Index& n : r.numbers.host()) n = number(n);
    else
      for (Index& n : r.numbers.host()) n = r.per_item * number(n / r.per_item) + n % r.per_item;
  });
}

/// The arrays of one state that lead to elements, one number an item.
template <class World>
std::vector<const Index*> element_ends(const World& w, const char* state) {
  std::vector<const Index*> ends;
  each_relation(w, [&](const auto& r) {
    if (r.to == RelationTo::elements && r.per_item == 1 && std::strcmp(r.state, state) == 0)
      ends.push_back(r.numbers.data());
  });
  return ends;
}

/// Marks the elements that the model joins to others.
template <class World>
void mark_joined(const World& w, std::vector<std::uint8_t>& joined) {
  each_relation(w, [&](const auto& r) {
    if (r.to != RelationTo::elements || r.from != RelationFrom::model) return;
    for (const Index n : r.numbers.host())
      if (n >= 0) joined[static_cast<std::size_t>(n / r.per_item)] = 1;
  });
}

}  // namespace breccia
