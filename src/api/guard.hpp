#pragma once
// Errors on their way out of the library.

#include "breccia/breccia.hpp"
#include "exec/error.hpp"
#include "run/case.hpp"

namespace br {

/// The case as the library's inside knows it.
struct Case::Read {
  breccia::Case read;
};

/// work(), whose errors leave as those of the public header.
template <class Work>
auto guarded(const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const breccia::Error& error) {
    throw Error(error.exit_code(), error.what());
  }
}

}  // namespace br
