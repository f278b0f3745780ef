#pragma once
// Output while the run goes on.

#include <functional>
#include <future>

namespace breccia {

/// Work that another thread does, one piece after the other, in the order in which it is given. On
/// a GPU that thread has a stream of its own.
class Background {
 public:
  Background() = default;
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;
  /// Waits for the last piece, whatever came of it.
  ~Background();

  /// Starts a piece once the one before has ended. @throws what that one threw; the new one is then
  /// not started
  void add(std::function<void()> work);
  /// Waits for the last piece. @throws what it threw
  void finish();

 private:
  std::future<void> running_;
};

}  // namespace breccia
