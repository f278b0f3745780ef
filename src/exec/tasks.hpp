#pragma once
// Pieces of work of unlike length, shared out among threads as these become free.

#include <algorithm>
#include <exception>
#include <mutex>

namespace breccia {

/// task(i) for every i in [0, count), in any order, on up to `threads` host threads. Each writes
/// only what it owns. @throws what the task of the lowest number threw, once all have ended
template <class Task>
void for_each_task(int threads, int count, const Task& task) {
  std::exception_ptr error;
  int failed = count;
  std::mutex mutex;
  const auto one = [&](int i) {
    try {
      task(i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (i < failed) error = std::current_exception();
      failed = std::min(failed, i);
    }
  };
  const int several = std::min(threads, count);
#pragma omp parallel for schedule(dynamic, 1) num_threads(several) if (several > 1)
  for (int i = 0; i < count; ++i) one(i);
  if (error) std::rethrow_exception(error);
}

}  // namespace breccia
