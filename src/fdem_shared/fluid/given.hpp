#pragma once
// Data of a case about its fluids, and data that a run keeps of them.

#include <cstdint>
#include <vector>

#include "core/table_over_time.hpp"
#include "exec/buffer.hpp"
#include "fdem_shared/fluid/cracks.hpp"

namespace breccia::fdem_shared {

/// Where a fluid comes from, and how it spreads.
struct FluidSource {
  std::int16_t load;        ///< index into Case::loads
  double speed;             ///< of its front; 0: it fills cracks at once  [m/s]
  std::vector<Port> ports;  ///< at which it is from the start on  [-]
};

/// A fluid that flows through cracks. @tparam Side  that bears a load
template <class Side>
struct FlowCaseOf {
  bool on = false;
  double viscosity = 0.0, bulk = 0.0;  ///<  [Pa s], [Pa]
  double aperture = 0.0;               ///< of closed cracks  [m]
  double stiffness = 0.0;              ///< of joints times length: what may act on a crack  [Pa]
  bool filled = false;                 ///< cracks that are open at the start hold it
  bool by_rate = false;                ///< stage
  ScaledAmplitude input;               ///< stage; pressure  [Pa], or rate  [m2/s; in space m3/s]
  std::int16_t load = 0;               ///< index into Case::loads
  Index elements = 0;                  ///< of the whole mesh  [-]
  std::vector<Port> ports;             ///< of its source, ascending  [-]
  std::vector<Port> outlet;            ///< likewise, where it leaves; empty: nowhere  [-]
  double outlet_pressure = 0.0;        ///<  [Pa]
  std::vector<Side> borders;           ///< of the region: they bear the pressure of the source

  /// The modulus of fluid in a crack: a change of its volume must not act more stiffly than the
  /// joint did that was there.
  /// @param length  of that joint  [m]
  double bulk_in(double open, double length) const {
    const double most = 0.5 * stiffness * open / length;
    return most < bulk ? most : bulk;
  }
};

/// A source of fluid that does not flow, now.
struct SourceNow {
  double pressure = 1.0;  ///< of gas of an explosive  [Pa]; else 1: the factor of what is given
  double energy = 0.0;    ///< that gas holds, per volume of its explosive  [J/m3]
  double pushed = 0.0;    ///< how far it has pushed its walls (GasRoom)  [m3; in 2D m2]
};

/// Where fluid presses on cracks: the same on all ranks.
template <class Side, class Crack>
struct FluidStateOf {
  double time = -1.0;         ///< when it spread last; below 0: not yet  [s]
  std::vector<Side> wet;      ///< sides of cracks, two by two, by global id
  std::vector<Crack> filled;  ///< of a fluid that spreads: the cracks of these sides
  std::vector<Side> border;   ///< of a fluid that flows: sides at its source
  /// Of a fluid that flows, at the first side of each crack: its volume without pressure; none: it
  /// has not begun.  [m2; in space m3]  (corners x elements of the whole mesh)
  Buffer<double> volume;
  double injected = 0.0;  ///< that came in so far  [likewise]
  double released = 0.0;  ///< that left so far  [likewise]
  double pressure = 0.0;  ///< at its source  [Pa]
  double extent = 0.0;    ///< of cracks that a fluid that flows fills  [m; in space m2]
  Buffer<SourceNow> gas;  ///< of a case with explosives; else empty  (sources)
};

/// The part of the cracks that a fluid has filled.
struct FilledPart {
  double extent = 0.0;  ///< length, in space area  [m; in space m2]
  double volume = 0.0;  ///<  [m2; in space m3]
};

}  // namespace breccia::fdem_shared
