#pragma once
// Large arrays that get their first values: threads of the host share the work, so that all of them
// take pages of its memory.

#include <algorithm>
#include <vector>

#include "exec/buffer.hpp"
#include "exec/tasks.hpp"

namespace breccia {

/// While one lives, this many threads clear and copy large arrays of the host that this thread
/// makes, grows or copies.
class FillingThreads {
 public:
  explicit FillingThreads(int threads);
  FillingThreads(const FillingThreads&) = delete;
  FillingThreads& operator=(const FillingThreads&) = delete;
  ~FillingThreads();

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
  to.resize_unfilled(static_cast<Index>(items.size()));
  put_items(to, 0, items, threads);
  std::vector<T>().swap(items);
}

/// An array has the items item(0), item(1), ..., so many, and no others. Each is found by itself,
/// so any number of threads gives the same ones.
template <class T, class Item>
void fill_items(Buffer<T>& to, Index count, int threads, const Item& item) {
  to.clear();
  to.resize_unfilled(count);
  if (to.space() != Space::cuda) {
    T* const items = to.data();
    each_portion(threads, count, [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) items[i] = item(i);
    });
    return;
  }
  constexpr Index at_once = Index{1} << 20;
  std::vector<T> some(static_cast<std::size_t>(std::min(count, at_once)));
  for (Index first = 0; first < count; first += at_once) {
    some.resize(static_cast<std::size_t>(std::min(at_once, count - first)));
    each_portion(threads, static_cast<Index>(some.size()), [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) some[static_cast<std::size_t>(i)] = item(first + i);
    });
    put_items(to, first, some, threads);
  }
}

/// find(begin, end) for each of the runs, about as many as threads, that make up [0, count); what
/// they found, in the order of the runs. Where these begin must not matter for what follows.
template <class Find>
auto of_runs(int threads, Index count, const Find& find) {
  using Found = decltype(find(Index{0}, Index{0}));
  constexpr Index least = 4096;  // items of a run
  const int runs = std::max(1, std::min(threads, count / least));
  const auto first = [&](int run) {
    return static_cast<Index>(static_cast<std::int64_t>(count) * run / runs);
  };
  struct Run {
    Found found{};
  };
  std::vector<Run> of(static_cast<std::size_t>(runs));
  for_each_task(threads, runs, [&](int run) {
    of[static_cast<std::size_t>(run)].found = find(first(run), first(run + 1));
  });
  return of;
}

/// The least, or the largest, of first and all value(i), by a combination that takes one of two.
template <class T, class Value, class Combine>
T best_of(int threads, Index count, T first, const Value& value, const Combine& combine) {
  for (const auto& run : of_runs(threads, count, [&](Index begin, Index end) {
         T best = first;
         for (Index i = begin; i < end; ++i) best = combine(best, value(i));
         return best;
       }))
    first = combine(first, run.found);
  return first;
}

/// The numbers of [0, count) for which keep(i) holds, ascending.
template <class Keep>
Buffer<Index> numbers_where(int threads, Index count, const Keep& keep) {
  struct Kept {
    Index begin = 0, end = 0, kept = 0;
  };
  auto runs = of_runs(threads, count, [&](Index begin, Index end) {
    Kept run{begin, end, 0};
    for (Index i = begin; i < end; ++i) run.kept += keep(i) ? 1 : 0;
    return run;
  });
  Index all = 0;
  std::vector<Index> places;
  for (const auto& run : runs) {
    places.push_back(all);
    all += run.found.kept;
  }
  Buffer<Index> numbers = unfilled<Index>(Space::host, all);
  for_each_task(threads, static_cast<int>(runs.size()), [&](int k) {
    const auto run = static_cast<std::size_t>(k);
    Index* to = numbers.data() + places[run];
    for (Index i = runs[run].found.begin; i < runs[run].found.end; ++i)
      if (keep(i)) *to++ = i;
  });
  return numbers;
}

}  // namespace breccia
