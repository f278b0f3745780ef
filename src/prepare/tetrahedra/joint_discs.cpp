#include "prepare/tetrahedra/joint_discs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "core/random.hpp"
#include "exec/error.hpp"
#include "math/constants.hpp"
#include "prepare/csv_numbers.hpp"
#include "prepare/meshing/length_law.hpp"
#include "prepare/meshing/set_problems.hpp"
#include "prepare/meshing/wkt.hpp"

namespace breccia::prepare {
namespace {

using fdem3::DiscontinuityConfig;
using fdem3::JointSetConfig;

constexpr std::uint32_t disc_stream = 0x50000;  ///< of random numbers; one more for each set
constexpr std::uint64_t most_draws = 200'000;   ///< of discs of a set
constexpr double most_discs = 10'000.0;         ///< that may be asked for

LengthLaw radius_law_of(const JointSetConfig& set) {
  return {set.radius_law,      set.radius, set.radius_deviation,
          set.radius_exponent, set.least,  set.most};
}

Vec3 direction_of(const Vec3& v) {
  return (1.0 / norm(v)) * v;
}
/// Two directions across one, and each other.
std::pair<Vec3, Vec3> across(const Vec3& n) {
  const Vec3 first =
      direction_of(std::abs(n.x) < 0.6 ? cross({1.0, 0.0, 0.0}, n) : cross({0.0, 1.0, 0.0}, n));
  return {first, cross(n, first)};
}

/// The regular polygon of a disc's area, with a corner in the direction `turn`.
Corners3 polygon_of_disc(const Vec3& center, const Vec3& normal, double radius, int sides,
                         double turn) {
  const double step = 2.0 * pi / sides;
  const double reach = radius * std::sqrt(step / std::sin(step));
  const auto [u, v] = across(normal);
  Corners3 corners;
  for (int k = 0; k < sides; ++k) {
    const double angle = turn + step * k;
    corners.push_back(center + (reach * std::cos(angle)) * u + (reach * std::sin(angle)) * v);
  }
  return corners;
}

/// A direction of Fisher's distribution around n: density kappa exp(kappa cos t)/(4 pi sinh kappa).
Vec3 fisher(const Vec3& n, double kappa, double u, double v) {
  if (std::isinf(kappa)) return n;
  const double cosine =
      kappa < 1e-6 ? 1.0 - 2.0 * u : 1.0 + std::log(1.0 - u + u * std::exp(-2.0 * kappa)) / kappa;
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const auto [first, second] = across(n);
  return cosine * n + sine * (std::cos(2.0 * pi * v) * first + std::sin(2.0 * pi * v) * second);
}

Vec3 middle_of(const Corners3& corners) {
  Vec3 sum{};
  for (const Vec3& x : corners) sum += (1.0 / static_cast<double>(corners.size())) * x;
  return sum;
}

/// Draws discs one after the other; a number of uniform values for each.
class DrawnDiscs {
 public:
  DrawnDiscs(const JointSetConfig& set, const Random& random, CrackNetwork& network)
      : set_(set), random_(random), network_(network) {}

  std::vector<Corners3> polygons() {
    const Vec3 size = set_.max - set_.min;
    const bool counts = set_.number > 0.0;
    const double aim = counts ? set_.number : set_.intensity * size.x * size.y * size.z;
    double got = 0.0;
    std::vector<Corners3> all;
    for (std::uint64_t item = 0; got < (1.0 - 1e-9) * aim; ++item) {
      if (item == most_draws)
        throw InputError(fmt::format(
            "after {} random discs the box holds {:.4g} of the {:.4g} {} that are asked for; give "
            "fewer, or a smaller clear",
            most_draws, got, aim, counts ? "discs" : "m2 of discs"));
      Vec3 center{};
      Corners3 polygon = disc(item, center);
      if (polygon.size() < 3) continue;
      const double area = norm(area_vector(polygon));
      if (!(area > 1e-12 * set_.radius * set_.radius)) continue;
      if (!counts && got + area > aim) {
        const Vec3 middle = middle_of(polygon);
        const double by = std::sqrt((aim - got) / area);
        for (Vec3& x : polygon) x = middle + by * (x - middle);
      }
      if (!network_.fits(polygon)) continue;
      const bool inside = center.x >= set_.min.x && center.x <= set_.max.x &&
                          center.y >= set_.min.y && center.y <= set_.max.y &&
                          center.z >= set_.min.z && center.z <= set_.max.z;
      got += counts ? (inside ? 1.0 : 0.0) : norm(area_vector(polygon));
      network_.add_crack(polygon);
      all.push_back(std::move(polygon));
    }
    return all;
  }

 private:
  Corners3 disc(std::uint64_t item, Vec3& center) const {
    const auto uniform = [&](std::uint32_t draw) { return random_.uniform(item, draw); };
    const double radius = radius_law_of(set_).drawn(random_, item);
    const double reach = radius_law_of(set_).longest();
    const Vec3 room = set_.max - set_.min + Vec3{2.0 * reach, 2.0 * reach, 2.0 * reach};
    center = set_.min - Vec3{reach, reach, reach} +
             Vec3{room.x * uniform(2), room.y * uniform(3), room.z * uniform(4)};
    const Vec3 normal =
        fisher(direction_of(set_.normal), set_.concentration, uniform(5), uniform(6));
    return clipped(polygon_of_disc(center, normal, radius, set_.sides, 2.0 * pi * uniform(7)),
                   set_.min, set_.max);
  }

  const JointSetConfig& set_;
  Random random_;
  CrackNetwork& network_;
};

std::vector<Corners3> polygons_of_file(const JointSetConfig& set, const std::string& path) {
  if (path.ends_with(".wkt")) return polygons_of_wkt(path);
  std::vector<Corners3> all;
  read_csv(path, 7, "a disc x,y,z,nx,ny,nz,radius in metres with a direction and a radius above 0",
           [&](const std::vector<double>& v) {
             const Vec3 normal{v[3], v[4], v[5]};
             if (!(norm(normal) > 0.0) || !(v[6] > 0.0)) return false;
             all.push_back(
                 polygon_of_disc({v[0], v[1], v[2]}, direction_of(normal), v[6], set.sides, 0.0));
             return true;
           });
  return all;
}

/// How far corners lie off the plane of a polygon, over its reach.
double unevenness(const Corners3& polygon) {
  const Vec3 area = area_vector(polygon);
  double span = 0.0, off = 0.0;
  for (const Vec3& x : polygon) span = std::max(span, norm(x - polygon[0]));
  if (!(norm(area) > 1e-9 * span * span)) return no_limit;
  for (const Vec3& x : polygon)
    off = std::max(off, std::abs(dot(x - polygon[0], area)) / (norm(area) * span));
  return off;
}

/// A quarter of the shortest edge that a body with cracks is meshed with.  [m]
double quarter_of_edge(const fdem3::Config& config) {
  double least = 0.0;
  for (const fdem3::BodyConfig& body : config.bodies)
    if (body.mesh_size > 0.0)
      least = least > 0.0 ? std::min(least, body.mesh_size) : body.mesh_size;
  return 0.25 * least;
}

/// The six faces of a box.
std::vector<Corners3> faces_of_box(const Vec3& low, const Vec3& high) {
  const auto corner = [&](int k) {
    return Vec3{(k & 1) != 0 ? high.x : low.x, (k & 2) != 0 ? high.y : low.y,
                (k & 4) != 0 ? high.z : low.z};
  };
  std::vector<Corners3> faces;
  constexpr std::array<std::array<int, 4>, 6> corners{
      {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}}};
  for (const auto& k : corners)
    faces.push_back({corner(k[0]), corner(k[1]), corner(k[2]), corner(k[3])});
  return faces;
}

/// Cracks and faces of bodies that are there before the first set.
CrackNetwork network_of(const fdem3::Config& config, double clear) {
  CrackNetwork network(clear);
  for (const fdem3::BodyConfig& body : config.bodies)
    if (body.shape == "box")
      for (Corners3& face :
           faces_of_box(body.center - 0.5 * body.size, body.center + 0.5 * body.size))
        network.add_face(std::move(face));
  constexpr int round = 32;
  for (const DiscontinuityConfig& d : config.discontinuities)
    network.add_crack(d.points.empty()
                          ? polygon_of_disc(d.center, direction_of(d.normal), d.radius, round, 0.0)
                          : d.points);
  return network;
}

}  // namespace

std::vector<DiscontinuityConfig> polygons_of_set(const JointSetConfig& set, std::int64_t seed,
                                                 std::size_t number, const std::string& case_folder,
                                                 CrackNetwork& network) {
  const auto discontinuity = [&](Corners3 corners) {
    DiscontinuityConfig d;
    d.name = set.name;
    d.points = std::move(corners);
    d.kind = set.kind;
    d.material = set.material;
    d.embedded = set.embedded;
    return d;
  };
  std::vector<DiscontinuityConfig> all;
  if (set.file.empty()) {
    const Random random{static_cast<std::uint64_t>(seed),
                        disc_stream + static_cast<std::uint32_t>(number)};
    for (Corners3& polygon : DrawnDiscs(set, random, network).polygons())
      all.push_back(discontinuity(std::move(polygon)));
    return all;
  }
  for (Corners3& polygon :
       polygons_of_file(set, (std::filesystem::path(case_folder) / set.file).string())) {
    if (polygon.size() < 3 || !(unevenness(polygon) <= 1e-6))
      throw InputError(
          fmt::format("{}: polygon {} is not flat, or has no area", set.file, all.size() + 1));
    network.add_crack(polygon);
    all.push_back(discontinuity(std::move(polygon)));
  }
  if (all.empty()) throw InputError(fmt::format("{}: it has no polygon", set.file));
  return all;
}

std::vector<DiscontinuityConfig> cracks_with_sets(const fdem3::Config& config,
                                                  const std::string& case_folder) {
  std::vector<DiscontinuityConfig> all = config.discontinuities;
  for (std::size_t k = 0; k < config.joint_sets.size(); ++k) {
    const JointSetConfig& set = config.joint_sets[k];
    CrackNetwork network =
        network_of(config, set.clear < 0.0 ? quarter_of_edge(config) : set.clear);
    for (std::size_t i = config.discontinuities.size(); i < all.size(); ++i)
      network.add_crack(all[i].points);
    try {
      for (DiscontinuityConfig& d : polygons_of_set(set, config.seed, k, case_folder, network))
        all.push_back(std::move(d));
    } catch (const InputError& error) {
      throw InputError("joint_set." + set.name + ": " + error.what());
    }
  }
  return all;
}

std::vector<std::string> joint_set_problems(const JointSetConfig& set,
                                            const std::vector<std::string>& joints) {
  std::vector<std::string> problems;
  const auto require = [&](bool holds, const std::string& text) {
    if (!holds) problems.push_back("joint_set." + set.name + text);
  };
  if (check_shared_keys(set, joints, "discs", require)) {
    require(set.number == 0.0, ".number is of random discs, and these come from a file");
    return problems;
  }
  const Vec3 size = set.max - set.min;
  require(size.x > 0.0 && size.y > 0.0 && size.z > 0.0,
          ": random discs need the box that they fill, min and max");
  require(norm(set.normal) > 0.0, ".normal has no length");
  require((set.intensity > 0.0) != (set.number > 0.0),
          set.number > 0.0 ? ".number: give it or an intensity, one of them"
                           : ".intensity or number must be above 0, or file must name one");
  for (const std::string& problem : radius_law_of(set).problems("radius")) require(false, problem);
  const double typical = set.radius_law == "power" ? set.least : set.radius;
  if (typical > 0.0) {
    const double discs = set.intensity * size.x * size.y * size.z / (pi * typical * typical);
    require(discs <= most_discs,
            fmt::format(".intensity: about {:.3g} discs; at most {:.0f} are possible", discs,
                        most_discs));
  }
  require(set.number <= most_discs,
          fmt::format(".number: at most {:.0f} discs are possible", most_discs));
  return problems;
}

}  // namespace breccia::prepare
