#include "exec/launch_times.hpp"

#include <vector>

#if defined(BR_CUDA)
#include <nvtx3/nvToolsExt.h>

#include "exec/cuda.hpp"
#include "exec/device.hpp"

namespace breccia {
namespace {

/// A launch between two events of the run's stream.
struct Between {
  std::string name;
  cudaEvent_t begin = nullptr, end = nullptr;
};
bool timing = false;
std::vector<Between> launched;
std::vector<cudaEvent_t> spare;  ///< events for later use

cudaEvent_t note_now() {
  cudaEvent_t event = nullptr;
  if (spare.empty()) {
    check_device(cudaEventCreate(&event), "making an event");
  } else {
    event = spare.back();
    spare.pop_back();
  }
  check_device(cudaEventRecord(event, device_stream()), "noting an event");
  return event;
}

}  // namespace

ProfileRange::ProfileRange(const char* name) {
  nvtxRangePushA(name);
}
ProfileRange::~ProfileRange() {
  nvtxRangePop();
}

LaunchTimes::LaunchTimes() {
  timing = true;
}
LaunchTimes::~LaunchTimes() {
  timing = false;
}
bool LaunchTimes::wanted() {
  return timing;
}

std::map<std::string, LaunchTimes::Entry> LaunchTimes::take() {
  wait_for_device();
  std::map<std::string, Entry> all;
  for (const Between& one : launched) {
    float ms = 0.0F;
    check_device(cudaEventElapsedTime(&ms, one.begin, one.end), "reading an event");
    Entry& entry = all[one.name];
    entry.seconds += 1e-3 * static_cast<double>(ms);
    ++entry.launches;
    spare.insert(spare.end(), {one.begin, one.end});
  }
  launched.clear();
  return all;
}

TimedLaunch::TimedLaunch(const std::string& name) : range_(name.c_str()) {
  launched.push_back({name, note_now(), nullptr});
}
TimedLaunch::~TimedLaunch() {
  if (launched.back().end == nullptr) launched.back().end = note_now();
}

}  // namespace breccia

#else

namespace breccia {

ProfileRange::ProfileRange(const char*) {}
ProfileRange::~ProfileRange() = default;
LaunchTimes::LaunchTimes() = default;
LaunchTimes::~LaunchTimes() = default;
bool LaunchTimes::wanted() {
  return false;
}
std::map<std::string, LaunchTimes::Entry> LaunchTimes::take() {
  return {};
}
TimedLaunch::TimedLaunch(const std::string& name) : range_(name.c_str()) {}
TimedLaunch::~TimedLaunch() = default;

}  // namespace breccia
#endif
