#include "run/machine/background.hpp"

#include <utility>

#include "exec/device.hpp"

namespace breccia {

Background::~Background() {
  if (running_.valid()) running_.wait();
}

void Background::add(std::function<void()> work) {
  finish();
  running_ = std::async(std::launch::async, [work = std::move(work)] {
    const SecondStream stream;
    work();
  });
}

void Background::finish() {
  if (running_.valid()) running_.get();
}

}  // namespace breccia
