#pragma once
// The packing of a body as its keys ask for it: by count or by sieves, between faces or cut from a
// periodic cell.

#include <array>
#include <string>
#include <vector>

#include "dem/setup/config.hpp"
#include "exec/plain_vector.hpp"
#include "prepare/packing/packing.hpp"

namespace breccia::prepare {

/// Share of a body's volume that its elements fill.  [-]
double compactness_of(const dem::PackConfig& pack);

/// Elements of a body of this volume: those that are asked for, or as many as its sieves need.  [-]
double elements_in(const dem::PackConfig& pack, double volume);

/// The task of a body's packing, or of the cell that it is cut from.
PackingTask packing_task(const dem::BodyConfig& body, const std::vector<Capsule>& bars,
                         double bars_volume, const Random& random);

/// Errors in the keys of a body's packing; each message begins with the key.
std::vector<std::string> pack_problems(const dem::BodyConfig& body);

/// Elements of a body about its centre.
struct BodyPacking {
  PlainVector<Vec3> position;  ///<  [m]
  PlainVector<double> radius;  ///<  [m]
  double compactness = 0.0;    ///< their volume over that of the body  [-]
};

/// Packs a body. In periodic directions there are no faces: the cell (the body itself unless
/// pack.cell is given) is repeated, and of it stays what has its centre in the body.
///
/// @param threads  any number of them gives the same bits
/// @throws InputError names the body if its largest element does not fit, or if elements overlap
///         where a porosity is asked for
BodyPacking pack_body(const dem::BodyConfig& body, const std::vector<Capsule>& bars,
                      double bars_volume, const Random& random, int threads = 1);

}  // namespace breccia::prepare
