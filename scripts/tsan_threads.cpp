// Functions that g++ calls for `#pragma omp`, on threads that ThreadSanitizer sees: GCC's libgomp
// waits by futexes of its own, which would make each loop a race. Linked before libgomp where
// BR_SANITIZE has "thread". Of OpenMP it knows what the program uses: parallel, for (static;
// dynamic once in a region), barrier.

#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace {

/// The threads of one parallel region.
struct Team {
  explicit Team(unsigned threads) : size(threads) {}

  void wait_for_all() {
    std::unique_lock lock(mutex);
    const long turn = turns;
    if (++waiting == size) {
      waiting = 0;
      ++turns;
      all_there.notify_all();
      return;
    }
    all_there.wait(lock, [&] { return turns != turn; });
  }

  /// Of the region's dynamic loop; the first thread that comes here sets it up.
  void begin_loop(long begin, long after, long by, long at_once) {
    const std::lock_guard lock(mutex);
    if (came++ == 0) {
      next = begin;
      end = after;
      step = by;
      chunk = at_once;
    }
    if (came > size) std::abort();  // a second loop, which none of this is made for
  }

  unsigned size, came = 0;
  std::atomic<long> next{0};  ///< iteration of a dynamic loop
  long end = 0, step = 1, chunk = 1;

 private:
  std::mutex mutex;
  std::condition_variable all_there;
  unsigned waiting = 0;
  long turns = 0;
};

thread_local Team* team = nullptr;
thread_local unsigned place = 0;

/// A thread that does one piece of work after the other.
class Worker {
 public:
  Worker() : thread_([this] { loop(); }) {}
  ~Worker() {
    hand(nullptr, nullptr, nullptr, 0);
    thread_.join();
  }

  void hand(void (*work)(void*), void* data, Team* of, unsigned at) {
    const std::lock_guard lock(mutex_);
    work_ = work;
    data_ = data;
    team_ = of;
    place_ = at;
    has_work_ = true;
    changed_.notify_all();
  }
  void wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !has_work_; });
  }

 private:
  void loop() {
    for (;;) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return has_work_; });
      if (work_ == nullptr) return;
      team = team_;
      place = place_;
      lock.unlock();
      work_(data_);
      lock.lock();
      has_work_ = false;
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  void (*work_)(void*) = nullptr;
  void* data_ = nullptr;
  Team* team_ = nullptr;
  unsigned place_ = 0;
  bool has_work_ = false;
  std::thread thread_;
};

void in_parallel(void (*work)(void*), void* data, Team& now) {
  thread_local std::vector<std::unique_ptr<Worker>> workers;  // of the thread that begins a region
  while (workers.size() + 1 < now.size) workers.push_back(std::make_unique<Worker>());
  Team* const former = team;
  const unsigned former_place = place;
  for (unsigned k = 1; k < now.size; ++k) workers[k - 1]->hand(work, data, &now, k);
  team = &now;
  place = 0;
  work(data);
  for (unsigned k = 1; k < now.size; ++k) workers[k - 1]->wait();
  team = former;
  place = former_place;
}

}  // namespace

extern "C" {

int omp_get_thread_num() {
  return static_cast<int>(place);
}
int omp_get_num_threads() {
  return team == nullptr ? 1 : static_cast<int>(team->size);
}

void GOMP_parallel(void (*work)(void*), void* data, unsigned threads, unsigned) {
  Team now(threads == 0 ? 2 : threads);
  in_parallel(work, data, now);
}
void GOMP_barrier() {
  if (team != nullptr) team->wait_for_all();
}

void GOMP_parallel_loop_nonmonotonic_dynamic(void (*work)(void*), void* data, unsigned threads,
                                             long begin, long end, long step, long chunk,
                                             unsigned) {
  Team now(threads == 0 ? 2 : threads);
  now.next = begin;
  now.end = end;
  now.step = step;
  now.chunk = chunk;
  in_parallel(work, data, now);
}
bool GOMP_loop_nonmonotonic_dynamic_next(long* begin, long* end) {
  const long ahead = team->chunk * team->step;
  *begin = team->next.fetch_add(ahead);
  const bool up = team->step > 0;
  if (up ? *begin >= team->end : *begin <= team->end) return false;
  *end = *begin + ahead;
  if (up ? *end > team->end : *end < team->end) *end = team->end;
  return true;
}
bool GOMP_loop_nonmonotonic_dynamic_start(long begin, long after, long step, long chunk, long* from,
                                          long* end) {
  team->begin_loop(begin, after, step, chunk);
  return GOMP_loop_nonmonotonic_dynamic_next(from, end);
}
void GOMP_loop_end_nowait() {}

}  // extern "C"
