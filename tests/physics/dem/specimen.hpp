#pragma once
// Packed specimens of concrete, pulled or pressed along z.

#include <cmath>
#include <memory>

#include "dem/observe.hpp"
#include "dem/world.hpp"
#include "prepare/build.hpp"

namespace breccia::dem::testing {

/// The base case of the reference law: a box of edges 1 : 1 : 2, C / T = 2.5, links at 1.4 (R_a +
/// R_b); fewer elements than the 2,000 of the reference values, so that many can be broken.
struct Specimen {
  Config config;
  Vec3 size;

  explicit Specimen(int count = 1000, const Vec3& edges = {0.1, 0.1, 0.2}) : size(edges) {
    MaterialConfig m;
    m.name = "c";
    m.tensile_strength = 4e6;
    m.cohesion = 10e6;
    m.softening = 5.0;
    m.rolling_limit = 0.1;
    config.materials = {m};
    BodyConfig body;
    body.name = "specimen";
    body.material = "c";
    body.size = size;
    body.pack = {.count = count, .size_ratio = 2.0, .compactness = 0.6};
    config.bodies = {body};
    config.links.range = 1.4;
    config.local_damping = 0.3;
  }
  MaterialConfig& material() { return config.materials[0]; }
  Model model() const { return build_model(config, "."); }
};

/// Result of a test with prescribed velocities of the ends; stress and strain in the sense of the
/// loading.
struct Curve {
  double modulus = 0.0;   ///< secant at a strain of 1e-4  [Pa]
  double poisson = 0.0;   ///< there, from the middle half of the specimen  [-]
  double strength = 0.0;  ///< largest stress  [Pa]
  double strain = 0.0;    ///< at the largest stress  [-]
  double fracture = 0.0;  ///< energy of softening and rupture at the end, over the section  [J/m2]
};

/// Pulls the ends apart (rate > 0) or together at a constant rate of strain [1/s], until the stress
/// has fallen to a share of its peak. Ends: layers 1.5 mean radii thick, free across and to turn;
/// all elements start with the velocities of a uniform strain, so that no shock runs through.
class LoadTest {
 public:
  LoadTest(const Specimen& specimen, Model model, double rate)
      : rate_(rate), area_(specimen.size.x * specimen.size.y), model_(std::move(model)) {
    double mean = 0.0, length = 0.0;
    for (const double r : model_.radius) mean += r / static_cast<double>(model_.size());
    middle_ = 0.25 * specimen.size.z;
    const double layer = 0.5 * specimen.size.z - 1.5 * mean;
    for (const double side : {-1.0, 1.0}) {
      double sum = 0.0;
      int members = 0;
      for (const Vec3& x : model_.position)
        if (side * x.z >= layer) ++members, sum += side * x.z;
      length += sum / members;
    }
    for (std::size_t e = 0; e < model_.position.size(); ++e)
      model_.velocity[e].z = rate * model_.position[e].z;
    Config config = specimen.config;
    const Vec3 speed{0.0, 0.0, 0.5 * rate * length};
    const Vec3 far = 10.0 * specimen.size;
    config.supports = {
        {"top", "", {-far.x, -far.y, layer}, far, {"z"}, speed, 0.0},
        {"bottom", "", -1.0 * far, {far.x, far.y, -layer}, {"z"}, -1.0 * speed, 0.0}};
    world_ = std::make_unique<World>(make_world(config, model_, {}));
  }

  /// @param fallen  share of its peak at which the stress ends the test
  Curve run(double fallen = 0.9) {
    Curve curve;
    double strain = 0.0, stress = 0.0;
    while (strain < 1e-4 || stress > fallen * curve.strength) {
      step(*world_);
      strain = std::fabs(rate_) * world_->time;
      stress = stress_now();
      if (curve.modulus == 0.0 && strain >= 1e-4) {
        curve.modulus = stress / strain;
        curve.poisson = widening() / (rate_ > 0.0 ? -strain : strain);
      }
      if (stress <= curve.strength) continue;
      curve.strength = stress;
      curve.strain = strain;
    }
    curve.fracture = balance(*world_).fracture / area_;
    return curve;
  }
  const World& world() const { return *world_; }

 private:
  double stress_now() const {
    static const ProbeConfig top{"", "top", "force_z", "sum"};
    static const ProbeConfig bottom{"", "bottom", "force_z", "sum"};
    const double pull = 0.5 * (probe(*world_, bottom) - probe(*world_, top)) / area_;
    return rate_ > 0.0 ? pull : -pull;
  }
  /// Sideways strain of the middle half: regression of the displacements.
  double widening() const {
    double xx = 0.0, xu = 0.0;
    for (Index e = 0; e < model_.size(); ++e) {
      const Vec3 x = model_.position[static_cast<std::size_t>(e)];
      if (std::fabs(x.z) > middle_) continue;
      const Vec3 u = world_->elements.state.data()[e].position - x;
      xx += x.x * x.x + x.y * x.y;
      xu += x.x * u.x + x.y * u.y;
    }
    return xu / xx;
  }

  double rate_, area_, middle_;
  Model model_;
  std::unique_ptr<World> world_;
};

inline Curve pulled(const Specimen& specimen, const Model& model, double rate = 0.2,
                    double fallen = 0.9) {
  return LoadTest(specimen, model, rate).run(fallen);
}
inline Curve pressed(const Specimen& specimen, const Model& model) {
  return LoadTest(specimen, model, -0.5).run();
}

}  // namespace breccia::dem::testing
