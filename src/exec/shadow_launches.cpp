#include "exec/shadow_launches.hpp"

#include <utility>

namespace breccia {
namespace {

thread_local bool is_open = false;
thread_local std::function<void()> last_work;

void do_last() {
  if (const auto work = std::exchange(last_work, nullptr)) work();
}

}  // namespace

ShadowLaunches::ShadowLaunches() {
  is_open = true;
}
ShadowLaunches::~ShadowLaunches() {
  do_last();
  is_open = false;
}

bool ShadowLaunches::open() {
  return is_open;
}

void ShadowLaunches::add(const std::function<void()>& read_ahead, std::function<void()> work) {
  if (read_ahead) read_ahead();
  do_last();
  last_work = std::move(work);
  if (!is_open) do_last();
}

}  // namespace breccia
