// Cost of ranks that wait for each other in every step, on a machine: threads, each on a processor
// of its own, do the same arithmetic in registers again and again, and go on when all have done it.
// No messages, no memory: what one thread takes over what each of them takes bounds the efficiency
// of any program whose ranks meet once a step of that length.
//
// Usage: g++ -O2 -std=c++20 -pthread bench/meetings.cpp -o meetings && ./meetings THREADS
// [MICROSECONDS [STRIDE]]
//   MICROSECONDS  of a step of one thread, default 200
//   STRIDE        thread r is bound to processor r * STRIDE, default 1; 0: wherever the system puts
//   it

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

struct alignas(64) Flag {
  std::atomic<int> done{0};  ///< steps
};

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

double arithmetic(long rounds) {
  double x[16], sum = 0.0;
  for (int i = 0; i < 16; ++i) x[i] = 1.0 + i;
  for (long k = 0; k < rounds; ++k)
    for (double& v : x) v = v * 0.9999999 + 1e-9;
  for (const double v : x) sum += v;
  return sum;
}

void bind_to(int processor) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<unsigned>(processor), &set);
  pthread_setaffinity_np(pthread_self(), sizeof set, &set);
}

/// @returns what the median thread takes for a step  [s]
double measure(int count, int stride, long rounds, bool meet) {
  constexpr int steps = 2000;
  std::vector<Flag> flags(static_cast<std::size_t>(count));
  std::vector<double> took(flags.size());
  std::vector<std::thread> threads;
  std::atomic<int> ready{0};
  for (std::size_t r = 0; r < flags.size(); ++r)
    threads.emplace_back([&, r] {
      if (stride > 0) bind_to(static_cast<int>(r) * stride);
      volatile double sink = arithmetic(rounds);
      ++ready;
      while (ready < count) {
      }
      const auto begin = Clock::now();
      for (int step = 1; step <= steps; ++step) {
        sink = sink + arithmetic(rounds);
        flags[r].done.store(step, std::memory_order_release);
        for (const Flag& other : flags)
          while (meet && other.done.load(std::memory_order_acquire) < step) {
          }
      }
      took[r] = seconds_since(begin) / steps;
    });
  for (std::thread& thread : threads) thread.join();
  std::nth_element(took.begin(), took.begin() + count / 2, took.end());
  return took[flags.size() / 2];
}

}  // namespace

int main(int count, char** texts) {
  if (count < 2) {
    std::fprintf(stderr, "usage: meetings THREADS [MICROSECONDS [STRIDE]]\n");
    return 1;
  }
  const int threads = std::max(1, std::atoi(texts[1]));
  const double wanted = count > 2 ? std::atof(texts[2]) : 200.0;
  const int stride = count > 3 ? std::atoi(texts[3]) : 1;
  constexpr long trial = 200000;
  const auto begin = Clock::now();
  volatile double sink = arithmetic(trial);
  sink = sink + 0.0;
  const long rounds = std::max(1L, static_cast<long>(wanted * 1e-6 / seconds_since(begin) * trial));
  for (int again = 0; again < 3; ++again) {
    const double alone = measure(1, stride, rounds, false);
    const double apart = measure(threads, stride, rounds, false);
    const double meeting = measure(threads, stride, rounds, true);
    std::printf(
        "%d threads, us a step: alone %.1f, side by side %.1f (%.2f), meeting %.1f (%.2f)\n",
        threads, 1e6 * alone, 1e6 * apart, alone / apart, 1e6 * meeting, alone / meeting);
  }
}
