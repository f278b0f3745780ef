#pragma once
// Whether a state that was loaded fits the case: a digest tells damage, not malice, and kernels use
// numbers of a checkpoint as places in memory.

#include <cstddef>
#include <string>
#include <vector>

#include "dem/world.hpp"
#include "fdem/world.hpp"
#include "fdem3/world.hpp"

namespace breccia {

/// An array of places or numbers that a checkpoint repeats, though the case decides it.
struct Repeated {
  std::string section;
  std::vector<std::byte> bytes;
};
std::vector<Repeated> repeated_by(const dem::World& w);
std::vector<Repeated> repeated_by(const fdem::World& w);
std::vector<Repeated> repeated_by(const fdem3::World& w);

/// Whether all that leads somewhere leads to where something is. @throws CheckpointError
void refuse_wrong_places(const dem::World& w);
void refuse_wrong_places(const fdem::World& w);
void refuse_wrong_places(const fdem3::World& w);

/// Before the host uses numbers of a device's memory as places in its own: a bit that flipped there
/// must not lead it astray. On the host itself nothing is looked at.
/// @throws DeviceError naming the array
void require_places(const dem::World& w);
void require_places(const fdem::World& w);
void require_places(const fdem3::World& w);

/// @throws CheckpointError naming the section that is not that of the case
void refuse_changed(const std::vector<Repeated>& built, const std::vector<Repeated>& loaded);

/// Made of the world that the case builds; then compared with what was loaded into it.
template <class World>
class LoadCheck {
 public:
  explicit LoadCheck(const World& built) : built_(repeated_by(built)) {}
  /// @throws CheckpointError naming the section that does not fit
  void refuse_misfits(const World& loaded) const {
    refuse_changed(built_, repeated_by(loaded));
    refuse_wrong_places(loaded);
  }

 private:
  std::vector<Repeated> built_;
};

}  // namespace breccia
