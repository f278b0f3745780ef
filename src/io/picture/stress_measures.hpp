#pragma once
// Stresses of a frame, wherever it has them, and single numbers of them that can colour it.

#include <optional>
#include <string>
#include <vector>

#include "io/frame.hpp"
#include "math/mat3.hpp"

namespace breccia {

/// The stresses of spheres, triangles or tetrahedra.
class Stresses {
 public:
  explicit Stresses(const Frame& frame);

  bool known() const { return !parts_.empty(); }
  Carrier carrier() const { return carrier_; }
  std::size_t count() const;
  Sym3 at(std::size_t item) const;  ///<  [Pa]
  const std::string& unit() const { return parts_.front()->unit; }

 private:
  Carrier carrier_;
  std::vector<const FrameField*> parts_;  ///< one of six components, or xx, yy, xy and more
};

/// Colours that pictures make of stresses: `stress_largest`, `stress_smallest` (principal ones,
/// tension positive; of triangles in their plane), `stress_mean`, `stress_mises`, `stress_shear`
/// (half of the largest less the smallest).
bool is_stress_measure(const std::string& name);

/// The field of a stress measure; none for another name, or for a frame without stresses.
std::optional<FrameField> stress_measure(const Frame& frame, const std::string& name);

}  // namespace breccia
