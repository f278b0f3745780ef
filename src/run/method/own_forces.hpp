#pragma once
// Forces that a program which holds a simulation adds to those of its case, between two steps.
//
// At the end of a step all forces of that moment are known, and the next step begins by moving with
// them: what is added in between acts as any other force does. Its work is booked by halves, that
// of the way here and that of the way from here, as the leapfrog's own balance wants it.

#include <span>
#include <vector>

#include "core/on_host.hpp"
#include "exec/buffer.hpp"

namespace breccia {

struct OwnForces {
  std::vector<Index> items;     ///< places in the arrays: elements or triangles
  std::vector<double> numbers;  ///< those of item 0, then of item 1, ...  [N; in 2D N/m]
};

/// Calls work(items) where the host can write them.
template <class T, class Work>
void write_on_host(Buffer<T>& array, const Work& work) {
  if (array.space() == Space::host) return work(array.host());
  Buffer<T> copy = host_copy(array);
  work(copy.host());
  copy_to(array, copy);
}

/// Adds forces to an array of items of `Item`, which is numbers and nothing else.
template <class Item>
void add_to(Buffer<Item>& force, const OwnForces& own) {
  constexpr std::size_t each = sizeof(Item) / sizeof(double);
  write_on_host(force, [&](std::span<Item> items) {
    for (std::size_t i = 0; i < own.items.size(); ++i) {
      auto* const numbers =
          reinterpret_cast<double*>(&items[static_cast<std::size_t>(own.items[i])]);
      for (std::size_t k = 0; k < each; ++k) numbers[k] += own.numbers[each * i + k];
    }
  });
}

/// Books the work of forces along a way that items have come, and returns its sum.  [J; in 2D J/m]
/// @param work_along  of force i on its item
template <class Work>
double book_to(Buffer<double>& booked, const OwnForces& own, const Work& work_along) {
  double sum = 0.0;
  write_on_host(booked, [&](std::span<double> of) {
    for (std::size_t i = 0; i < own.items.size(); ++i) {
      const double work = work_along(i);
      of[static_cast<std::size_t>(own.items[i])] += work;
      sum += work;
    }
  });
  return sum;
}

}  // namespace breccia
