// Runs a case and tells, ten times, how fast its fastest element flies.
//
//   cmake -B build && cmake --build build && build/fastest cases/rc_slab/small.toml 1e-4

#include <algorithm>
#include <breccia/breccia.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: fastest CASE SECONDS\n");
    return 2;
  }
  try {
    br::Simulation sim{br::Case(argv[1])};
    const double end = std::atof(argv[2]);
    for (int part = 1; part <= 10; ++part) {
      sim.run(0.1 * part * end);
      const br::Field v = sim.field("velocity");  // no copy
      double fastest = 0.0;
      for (std::int64_t i = 0; i < v.shape[0]; ++i)
        fastest = std::max(fastest, std::hypot(v(i, 0), v(i, 1), v(i, 2)));
      std::printf("%9.3e s  %8.4f %s\n", sim.time(), fastest, v.unit.c_str());
    }
    std::printf("hash %s\n", sim.hash().c_str());
  } catch (const br::Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return error.exit_code();
  }
}
