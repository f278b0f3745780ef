#include "laboratory/ldpm_tests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "exec/error.hpp"

namespace breccia::laboratory {
namespace {

constexpr double grains_across = 5.0;  ///< a prism, over the largest grain  [-]
constexpr double outer = 1.0;          // m
constexpr double skin = 1e-6;          ///< particles of a face lie in it  [m]

/// Strain rates over those that specimens of spheres have, which are 0.1 m wide: ends move with
/// equal speeds.
double faster(const Vec3& size) {
  return 0.1 / size.x;
}
double edge_of(const dem::MaterialConfig& m) {
  return grains_across * m.mix.largest;
}

/// The particles on a face of the specimen, whose outward normal is +-axis.
dem::SupportConfig face(const std::string& name, const Vec3& size, int axis, double side) {
  dem::SupportConfig s;
  s.name = name;
  s.min = {-outer, -outer, -outer};
  s.max = {outer, outer, outer};
  const double half[3] = {0.5 * size.x, 0.5 * size.y, 0.5 * size.z};
  double* const bound[3] = {side > 0.0 ? &s.min.x : &s.max.x, side > 0.0 ? &s.min.y : &s.max.y,
                            side > 0.0 ? &s.min.z : &s.max.z};
  *bound[axis] = side * (half[axis] - skin);
  s.fix = {std::string(1, "xyz"[axis])};
  return s;
}
ProbeConfig read_from(const std::string& support, const std::string& name, char axis) {
  return name.starts_with("force")
             ? ProbeConfig{name, support, std::string("force_") + axis, "sum"}
             : ProbeConfig{name, support, std::string("position_") + axis, "mean"};
}

void add_ends(dem::Config& c, const Vec3& size, double speed) {
  const double ramp = 0.1 * c.time.end;
  for (const double side : {1.0, -1.0}) {
    dem::SupportConfig end = face(side > 0.0 ? "top" : "bottom", size, 2, side);
    end.fix = {"z", "spin_x", "spin_y"};
    end.velocity = Vec3{0.0, 0.0, 0.5 * side * speed};
    end.ramp = ramp;
    c.supports.push_back(end);
    c.probes.push_back(read_from(end.name, "force_" + end.name, 'z'));
    c.probes.push_back(read_from(end.name, end.name, 'z'));
  }
}

/// The middle halves of two sides.
void add_gauges(dem::Config& c, const Vec3& size) {
  for (const double side : {1.0, -1.0}) {
    dem::SupportConfig gauge = face(side > 0.0 ? "right" : "left", size, 0, side);
    gauge.min.z = -0.25 * size.z;
    gauge.max.z = 0.25 * size.z;
    gauge.fix = {};
    c.supports.push_back(gauge);
    c.probes.push_back(read_from(gauge.name, gauge.name, 'x'));
  }
}

void hold_ends(dem::Config& c) {
  for (std::size_t end : {0, 1}) c.supports[end].fix = {"all"};
}
void roughen_ends(dem::Config& c) {
  for (std::size_t end : {0, 1}) c.supports[end].friction = c.contact.friction;
}

/// Opening at which a facet bears nothing any more: six times G_t / s_t.  [m]
double widest_opening(const dem::MaterialConfig& m) {
  const double young = m.young / (1.0 - 2.0 * m.poisson);
  return 3.0 * m.tensile_strength * m.ldpm.tensile_length / young;
}

/// Two notches that part grains alone; the ends part until the crack is open.
void pull_apart(dem::Config& c, const SpecimenTest& test) {
  constexpr double speed = 0.04, elastic = 40e-6;
  for (const double side : {1.0, -1.0}) {
    dem::CutConfig cut;
    cut.shape = "box";
    cut.center = {0.5 * side * (test.size.x - test.notch + outer), 0.0, 0.0};
    cut.size = {test.notch + outer, outer, 0.0};
    c.bodies[0].cuts.push_back(cut);
  }
  c.time.end = (widest_opening(c.materials[0]) + elastic) / speed;
  add_ends(c, test.size, speed);
  hold_ends(c);
  for (std::size_t end : {0, 1}) c.supports[end].ramp = 1e-4;
}

/// Three faces stand still, those opposite to them close.
/// @returns the places of the moving ones in c.supports: x, y, z
std::array<std::size_t, 3> add_faces(dem::Config& c, const Vec3& size) {
  const char* const low[3] = {"left", "front", "bottom"};
  const char* const high[3] = {"right", "back", "top"};
  std::array<std::size_t, 3> moving{};
  for (int axis = 0; axis < 3; ++axis) {
    c.supports.push_back(face(low[axis], size, axis, -1.0));
    moving[static_cast<std::size_t>(axis)] = c.supports.size();
    c.supports.push_back(face(high[axis], size, axis, 1.0));
  }
  for (const char* const end : {"top", "bottom"}) {
    c.probes.push_back(read_from(end, std::string("force_") + end, 'z'));
    c.probes.push_back(read_from(end, end, 'z'));
  }
  c.probes.push_back(read_from("right", "force_side", 'x'));
  return moving;
}

/// Strains of a sheared specimen grow with its pressure.
double sheared_strain(double pressure) {
  return 0.005 + 0.04 * std::sqrt(pressure / 100e6);
}

/// The pressure first, on all sides; then the ends approach while the sides hold it.
void squeeze_and_shear(dem::Config& c, const SpecimenTest& test) {
  const double confined = 4e-3 / faster(test.size);
  // Servos follow sides that burst outwards under little pressure only slowly.
  const double rate = 1.5 * faster(test.size) * std::min(1.0, test.pressure / 20e6);
  const double areas[3] = {test.size.y * test.size.z, test.size.x * test.size.z,
                           test.size.x * test.size.y};
  const auto moving = add_faces(c, test.size);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    SupportServoConfig& servo = c.supports[moving[axis]].servo;
    servo.axis = std::string(1, "xyz"[axis]);
    servo.pressure.times = {0.0, 0.5 * confined, 0.75 * confined};
    servo.pressure.values = {0.0, -0.9 * test.pressure, -test.pressure};
    servo.area = areas[axis];
    servo.speed = 1.0;
    servo.gain = 2.0;
    servo.mass = no_limit;
  }
  dem::StageConfig confine, shear;
  confine.name = "confine";
  confine.until = confined;
  shear.name = "shear";
  dem::SupportChange close;
  close.name = "top";
  close.velocity = Vec3{0.0, 0.0, -rate * test.size.z};
  shear.supports = {close};
  c.stages = {confine, shear};
  c.time.end = confined + sheared_strain(test.pressure) / rate;
}

/// Pairs of faces that close alike; the others stand still.
void close_faces(dem::Config& c, const Vec3& size, double strain, double rate,
                 const std::string& axes) {
  c.time.end = strain / rate;
  const auto moving = add_faces(c, size);
  const double edges[3] = {size.x, size.y, size.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axes.find("xyz"[axis]) == std::string::npos) continue;
    dem::SupportConfig& s = c.supports[moving[axis]];
    const double v = -rate * edges[axis];
    s.velocity = Vec3{axis == 0 ? v : 0.0, axis == 1 ? v : 0.0, axis == 2 ? v : 0.0};
    s.ramp = 0.02 * c.time.end;
  }
}

}  // namespace

std::vector<SpecimenTest> ldpm_tests(const dem::MaterialConfig& material) {
  const double b = edge_of(material);
  const Vec3 prism{b, b, 2.0 * b}, cube{b, b, b};
  std::vector<SpecimenTest> tests{
      {"compression_prism", "compression, prism, smooth ends", Loading::compression, prism},
      {"compression_cube", "compression, cube, smooth ends", Loading::compression, cube},
      {"platens_prism", "compression, prism, rough platens", Loading::platens, prism},
      {"platens_cube", "compression, cube, rough platens", Loading::platens, cube},
      {"held_prism", "compression, prism, held ends", Loading::platens, prism},
      {"held_cube", "compression, cube, held ends", Loading::platens, cube},
      {"tension", "direct tension, prism", Loading::tension, prism},
      {"tension_notched",
       "direct tension, notched prism",
       Loading::notched_tension,
       {b, b, 1.5 * b},
       0.0,
       0.25 * b}};
  for (const int pressure : {5, 20, 50, 100, 200})
    tests.push_back({fmt::format("triaxial_{}", pressure),
                     fmt::format("triaxial compression at {} MPa", pressure), Loading::triaxial,
                     prism, 1e6 * pressure});
  tests.push_back(
      {"biaxial", "equal biaxial compression, cube, smooth plates", Loading::biaxial, cube});
  tests.push_back({"oedometer", "oedometer, cube", Loading::oedometer, cube});
  tests.push_back({"hydrostatic", "hydrostatic pressure, cube", Loading::hydrostatic, cube});
  return tests;
}

dem::Config ldpm_case_of(const SpecimenTest& test, const Sample& sample, std::int64_t seed) {
  dem::Config c;
  c.title = test.title;
  c.seed = seed;
  c.local_damping = 0.3;
  c.materials = {sample.material};
  c.materials[0].ldpm.rate_factor = 0.0;  // slow tests, though they take milliseconds
  c.contact = sample.contact;
  c.time.evaluate_every = 1;  // as the numbers of docs/results were found, to the last bit
  c.output.frames = 0;
  c.output.fields = c.output.pictures = false;
  c.energy.stop = 0.1;
  c.search.margin = 0.5;
  dem::BodyConfig body;
  body.name = "specimen";
  body.material = sample.material.name;
  body.size = test.size;
  c.bodies = {body};
  const double height = test.size.z, more = faster(test.size);
  switch (test.loading) {
    case Loading::compression:
      c.time.end = 5e-3 / (0.6 * more);
      add_ends(c, test.size, -0.6 * more * height);
      add_gauges(c, test.size);
      break;
    case Loading::platens:
      c.time.end = 1.2e-2 / (0.8 * more);
      add_ends(c, test.size, -0.8 * more * height);
      if (test.name.starts_with("held"))
        hold_ends(c);
      else
        roughen_ends(c);
      break;
    case Loading::tension:
      c.time.end = 5e-4 / (0.2 * more);
      add_ends(c, test.size, 0.2 * more * height);
      add_gauges(c, test.size);
      break;
    case Loading::notched_tension:
      pull_apart(c, test);
      break;
    case Loading::triaxial:
      squeeze_and_shear(c, test);
      break;
    case Loading::oedometer:
      close_faces(c, test.size, 0.06, 4.0 * more, "z");
      break;
    case Loading::hydrostatic:
      close_faces(c, test.size, 0.025, 1.5 * more, "xyz");
      break;
    case Loading::biaxial:
      close_faces(c, test.size, 8e-3, 0.6 * more, "xz");
      for (dem::SupportConfig& s : c.supports)
        if (s.name == "front" || s.name == "back") s.fix = {};
      break;
    default:
      throw InputError(test.title + " is no test of law ldpm");
  }
  return c;
}

}  // namespace breccia::laboratory
