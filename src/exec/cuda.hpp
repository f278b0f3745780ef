#pragma once
// Shared by all files that launch on a GPU: the stream of the run and the check of every call. Only
// files that a CUDA build compiles include this header.

#include <cuda_runtime.h>

namespace breccia {

/// The stream that all kernels and copies of this thread run on, in order: that of the run, or the
/// second one (SecondStream).
cudaStream_t device_stream();

/// Whether a launch may get ready while the one before it ends: from Hopper on.
bool launches_overlap();

/// @throws DeviceError with the driver's reason and what was tried
void check_device(cudaError_t result, const char* what);

}  // namespace breccia
