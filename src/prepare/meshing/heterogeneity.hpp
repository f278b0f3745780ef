#pragma once
// Minerals and strengths that vary inside a body.

#include <array>
#include <cstdint>
#include <vector>

#include "core/random.hpp"
#include "io/picture/picture.hpp"
#include "math/vec.hpp"
#include "math/vec2.hpp"

namespace breccia::prepare {

/// The Voronoi grain of each place: seeds lie one in each square or cube of edge `size`, anywhere
/// in it, so grains have the mean area size^2 or volume size^3. A grain's number depends on seed
/// and place only, not on the mesh.
std::vector<std::uint64_t> voronoi_grains(const std::vector<Vec2>& places, double size,
                                          const Random& random);
std::vector<std::uint64_t> voronoi_grains(const std::vector<Vec3>& places, double size,
                                          const Random& random);

/// A mineral for each of the pieces (grains or single elements), so that each mineral has its share
/// of the area or volume to within one piece. The order in which pieces are served is random, by
/// key and seed.
/// @param areas  of the pieces, or volumes  [m2], [m3]
/// @param keys   of the pieces: no two alike
std::vector<int> minerals_by_share(const std::vector<double>& areas,
                                   const std::vector<std::uint64_t>& keys,
                                   const std::vector<double>& shares, const Random& random);

/// The number of the nearest colour (red, green, blue) at each place, the picture being stretched
/// over the box from low to high.
std::vector<int> minerals_by_picture(const std::vector<Vec2>& places, const Image& picture,
                                     const Vec2& low, const Vec2& high,
                                     const std::vector<std::array<int, 3>>& colors);

/// Factors of mean 1 with Weibull's distribution of modulus m:
///
///   f = (-ln U)^(1/m) / Gamma(1 + 1/m)
///
/// U is uniform. For a correlation length l > 0 it is the probability of a Gaussian field of
/// correlation exp(-r^2 / l^2), which depends on seed and place, not on the mesh; for l = 0 it
/// depends on seed and number.
std::vector<float> weibull_factors(const std::vector<Vec2>& places, double modulus, double length,
                                   const Random& random);
std::vector<float> weibull_factors(const std::vector<Vec3>& places, double modulus, double length,
                                   const Random& random);

}  // namespace breccia::prepare
