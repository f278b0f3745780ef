#include "exec/lockstep.hpp"

#include <setjmp.h>
#include <ucontext.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define BR_TELLS_STACKS
#endif
#if __has_feature(thread_sanitizer)
#define BR_TELLS_THREADS
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define BR_TELLS_STACKS
#elif defined(__SANITIZE_THREAD__)
#define BR_TELLS_THREADS
#endif
#if defined(BR_TELLS_STACKS)
#include <sanitizer/common_interface_defs.h>
#endif
#if defined(__x86_64__) && !defined(BR_TELLS_THREADS)
#define BR_SWITCHES
extern "C" void br_switch_stacks(void** from, void* to);
asm(R"(
  .text
  .p2align 4
  .globl br_switch_stacks
  .hidden br_switch_stacks
  .type br_switch_stacks, @function
br_switch_stacks:
  pushq %rbp
  pushq %rbx
  pushq %r12
  pushq %r13
  pushq %r14
  pushq %r15
  movq %rsp, (%rdi)
  movq %rsi, %rsp
  popq %r15
  popq %r14
  popq %r13
  popq %r12
  popq %rbx
  popq %rbp
  popq %rcx
  jmp *%rcx
  .size br_switch_stacks, .-br_switch_stacks
)");
#endif

// A jump to another stack is what _FORTIFY_SOURCE takes for a fault: CMakeLists.txt switches that
// off here.
namespace breccia::lockstep {
namespace {

constexpr std::size_t stack_bytes = 64 * 1024;

/// A stack, and the place on it to go on from. Of longjmp ThreadSanitizer expects that it stays on
/// its stack; swapcontext, which asks the kernel each time, it passes over: lanes are one thread.
/// On x86-64 the six registers that a call keeps lie on the stack itself, a tenth of longjmp's
/// work.
struct Stack {
#if defined(BR_SWITCHES)
  void* place = nullptr;  ///< top of the stack
#elif defined(BR_TELLS_THREADS)
  ucontext_t place;
#else
  jmp_buf place;
  ucontext_t first;  ///< where it begins
#endif
  bool begun = true;
  const void* bottom = nullptr;
  std::size_t size = 0;
  void* frames = nullptr;  ///< of AddressSanitizer's own making
};

/// One lane, on its own stack, which it keeps from one run to the next.
struct Lane {
  bool ended = false;
  int exchanges = 0;
  std::unique_ptr<char[]> memory;
  Stack stack;
};

/// The lanes of one thread of the processor.
struct Lanes {
  std::array<Lane, lanes> all;
  /// Two sets of numbers: a lane may be one exchange ahead of the others.
  std::array<std::array<double, lanes>, 2> numbers{};
  Stack caller;
  int current = 0;
  void (*work)(void*, int) = nullptr;
  void* context = nullptr;

  Lane& operator[](int lane) { return all[static_cast<std::size_t>(lane)]; }
};
thread_local std::unique_ptr<Lanes> owned_lanes;
constinit thread_local Lanes* lanes_here =
    nullptr;  ///< those; found without asking whether they are made

/// The first words on a stack after a jump.
void arrive([[maybe_unused]] Stack& here) {
#if defined(BR_TELLS_STACKS)
  const void* bottom = nullptr;
  std::size_t size = 0;
  __sanitizer_finish_switch_fiber(here.frames, &bottom, &size);
  Stack& caller = lanes_here->caller;
  if (caller.bottom == nullptr) {  // the first jump comes from there
    caller.bottom = bottom;
    caller.size = size;
  }
#endif
}

/// Leaves a stack for another, and returns when a jump leads back.
void jump(Stack& from, Stack& to) {
#if defined(BR_TELLS_STACKS)
  __sanitizer_start_switch_fiber(&from.frames, to.bottom, to.size);
#endif
#if defined(BR_SWITCHES)
  br_switch_stacks(&from.place, to.place);
#elif defined(BR_TELLS_THREADS)
  swapcontext(&from.place, &to.place);
#else
  if (_setjmp(from.place) == 0) {
    if (to.begun) _longjmp(to.place, 1);
    to.begun = true;
    setcontext(&to.first);
    std::abort();  // setcontext has failed
  }
#endif
  arrive(from);
}

/// The life of a lane: one work after the other. Then another lane goes on, or the caller if all
/// have ended.
void live() {
  arrive((*lanes_here)[lanes_here->current].stack);
  for (;;) {
    Lanes& here = *lanes_here;
    here.work(here.context, here.current);
    Lane& lane = here[here.current];
    lane.ended = true;
    int next = 0;
    while (next < lanes && here[next].ended) ++next;
    here.current = next < lanes ? next : 0;
    jump(lane.stack, next < lanes ? here[next].stack : here.caller);
  }
}

/// Makes the stack of a lane.
void make(Lane& lane) {
  lane.memory = std::make_unique<char[]>(stack_bytes);
  Stack& stack = lane.stack;
  stack.bottom = lane.memory.get();
  stack.size = stack_bytes;
  stack.begun = false;
#if defined(BR_SWITCHES)
  // Where six registers will be taken from, then the address to go on at, aligned as after a call.
  const auto top = reinterpret_cast<std::uintptr_t>(lane.memory.get() + stack_bytes) / 16 * 16;
  auto* const words = reinterpret_cast<void**>(top) - 8;
  std::fill_n(words, 8, nullptr);  // the last: nobody has called it
  words[6] = reinterpret_cast<void*>(&live);
  stack.place = words;
#else
#if defined(BR_TELLS_THREADS)
  ucontext_t& first = stack.place;
#else
  ucontext_t& first = stack.first;
#endif
  getcontext(&first);
  first.uc_stack.ss_sp = lane.memory.get();
  first.uc_stack.ss_size = stack_bytes;
  first.uc_link = nullptr;
  makecontext(&first, live, 0);
#endif
}

}  // namespace

void run(void (*work)(void*, int), void* context) {
  if (lanes_here == nullptr) {
    owned_lanes = std::make_unique<Lanes>();
    lanes_here = owned_lanes.get();
  }
  Lanes& here = *lanes_here;
  here.work = work;
  here.context = context;
  here.current = 0;
  for (int k = 0; k < lanes; ++k) {
    Lane& lane = here[k];
    if (!lane.memory) make(lane);
    lane.ended = false;
    lane.exchanges = 0;
  }
  here.caller.bottom = nullptr;
  jump(here.caller, here[0].stack);
}

int lane() {
  return lanes_here != nullptr ? lanes_here->current : 0;
}

const double* exchange(double own) {
  Lanes& here = *lanes_here;
  Lane& lane = here[here.current];
  auto& numbers = here.numbers[static_cast<std::size_t>(lane.exchanges++ % 2)];
  numbers[static_cast<std::size_t>(here.current)] = own;
  const int next = here.current + 1 < lanes ? here.current + 1 : 0;
  BR_ASSERT(!here[next].ended);  // all lanes meet equally often
  here.current = next;
  jump(lane.stack, here[next].stack);
  return numbers.data();
}

}  // namespace breccia::lockstep
