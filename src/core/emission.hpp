#pragma once
// Acoustic emission: events of breaks, their moment tensors and magnitudes, and how often they
// come.

#include <cstdint>
#include <optional>
#include <vector>

#include "math/mat3.hpp"

namespace breccia {

/// A joint or a link that broke.
struct Break {
  double time;    ///<  [s]
  Vec3 place;     ///<  [m]
  Sym3 moment;    ///< of the forces that would move the rock as it did  [N m]
  double energy;  ///< that it spent  [J]
};

/// Breaks that are one event.
struct EmissionEvent {
  double time = 0.0, duration = 0.0;  ///< of its first break, and to its last  [s]
  Vec3 place{};                       ///< mean of its breaks by their moments  [m]
  std::int64_t breaks = 0;            ///<  [-]
  Sym3 moment{};                      ///< sum of theirs  [N m]
  double energy = 0.0;                ///<  [J]

  /// M_0 = sqrt(M : M / 2).  [N m]
  double scalar() const;
  /// M_w = 2/3 (log10 M_0 - 9.1), M_0 in N m (Hanks and Kanamori 1979).  [-]
  double magnitude() const;
  /// tr M / (|tr M| + sum |m_k|) with the eigenvalues m_k of its deviator (Feignier and Young
  /// 1992): above 0.3 it opens, below -0.3 it closes, in between it slides.  [-]
  double isotropic() const;
};

/// Two breaks are of one event if they are no further apart than a distance and a time, or if
/// others lead from one to the other so. Events by time, then by the order of breaks.
std::vector<EmissionEvent> events_of(const std::vector<Break>& breaks, double distance,
                                     double window);

/// log10 N(M) = a - b M.
struct Frequency {
  std::int64_t count;   ///< of events that are counted  [-]
  double completeness;  ///< the least magnitude that is counted  [-]
  double b, deviation;  ///<  [-]
};
/// By maximum likelihood, b = log10 e / (mean M - M_c) (Aki 1965), with the deviation of Shi and
/// Bolt (1982), 2.30 b^2 sqrt(sum (M - mean)^2 / (n (n - 1))). M_c is the lower end of the tenth of
/// a magnitude that most events are in (maximum curvature, Wiemer and Wyss 2000). None from fewer
/// than 20 events.
std::optional<Frequency> frequency_of(const std::vector<double>& magnitudes);

}  // namespace breccia
