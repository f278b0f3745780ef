#pragma once

namespace breccia {

/// Makes threads that wait for each other sleep after about 0.1 ms instead of spinning for
/// milliseconds: on a shared machine a spinning thread takes the processor from the one it waits
/// for (slab on two loaded cores: 44 ms a step spinning, 8.5 ms so). OpenMP reads this when the
/// program is loaded, so the program starts itself once more, unless the user has chosen
/// (GOMP_SPINCOUNT, OMP_WAIT_POLICY). Call first in main.
void let_waiting_threads_sleep(char** argv);

}  // namespace breccia
