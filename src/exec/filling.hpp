#pragma once
// Large arrays that get their first values: threads of the host share the work, so that all of them
// take pages of its memory.

#include <algorithm>
#include <vector>

#include "exec/buffer.hpp"
#include "exec/tasks.hpp"

namespace breccia {

/// While one lives, this many threads clear large arrays of the host that this thread makes or
/// grows.
class ClearingThreads {
 public:
  explicit ClearingThreads(int threads);
  ClearingThreads(const ClearingThreads&) = delete;
  ClearingThreads& operator=(const ClearingThreads&) = delete;
  ~ClearingThreads();

 private:
  int before_;
};

/// visit(begin, end) for portions of [0, count), on up to `threads` host threads.
template <class Visit>
void each_portion(int threads, Index count, const Visit& visit) {
  constexpr Index portion = 4096;
  const Index whole = count / portion, rest = count % portion != 0 ? 1 : 0;
  for_each_task(threads, whole + rest, [&](int part) {
    visit(part * portion, part < whole ? (part + 1) * portion : count);
  });
}

/// Items of an array from `first` on get values of the host. There are so many.
template <class T>
void put_items(Buffer<T>& to, Index first, const std::vector<T>& items, int threads) {
  if (to.space() == Space::cuda) {
    copy_bytes(to.data() + first, to.space(), items.data(), Space::host, items.size() * sizeof(T));
    return;
  }
  each_portion(threads, static_cast<Index>(items.size()), [&](Index begin, Index end) {
    std::copy(items.data() + begin, items.data() + end, to.data() + first + begin);
  });
}

/// An array gets the values of a vector, which is empty then.
template <class T>
void hand_over(Buffer<T>& to, std::vector<T>& items, int threads) {
  to.resize(static_cast<Index>(items.size()));
  put_items(to, 0, items, threads);
  std::vector<T>().swap(items);
}

}  // namespace breccia
