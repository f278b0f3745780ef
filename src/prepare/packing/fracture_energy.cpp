#include "prepare/packing/fracture_energy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/observe.hpp"
#include "dem/setup/materials.hpp"
#include "dem/world.hpp"
#include "exec/error.hpp"
#include "math/constants.hpp"
#include "prepare/build.hpp"
#include "prepare/packing/linking.hpp"

namespace breccia::prepare {
namespace {

using dem::MaterialConfig;

constexpr int packings = 3, steps = 3000;
constexpr double usual_width = 0.1;              ///< of notched specimens in laboratories  [m]
constexpr double fewest = 400.0, most = 1600.0;  ///< elements
constexpr double ligament = 0.5;                 ///< its width over that of the cube  [-]
constexpr double elongation = 2.4;    ///< at the end, over u_2, besides the elastic one  [-]
constexpr double elastic_end = 3e-4;  ///< strain of the whole cube at the end at most  [-]
/// Energy of a crack over q T u_2 / 2, q = 2.7 the section of links that cross it: a first guess.
constexpr double first_guess = 1.6 * 2.7;

/// Elements of a cube of which one takes this space  [m3]
double elements_of(double each) {
  return std::clamp(std::pow(usual_width, 3) / each, fewest, most);
}

/// A cube whose links through the middle are cut on both sides of a ligament.
class NotchedCube {
 public:
  NotchedCube(const MaterialConfig& material, const dem::ContactConfig& contact,
              const PackedLike& packed, int seed) {
    const double ball = 4.0 / 3.0 * pi * std::pow(packed.radius, 3);
    const double spread = (packed.size_ratio - 1.0) / (packed.size_ratio + 1.0);
    const double each = ball * (1.0 + spread * spread) / packed.compactness;
    const double count = elements_of(each);
    width_ = std::cbrt(count * each);
    config_.seed = seed;
    config_.materials = {material};
    config_.materials[0].fracture_energy = 0.0;
    config_.materials[0].rate = "none";  // a quasi-static test
    config_.contact = contact;
    config_.local_damping = material.link_damping > 0.0 ? 0.0 : 0.3;
    config_.links.range = packed.range;
    dem::BodyConfig body;
    body.name = "cube";
    body.material = material.name;
    body.size = {width_, width_, width_};
    body.pack = {.count = static_cast<int>(count),
                 .size_ratio = packed.size_ratio,
                 .compactness = packed.compactness};
    config_.bodies = {body};
    model_ = build_model(config_, ".");
    cut();
    hold(1.5 * packed.radius);
  }

  /// Energy spent until it has parted, over the ligament.  [J/m2]
  double energy(double rupture_opening) {
    model_.bulk[0].rupture_opening = rupture_opening;
    const double way = elongation * rupture_opening + elastic_end * width_;
    move(0.0);
    const double dt = dem::make_world(config_, model_, {}).next_dt;
    move(0.5 * way / (steps * dt));
    dem::World w = dem::make_world(config_, model_, {});
    while (w.time < steps * dt) dem::step(w);
    const EnergyBalance e = dem::balance(w);
    return (e.fracture + e.friction + e.plastic) / (ligament * width_ * width_);
  }

 private:
  void cut() {
    const auto place = [&](Index e) { return model_.position[static_cast<std::size_t>(e)]; };
    drop_links(model_, [&](const dem::Model::Link& link) {
      const Vec3 a = place(link.a), b = place(link.b);
      if (a.z * b.z >= 0.0) return false;
      const double x = a.x + a.z / (a.z - b.z) * (b.x - a.x);
      return std::abs(x) > 0.5 * ligament * width_;
    });
  }
  void hold(double layer) {
    const double far = 10.0 * width_, inner = 0.5 * width_ - layer;
    config_.supports = {
        {"top", "", {-far, -far, inner}, {far, far, far}, {"x", "y", "z"}, {}, 0.0},
        {"bottom", "", {-far, -far, -far}, {far, far, -inner}, {"x", "y", "z"}, {}, 0.0}};
  }
  void move(double speed) {
    config_.supports[0].velocity = Vec3{0.0, 0.0, speed};
    config_.supports[1].velocity = Vec3{0.0, 0.0, -speed};
    for (std::size_t e = 0; e < model_.position.size(); ++e)
      model_.velocity[e].z = speed * std::clamp(model_.position[e].z / (0.5 * width_), -1.0, 1.0);
  }

  double width_ = 0.0;  ///<  [m]
  dem::Config config_;
  dem::Model model_;
};

}  // namespace

double notched_cube_energy(const MaterialConfig& material, const dem::ContactConfig& contact,
                           const PackedLike& packed, double rupture_opening) {
  double sum = 0.0;
  for (int seed = 1; seed <= packings; ++seed)
    sum += NotchedCube(material, contact, packed, seed).energy(rupture_opening);
  return sum / packings;
}

double rupture_opening(const MaterialConfig& material, const dem::ContactConfig& contact,
                       const PackedLike& packed, double longest, const std::string& body) {
  const double asked = material.fracture_energy;
  const double onset =
      material.tensile_strength * longest / dem::local_elasticity(material).modulus;
  const auto refuse_brittle = [&](double opening) {
    if (opening > onset) return;
    const std::string cure =
        opening > 0.0 ? fmt::format("elements of at most {:.3g} m mean diameter (now {:.3g} m)",
                                    2.0 * packed.radius * opening / onset, 2.0 * packed.radius)
                      : fmt::format(
                            "a smaller cohesion, since sliding alone spends more, or other "
                            "elements (now {:.3g} m mean diameter)",
                            2.0 * packed.radius);
    throw InputError(fmt::format(
        "material.{}.fracture_energy = {:.4g} J/m2 is too small for body {}: its links would have "
        "to break at an opening of {:.3g} m, but store energy up to one of {:.3g} m (snap back)\n"
        "  use {}, or a smaller tensile_strength",
        material.name, asked, body, std::max(opening, 0.0), onset, cure));
  };
  const double below = dem::softening_knee(material).area;
  const double first = 2.0 * asked / (first_guess * material.tensile_strength * below);
  refuse_brittle(first);
  const double energy = notched_cube_energy(material, contact, packed, first);
  const double second = first * asked / energy;
  refuse_brittle(second);
  const double energy2 = notched_cube_energy(material, contact, packed, second);
  const double slope = (energy2 - energy) / (second - first);
  // Without a slope there is no secant: what is near enough is taken, the rest is sliding.
  constexpr double near = 1.5;
  if (!(slope > 0.0)) refuse_brittle(energy2 < near * asked ? second : 0.0);
  const double opening = slope > 0.0 ? first + (asked - energy) / slope : second;
  refuse_brittle(opening);
  return opening;
}

double fracture_energy_steps(double density) {
  constexpr int tests = 2;  // of the first guess and the second
  return tests * packings * steps * elements_of(1.0 / density);
}

}  // namespace breccia::prepare
