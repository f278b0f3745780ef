#include "exec/shadow_launches.hpp"

#include <utility>

namespace breccia {
namespace {

thread_local bool is_open = false;
thread_local std::function<void()> last_work;
thread_local std::vector<ShadowLaunches::Launch>* recorded = nullptr;

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

void ShadowLaunches::add(std::function<void()> read_ahead, std::function<void()> work) {
  if (recorded != nullptr) {
    recorded->push_back({std::move(read_ahead), std::move(work)});
    return;
  }
  if (read_ahead) read_ahead();
  do_last();
  last_work = std::move(work);
  if (!is_open) do_last();
}

ShadowLaunches::Recording::Recording(std::vector<Launch>& to) {
  recorded = &to;
}
ShadowLaunches::Recording::~Recording() {
  recorded = nullptr;
}

}  // namespace breccia
