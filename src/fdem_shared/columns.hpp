#pragma once
// Records of neighbours, by columns: how a kernel for one element or a pack reads and writes them.

#include <type_traits>

#include "math/lanes.hpp"

namespace breccia::fdem_shared {

/// Records first, first + 1, ... of doubles by columns: numbers[k] is number k of every record. On
/// a device a warp reads and writes those of its threads together.
template <class R, class Record>
struct Columns {
  static constexpr int count = sizeof(Record) / sizeof(double);
  R numbers[count];

  /// The reads begin,
  BR_HD void read(const View<const Record>& from, Index first) {
    if constexpr (width_of<R> == 1)
      records_.read(from, first);
    else
      gather_records(from, consecutive<R>(first), numbers);
  }
  /// and have ended.
  BR_HD void wait() {
    if constexpr (width_of<R> == 1) {
      const Record own = records_.own();
      __builtin_memcpy(numbers, &own, sizeof own);
    }
  }
  BR_HD static void write(const View<Record>& to, Index first, const R (&numbers)[count]) {
    if constexpr (width_of<R> == 1) {
      Record own;
      __builtin_memcpy(&own, numbers, sizeof own);
      wait_for_warp();
      WarpRecords<Record>::write(to, first, own);
    } else {
      store_records(to, first, numbers);
    }
  }

 private:
  struct Nothing {};
  [[no_unique_address]] std::conditional_t<width_of<R> == 1, WarpRecords<Record>, Nothing> records_;
};

}  // namespace breccia::fdem_shared
