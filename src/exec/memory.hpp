#pragma once
// Raw memory of a space: the one place that allocates arrays and copies between spaces.

#include <cstddef>

#include "exec/space.hpp"

namespace breccia {

/// `bytes` of memory in `space`, aligned to 64 bytes. @throws std::bad_alloc
void* allocate(Space space, std::size_t bytes);
/// Whether so much memory of a space is zero as allocate() gives it: large arrays of the host take
/// their pages from the system as threads first write to them.
bool comes_zeroed(Space space, std::size_t bytes);
void release(Space space, void* memory) noexcept;
/// Address space for `bytes` of the host, aligned to pages: memory is taken page by page, as each
/// is first written to; peak_array_bytes() does not count it. Zero at first. @throws std::bad_alloc
void* reserve_memory(std::size_t bytes);
/// @param bytes  as they were reserved
void release_reserved(void* memory, std::size_t bytes) noexcept;
/// Copies between any two spaces; complete on return, or within a device before the next kernel.
void copy_bytes(void* to, Space to_space, const void* from, Space from_space, std::size_t bytes);
/// Reads what kernels are writing, without waiting for them: beside all other work of a device.
void peek_bytes(void* to, const void* from, Space from_space, std::size_t bytes);
/// Marks this point of all launches,
void mark_launches(Space space);
/// and reads what those before it leave, without waiting for those after it.
void peek_marked_bytes(void* to, const void* from, Space from_space, std::size_t bytes);
/// Sets every byte to zero.
void clear_bytes(void* memory, Space space, std::size_t bytes);
/// The largest sum of array memory of a space that was alive at one time in this process, or since
/// that was last forgotten.
std::size_t peak_array_bytes(Space space = Space::host);
void forget_peak_of_arrays(Space space = Space::host);

}  // namespace breccia
