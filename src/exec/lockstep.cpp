#include "exec/lockstep.hpp"

#include <setjmp.h>
#include <ucontext.h>

#include <array>
#include <cstdlib>
#include <memory>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define BR_TELLS_STACKS
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define BR_TELLS_STACKS
#endif
#if defined(BR_TELLS_STACKS)
#include <sanitizer/common_interface_defs.h>
#endif
#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

// A jump to another stack is what _FORTIFY_SOURCE takes for a fault: CMakeLists.txt switches that
// off here.
namespace breccia::lockstep {
namespace {

constexpr std::size_t stack_bytes = 64 * 1024;

/// Tells sanitizers of a stack before a jump leads there.
struct Stack {
  const void* bottom = nullptr;
  std::size_t size = 0;
  void* frames = nullptr;  ///< of AddressSanitizer's own making
#if defined(__SANITIZE_THREAD__)
  void* fiber = nullptr;  ///< ThreadSanitizer's record of it
#endif
};

/// One lane: where it stands, on its own stack, which it keeps from one run to the next.
struct Lane {
  jmp_buf place;
  bool started = false, ended = false;
  int exchanges = 0;
  std::unique_ptr<char[]> stack;
  Stack told;
};

/// The lanes of one thread of the processor.
struct Lanes {
  std::array<Lane, most_lanes> all;
  /// Two sets of numbers: a lane may be one exchange ahead of the others.
  std::array<std::array<double, most_lanes>, 2> numbers{};
  jmp_buf caller;
  Stack caller_told;
  Stack* on = nullptr;  ///< the stack that is in use
  ucontext_t begun;
  int count = 0, current = 0;
  void (*work)(void*, int) = nullptr;
  void* context = nullptr;

  Lane& operator[](int lane) { return all[static_cast<std::size_t>(lane)]; }
};
thread_local std::unique_ptr<Lanes> lanes_here;

void live();

/// Just before a jump. ThreadSanitizer counts calls and returns on each stack: none may lie
/// between.
[[gnu::always_inline]] inline void leave_for([[maybe_unused]] Lanes& lanes,
                                             [[maybe_unused]] Stack& next) {
#if defined(BR_TELLS_STACKS)
  Stack& now = *lanes.on;
  lanes.on = &next;
  __sanitizer_start_switch_fiber(&now.frames, next.bottom, next.size);
#endif
#if defined(__SANITIZE_THREAD__)
  __tsan_switch_to_fiber(next.fiber, 0);
#endif
}
/// Just after it.
void arrive([[maybe_unused]] Lanes& lanes) {
#if defined(BR_TELLS_STACKS)
  Stack from;
  __sanitizer_finish_switch_fiber(lanes.on->frames, &from.bottom, &from.size);
  if (lanes.caller_told.bottom == nullptr) {  // the first jump comes from there
    lanes.caller_told.bottom = from.bottom;
    lanes.caller_told.size = from.size;
  }
#endif
}

/// Goes on with a lane where it stands, or begins it. Does not return.
[[noreturn]] void go_on(Lanes& lanes, int number) {
  Lane& lane = lanes[number];
  lanes.current = number;
  if (lane.started) {
    leave_for(lanes, lane.told);
    _longjmp(lane.place, 1);
  }
  lane.started = true;
  lane.stack = std::make_unique<char[]>(stack_bytes);
  lane.told.bottom = lane.stack.get();
  lane.told.size = stack_bytes;
#if defined(__SANITIZE_THREAD__)
  lane.told.fiber = __tsan_create_fiber(0);
#endif
  getcontext(&lanes.begun);
  lanes.begun.uc_stack.ss_sp = lane.stack.get();
  lanes.begun.uc_stack.ss_size = stack_bytes;
  lanes.begun.uc_link = nullptr;
  makecontext(&lanes.begun, live, 0);
  leave_for(lanes, lane.told);
  setcontext(&lanes.begun);
  std::abort();  // setcontext has failed
}

/// A lane's work is done: another one goes on, or the caller if all have ended.
[[noreturn]] void leave(Lanes& lanes) {
  for (int next = 0; next < lanes.count; ++next)
    if (!lanes[next].ended) go_on(lanes, next);
  leave_for(lanes, lanes.caller_told);
  _longjmp(lanes.caller, 1);
}

/// The life of a lane: one work after the other.
void live() {
  arrive(*lanes_here);
  for (;;) {
    Lanes& lanes = *lanes_here;
    lanes.work(lanes.context, lanes.current);
    Lane& lane = lanes[lanes.current];
    lane.ended = true;
    if (_setjmp(lane.place) == 0) leave(lanes);
    arrive(*lanes_here);
  }
}

}  // namespace

void run(int lanes, void (*work)(void*, int), void* context) {
  if (!lanes_here) lanes_here = std::make_unique<Lanes>();
  Lanes& here = *lanes_here;
  here.count = lanes;
  here.work = work;
  here.context = context;
  for (Lane& lane : here.all) {
    lane.ended = false;
    lane.exchanges = 0;
  }
  here.on = &here.caller_told;
  here.caller_told = {};
#if defined(__SANITIZE_THREAD__)
  here.caller_told.fiber = __tsan_get_current_fiber();
#endif
  if (_setjmp(here.caller) == 0) go_on(here, 0);
  arrive(*lanes_here);
  lanes_here->current = 0;
}

int lane() {
  return lanes_here ? lanes_here->current : 0;
}

const double* exchange(double own) {
  Lanes& lanes = *lanes_here;
  Lane& lane = lanes[lanes.current];
  auto& numbers = lanes.numbers[static_cast<std::size_t>(lane.exchanges++ % 2)];
  numbers[static_cast<std::size_t>(lanes.current)] = own;
  const int next = (lanes.current + 1) % lanes.count;
  BR_ASSERT(!lanes[next].ended);  // all lanes meet equally often
  if (_setjmp(lane.place) == 0) go_on(lanes, next);
  arrive(lanes);
  return numbers.data();
}

}  // namespace breccia::lockstep
