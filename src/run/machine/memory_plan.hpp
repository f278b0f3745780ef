#pragma once
// Whether this machine has the memory that a case needs, told before anything is built.

#include <cstdint>
#include <string>

#include "coupled/setup/config.hpp"
#include "dem/setup/config.hpp"
#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"

namespace breccia {

/// Memory that building or running a case takes at least. Bodies from files are not counted, but
/// those whose file is their outline.
struct MemoryPlan {
  double items = 0.0;     ///< elements, triangles or tetrahedra
  const char* kind = "";  ///< that word
  double build_bytes = 0.0;
  double run_bytes = 0.0;
  double host_bytes = 0.0;  ///< of a run whose world a GPU holds, on the host
};
/// @param folder  where the files that the case names are; empty: none is opened
MemoryPlan memory_plan(const dem::Config& config, const std::string& folder = "");
MemoryPlan memory_plan(const fdem::Config& config, const std::string& folder = "");
MemoryPlan memory_plan(const fdem3::Config& config, const std::string& folder = "");
MemoryPlan memory_plan(const coupled::Config& config, const std::string& folder = "");

/// Tetrahedra of one body; 0 where its file alone tells.
double tetrahedra_of(const fdem3::BodyConfig& body);

/// Memory that this process may still take: of the machine (MemAvailable), of its limit (`ulimit
/// -v`), and of its control group.  [bytes]
/// @param root  where /proc and /sys are found; others for tests
double available_memory(const std::string& root = "");

/// @param sharers  processes that each build the whole model on this machine
/// @param what     it is that needs so much, for the message
/// @throws DeviceError naming both numbers if `bytes` for each of them are not there
void refuse_without_memory(const MemoryPlan& plan, double bytes, int sharers,
                           const std::string& what = "the model");

/// "1.2 GB" of bytes.
std::string memory_text(double bytes);

}  // namespace breccia
