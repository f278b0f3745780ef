#include "laboratory/rock_tests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exec/error.hpp"
#include "math/constants.hpp"

namespace breccia::laboratory {
namespace {

constexpr double plate_width = 0.05, plate_height = 0.1, plane_disc_diameter = 0.05;  // m
constexpr double outside = 1.0, thin = 1e-3 * plate_width;
constexpr double strain_rate = 4.0;  // 1/s

/// Edge of so many equilateral triangles in an area.  [m]
double edge_for(double area, int triangles) {
  return std::sqrt(4.0 * area / (std::sqrt(3.0) * triangles));
}

/// Axial stress by Mohr and Coulomb.  [Pa]
double strength_of(const fdem::StrengthConfig& joint, double pressure) {
  const double sine = std::sin(joint.friction_angle), cosine = std::cos(joint.friction_angle);
  return 2.0 * joint.cohesion * cosine / (1.0 - sine) + pressure * gain_of(joint.friction_angle);
}

const MaterialTarget* target_of(const std::vector<MaterialTarget>& targets, const char* name) {
  const auto found = std::find_if(targets.begin(), targets.end(),
                                  [&](const MaterialTarget& t) { return t.name == name; });
  return found == targets.end() ? nullptr : &*found;
}

fdem::SupportConfig support(const char* name, const Vec2& min, const Vec2& max, double speed,
                            double ramp) {
  fdem::SupportConfig s;
  s.name = name;
  s.region.on = "specimen";
  s.region.min = min;
  s.region.max = max;
  s.fix = {"y"};
  s.velocity = Vec2{0.0, speed};
  s.history.ramp = ramp;
  return s;
}

ProbeConfig probe(const char* name, const char* on, const char* quantity, const char* reduce) {
  return {name, on, quantity, reduce};
}

void add_end_probes(fdem::Config& c) {
  c.probes = {probe("force_top", "top", "force_y", "sum"),
              probe("force_bottom", "bottom", "force_y", "sum"),
              probe("top", "top", "position_y", "mean"),
              probe("bottom", "bottom", "position_y", "mean")};
}

fdem::BodyConfig body_of(const RockSample& sample, double area, std::int64_t seed) {
  fdem::BodyConfig body;
  body.name = "specimen";
  body.material = sample.material.name;
  body.jitter = 0.1;
  // edges that differ by up to 2 % make another mesh of each seed
  body.mesh_size =
      edge_for(area, sample.elements) * (1.0 + 0.01 * (static_cast<double>((seed + 2) % 5) - 2.0));
  return body;
}

/// Smooth ends approach; a pressure on the sides comes first.
void press_plate(fdem::Config& c, const RockSample& sample, double pressure) {
  const double x = 0.5 * plate_width, y = 0.5 * plate_height;
  const double expected = strength_of(sample.material.joint, pressure) / sample.material.young;
  const double ramp = pressure > 0.0 ? 1e-4 : 5e-5;
  c.bodies = {body_of(sample, plate_width * plate_height, c.seed)};
  c.bodies[0].shape = "plate";
  c.bodies[0].size = {plate_width, plate_height};
  const double speed = 0.5 * strain_rate * plate_height;
  c.supports = {support("top", {-outside, y - thin}, {outside, outside}, -speed, ramp),
                support("bottom", {-outside, -outside}, {outside, thin - y}, speed, ramp)};
  for (const double side : {-1.0, 1.0}) {
    if (!(pressure > 0.0)) break;
    fdem::LoadConfig load;
    load.name = side < 0.0 ? "left" : "right";
    load.region.on = "specimen";
    load.region.min = side < 0.0 ? Vec2{-outside, -outside} : Vec2{x - thin, -outside};
    load.region.max = side < 0.0 ? Vec2{thin - x, outside} : Vec2{outside, outside};
    load.pressure = pressure;
    load.history.ramp = ramp;
    c.loads.push_back(load);
  }
  // peaks under pressure come at 0.8 to 1.02 of that strain
  c.time.end = ramp + ((pressure > 0.0 ? 1.2 : 1.35) * expected + 2e-4) / strain_rate;
  add_end_probes(c);
  for (const double side : {-1.0, 1.0}) {
    ProbeConfig across = probe(side < 0.0 ? "left" : "right", "specimen", "displacement_x", "mean");
    const double strip = 0.02 * plate_width;
    across.min = {side < 0.0 ? -outside : x - strip, -0.5 * y};
    across.max = {side < 0.0 ? strip - x : outside, 0.5 * y};
    c.probes.push_back(across);
  }
}

/// Smooth ends part, until a plate without softening would hold twice the strength. A concrete's
/// strength is shown so: a disc of it that is 50 mm wide has not split when its middle has cracked.
void pull_plate(fdem::Config& c, const RockSample& sample) {
  const double ramp = 1e-4, rate = strain_rate / 8.0, y = 0.5 * plate_height;
  press_plate(c, sample, 0.0);
  c.supports = {support("top", {-outside, y - thin}, {outside, outside}, rate * y, ramp),
                support("bottom", {-outside, -outside}, {outside, thin - y}, -rate * y, ramp)};
  c.time.end = ramp + 2.0 * sample.material.joint.tension / sample.material.young / rate;
}

/// Flats a tenth of the diameter wide approach: meshes of all sizes have the same ones, while of a
/// round rim they would hold two corners or three.
void press_disc(fdem::Config& c, const RockSample& sample) {
  const double radius = 0.5 * plane_disc_diameter, strip = 0.1 * radius, rim = 1e-3 * radius;
  const double depth = std::sqrt(radius * radius - strip * strip);
  c.bodies = {body_of(sample, pi * radius * radius, c.seed)};
  c.bodies[0].shape = "disc";
  c.bodies[0].radius = radius;
  for (const double side : {-1.0, 1.0}) {  // what lies beyond them is cut off
    fdem::HoleConfig cap;
    cap.center = {0.0, 1.5 * side * depth};
    cap.corners = {{-radius, -0.5 * depth},
                   {radius, -0.5 * depth},
                   {radius, 0.5 * depth},
                   {-radius, 0.5 * depth}};
    c.bodies[0].holes.push_back(cap);
  }
  // closing over diameter at the peak, by the elastic disc between strips: about 6 f_t/E
  const double closing = 9.0 * sample.material.joint.tension / sample.material.young;
  const double ramp = 5e-5, speed = 0.5 * strain_rate / 4.0 * plane_disc_diameter;
  c.supports = {support("top", {-outside, depth - rim}, {outside, outside}, -speed, ramp),
                support("bottom", {-outside, -outside}, {outside, rim - depth}, speed, ramp)};
  c.time.end = ramp + closing / (strain_rate / 4.0);
  add_end_probes(c);
}

bool is_tested_rock(const fdem::MaterialConfig& material) {
  return material.joints != "none";
}

}  // namespace

RockSample rock_sample_of(const fdem::Config& config, const std::string& material) {
  const auto found = std::find_if(config.materials.begin(), config.materials.end(),
                                  [&](const auto& m) { return m.name == material; });
  if (found == config.materials.end())
    throw InputError(no_such_material(material, config.materials, is_tested_rock));
  if (!is_tested_rock(*found))
    throw InputError(
        fmt::format("material {} has no joints: it does not break; nothing was run", material));
  RockSample sample;
  sample.material = *found;
  sample.joints = config.joints;
  return sample;
}

double gain_of(double friction_angle) {
  const double sine = std::sin(friction_angle);
  return (1.0 + sine) / (1.0 - sine);
}

double angle_for(double friction_angle, double gain_change) {
  return 0.5 * std::cos(friction_angle) * gain_change / gain_of(friction_angle);
}

double side_pressure(const std::vector<MaterialTarget>& targets,
                     const fdem::StrengthConfig& joint) {
  const MaterialTarget* const strength = target_of(targets, "compression");
  const MaterialTarget* const most = target_of(targets, "confinement");
  const double half = 0.5 * (strength ? strength->value : strength_of(joint, 0.0));
  return most ? std::min(half, most->value) : half;
}

std::optional<double> pressed_strength(const std::vector<MaterialTarget>& targets,
                                       double pressure) {
  const MaterialTarget* const strength = target_of(targets, "compression");
  const MaterialTarget* const angle = target_of(targets, "friction_angle");
  if (strength == nullptr || angle == nullptr) return std::nullopt;
  return strength->value + pressure * gain_of(angle->value);
}

std::vector<SpecimenTest> rock_tests(double pressure) {
  const Vec3 plate{plate_width, plate_height, 1.0};
  return {
      {"plate", "compression, plate, smooth ends", Loading::plate, plate},
      {"plate_pressed", fmt::format("compression, plate, {:.3g} MPa on its sides", 1e-6 * pressure),
       Loading::plate, plate, pressure},
      {"disc",
       "Brazilian, disc",
       Loading::plane_disc,
       {plane_disc_diameter, plane_disc_diameter, 1.0}},
      {"tension", "direct tension, plate", Loading::pulled_plate, plate}};
}

fdem::Config case_of(const SpecimenTest& test, const RockSample& sample, std::int64_t seed,
                     const std::string&) {
  fdem::Config c;
  c.title = test.title;
  c.seed = seed;
  c.method = "fdem2d";
  c.plane = "stress";
  c.joints = sample.joints;
  c.materials = {sample.material};
  c.materials[0].damping = 0.5;  // a slow test within a millisecond
  c.time.evaluate_every = 100;
  c.output.frames = 0;
  c.output.fields = c.output.pictures = false;
  c.energy.stop = 0.1;
  if (test.loading == Loading::plane_disc)
    press_disc(c, sample);
  else if (test.loading == Loading::pulled_plate)
    pull_plate(c, sample);
  else
    press_plate(c, sample, test.pressure);
  return c;
}

}  // namespace breccia::laboratory
