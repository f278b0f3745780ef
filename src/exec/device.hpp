#pragma once
// The GPU of this process: which one, how much memory, whether it still answers.

#include <cstddef>
#include <string>

namespace breccia {

/// A GPU as its driver describes it.
struct DeviceInfo {
  std::string name;
  std::size_t memory = 0;       ///< of the device  [B]
  std::size_t free_memory = 0;  ///< of it, not taken by anyone  [B]
};

/// GPUs that this process can use; 0 without CUDA.
int device_count();

/// Computes on GPU `number` from now on. A driver takes 0.2 s to get ready, in which this process
/// goes on. @throws DeviceError if this build has no CUDA
void use_device(int number);
/// Computes on GPU `turn` modulo how many there are: processes of a machine share them in turn.
void use_device_in_turn(int turn);
/// Waits until it is ready. @throws DeviceError if there is no such GPU (tells how many there are)
void await_device();

/// Number of the GPU that this process computes on; below 0: none.
int device_in_use();

/// Of the GPU in use. @throws DeviceError
DeviceInfo device_info();

/// Gives the GPU back what this process keeps of its memory and does not use.
void return_free_memory();

/// While one lives, launches and copies of this thread go on a second stream, beside those of the
/// run. Nothing where no GPU is in use.
class SecondStream {
 public:
  SecondStream();
  SecondStream(const SecondStream&) = delete;
  SecondStream& operator=(const SecondStream&) = delete;
  ~SecondStream();
};

/// Waits until the GPU has done all that this thread asked of it. @throws DeviceError if it went
/// wrong
void wait_for_device();

}  // namespace breccia
