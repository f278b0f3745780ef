#pragma once
// Types of numbers that a run stores in double or in single precision, as its case says.

#include <string>
#include <type_traits>

#include "exec/space.hpp"
#include "exec/types.hpp"
#include "math/single.hpp"

namespace breccia {

/// The word of a case for it.
inline Precision precision_of(const std::string& word) {
  return word == "mixed"    ? Precision::mixed
         : word == "single" ? Precision::single
                            : Precision::full;
}

inline Exec in_precision(Exec exec, const std::string& word) {
  exec.precision = precision_of(word);
  return exec;
}

inline const char* word_of(Precision precision) {
  return precision == Precision::mixed    ? "mixed"
         : precision == Precision::single ? "single"
                                          : "double";
}

/// A state in the one or the other precision: one of the two is empty.
template <template <class> class StateOf>
struct Stored {
  StateOf<double> in_double;
  StateOf<float> in_single;

  template <class Number>
  auto& as() {
    if constexpr (std::is_same_v<StoredAs<Number>, float>)
      return in_single;
    else
      return in_double;
  }
  template <class Number>
  const auto& as() const {
    if constexpr (std::is_same_v<StoredAs<Number>, float>)
      return in_single;
    else
      return in_double;
  }
};

/// A record read back from memory. Where numbers are rounded to single precision and widened
/// again g++ 12 drops the rounding of some of a record, others with other flags or neighbours.
template <class Record>
BR_HD const Record& as_in_memory(Record& stored) {
#if defined(__GNUC__) && !defined(__CUDA_ARCH__)
  asm("" : "+m"(stored));
#endif
  return stored;
}

/// visit(0.0) or visit(0.0F): the type tells what numbers are stored in.
template <class Visit>
decltype(auto) with_number(Precision precision, const Visit& visit) {
  if (precision != Precision::full) return visit(0.0F);
  return visit(0.0);
}
/// visit(0.0), visit(0.0F) or visit(Single()): the type tells what numbers are stored in, and
/// Single that they are computed in single precision, too.
template <class Visit>
decltype(auto) with_arithmetic(Precision precision, const Visit& visit) {
  if (precision == Precision::single) return visit(Single());
  return with_number(precision, visit);
}

}  // namespace breccia
