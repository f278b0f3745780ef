#include "run/machine/device_plan.hpp"

#include <fmt/format.h>

#include "exec/device.hpp"
#include "exec/error.hpp"

namespace breccia {
namespace {

constexpr double gibibyte = 1073741824.0;
constexpr std::size_t context = std::size_t{600} << 20;  // the driver's own share

}  // namespace

// Measured on ten million elements (bench/notes/gpu.md): 2.4 kB each, links and search included. An
// element and what a search keeps of it: 1,040 B; a link with its action and its place in two
// lists: 240 B.
std::size_t device_bytes(const dem::Model& model) {
  return context + std::size_t{1040} * static_cast<std::size_t>(model.size()) +
         std::size_t{240} * model.links.size();
}

// A triangle with one and a half joints: nodes, forces and shapes 420 B, a joint 260 B; those at
// the border also take part in searches.
std::size_t device_bytes(const fdem::Model& model) {
  return context + std::size_t{900} * static_cast<std::size_t>(model.size());
}

// A tetrahedron with two joints, by its arrays: 490 B and twice 210 B, records for an eighth of the
// joints with them, and what a search takes.
std::size_t device_bytes(const fdem3::Model& model) {
  return context + std::size_t{1200} * static_cast<std::size_t>(model.size());
}

void plan_device(std::size_t bytes, bool quiet) {
  const DeviceInfo device = device_info();
  const double needed = static_cast<double>(bytes) / gibibyte;
  const double free = static_cast<double>(device.free_memory) / gibibyte;
  if (!quiet)
    fmt::print("{}: about {:.1f} GiB of {:.1f} GiB free memory planned\n", device.name, needed,
               free);
  if (bytes > device.free_memory)
    throw DeviceError(fmt::format(
        "the model needs about {:.1f} GiB on the GPU, and {} has {:.1f} GiB free; nothing "
        "was run\n  use fewer elements, another GPU (--device cuda:N), or --device cpu",
        needed, device.name, free));
}

}  // namespace breccia
