#include "laboratory/concrete_tests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/setup/materials.hpp"
#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "laboratory/ldpm_tests.hpp"
#include "math/constants.hpp"
#include "prepare/packing/packing.hpp"

namespace breccia::laboratory {
namespace {

constexpr double prism_edge = 0.1, prism_height = 0.2;  // m
// EN 12390-6: 150 mm, strips of 10 mm. Of concrete that parts slowly a smaller disc, or wider
// strips, bears far more than f_t (docs/trials-concrete.md).
constexpr double disc_diameter = 0.15, disc_thickness = 0.05, strip_width = 0.01;
constexpr double beam_length = 0.34, beam_edge = 0.1, beam_notch = 0.033;
constexpr double far = 1.0;

/// Of elements that fill a volume [m3] together.  [m]
double mean_radius(double volume, int elements) {
  return std::cbrt(0.75 * volume / (pi * elements));
}

/// Elements as large as the prism's.
int count_for(const Sample& sample, double volume) {
  return std::max(
      100, static_cast<int>(sample.elements * volume / (prism_edge * prism_edge * prism_height)));
}

dem::SupportConfig support(const std::string& name, const Vec3& min, const Vec3& max,
                           std::vector<std::string> fix, const Vec3& velocity, double ramp) {
  dem::SupportConfig s;
  s.name = name;
  s.min = min;
  s.max = max;
  s.fix = std::move(fix);
  s.velocity = velocity;
  s.ramp = ramp;
  return s;
}
ProbeConfig probe(const std::string& name, const std::string& on, const std::string& quantity,
                  const std::string& reduce) {
  return {name, on, quantity, reduce};
}

void add_body(dem::Config& c, const Sample& sample, const Vec3& size) {
  dem::BodyConfig body;
  body.name = "specimen";
  body.material = sample.material.name;
  body.size = size;
  body.pack = {count_for(sample, size.x * size.y * size.z), sample.size_ratio, sample.compactness};
  c.bodies = {body};
}

/// Layers at both ends that part at `speed`, or approach, and gauges on two sides.
void load_ends(dem::Config& c, const Vec3& size, double radius, double speed) {
  const double layer = 0.5 * size.z - 2.0 * radius, side = 0.5 * size.x - 2.0 * radius;
  const double ramp = 0.1 * c.time.end;
  c.supports = {
      support("top", {-far, -far, layer}, {far, far, far}, {"z"}, {0.0, 0.0, 0.5 * speed}, ramp),
      support("bottom", {-far, -far, -far}, {far, far, -layer}, {"z"}, {0.0, 0.0, -0.5 * speed},
              ramp),
      support("right", {side, -far, -0.25 * size.z}, {far, far, 0.25 * size.z}, {}, {}, 0.0),
      support("left", {-far, -far, -0.25 * size.z}, {-side, far, 0.25 * size.z}, {}, {}, 0.0)};
  c.probes = {probe("force_top", "top", "force_z", "sum"),
              probe("force_bottom", "bottom", "force_z", "sum"),
              probe("top", "top", "position_z", "mean"),
              probe("bottom", "bottom", "position_z", "mean"),
              probe("right", "right", "position_x", "mean"),
              probe("left", "left", "position_x", "mean")};
}

void load_by_platens(dem::Config& c, const Vec3& size, double speed) {
  for (const double side : {1.0, -1.0}) {
    dem::WallConfig wall;
    wall.name = side > 0.0 ? "top" : "bottom";
    wall.point = {0.0, 0.0, 0.5 * side * size.z};
    wall.normal = {0.0, 0.0, -side};
    wall.velocity = {0.0, 0.0, -0.5 * side * speed};
    c.walls.push_back(wall);
    c.probes.push_back(probe("force_" + wall.name, wall.name, "force_z", "sum"));
    c.probes.push_back(probe(wall.name, wall.name, "position_z", "mean"));
  }
}

/// Strain rate of the shearing, and the strain to which it goes, larger under more pressure.
constexpr double triaxial_rate = 1.5;  // 1/s
double triaxial_strain(double pressure) {
  return 0.01 + 0.05 * std::sqrt(pressure / 100e6);
}

/// Six smooth walls; the sides go on pressing when the ends move.
void load_triaxially(dem::Config& c, const Vec3& size, double pressure) {
  const double slower = std::max(1.0, pressure / 200e6);  // the walls have farther to go
  const double confined = 4e-3 * slower;                  // s; the pressure is whole after 3 ms
  const auto add = [&](const char* name, const Vec3& outwards, double half, double area) {
    dem::WallConfig wall;
    wall.name = name;
    wall.point = half * outwards;
    wall.normal = -outwards;
    wall.friction = 0.0;
    wall.servo.pressure.times = {0.0, 2e-3 * slower, 3e-3 * slower};
    wall.servo.pressure.values = {0.0, 0.9 * pressure, pressure};
    wall.servo.speed = 1.0;
    wall.servo.mass = no_limit;
    wall.servo.area = area;
    c.walls.push_back(wall);
  };
  add("top", {0.0, 0.0, 1.0}, 0.5 * size.z, size.x * size.y);
  add("bottom", {0.0, 0.0, -1.0}, 0.5 * size.z, size.x * size.y);
  add("right", {1.0, 0.0, 0.0}, 0.5 * size.x, size.y * size.z);
  add("left", {-1.0, 0.0, 0.0}, 0.5 * size.x, size.y * size.z);
  add("back", {0.0, 1.0, 0.0}, 0.5 * size.y, size.x * size.z);
  add("front", {0.0, -1.0, 0.0}, 0.5 * size.y, size.x * size.z);
  dem::StageConfig confine, shear;
  confine.name = "confine";
  confine.until = confined;
  shear.name = "shear";
  for (const double side : {1.0, -1.0}) {
    dem::WallChange change;
    change.name = side > 0.0 ? "top" : "bottom";
    change.velocity = Vec3{0.0, 0.0, -0.5 * side * triaxial_rate * size.z};
    shear.walls.push_back(change);
    c.probes.push_back(probe("force_" + change.name, change.name, "force_z", "sum"));
    c.probes.push_back(probe(change.name, change.name, "position_z", "mean"));
  }
  c.probes.push_back(probe("force_side", "right", "force_x", "sum"));
  c.stages = {confine, shear};
  c.time.end = confined + triaxial_strain(pressure) / triaxial_rate;
}

/// Smooth walls that stand still around a specimen whose ends approach.
void load_between_sides(dem::Config& c, const Vec3& size, double speed) {
  load_by_platens(c, size, speed);
  const auto add = [&](const char* name, const Vec3& outwards, double half) {
    dem::WallConfig wall;
    wall.name = name;
    wall.point = half * outwards;
    wall.normal = -outwards;
    c.walls.push_back(wall);
  };
  add("right", {1.0, 0.0, 0.0}, 0.5 * size.x);
  add("left", {-1.0, 0.0, 0.0}, 0.5 * size.x);
  add("back", {0.0, 1.0, 0.0}, 0.5 * size.y);
  add("front", {0.0, -1.0, 0.0}, 0.5 * size.y);
  for (dem::WallConfig& wall : c.walls) wall.friction = 0.0;
  c.probes.push_back(probe("force_side", "right", "force_x", "sum"));
}

/// Opening at which links break, about: of the fracture energy, or of the softening.  [m]
double opening_of(const dem::MaterialConfig& m, double radius) {
  constexpr double crossing = 2.7, oblique = 1.5;  // theory.md, fracture energy
  constexpr double least = 20e-6;
  const double link = 2.4 * radius;
  const double below = dem::softening_knee(m).area;
  return std::max(least,
                  m.fracture_energy > 0.0
                      ? 2.0 * m.fracture_energy / (crossing * oblique * m.tensile_strength * below)
                      : (1.0 + m.softening) * m.tensile_strength / m.young * link);
}

/// Two notches, which cut links alone; the ends are held and part until the crack is open.
void pull_notched(dem::Config& c, const SpecimenTest& test, double radius) {
  constexpr double speed = 0.04, elastic = 40e-6, wide = 1.0;
  for (const double side : {1.0, -1.0}) {
    dem::CutConfig cut;
    cut.shape = "box";
    cut.center = {0.5 * side * (test.size.x - test.notch + wide), 0.0, 0.0};
    cut.size = {test.notch + wide, wide, 0.0};
    c.bodies[0].cuts.push_back(cut);
  }
  c.time.end = (3.0 * opening_of(c.materials[0], radius) + elastic) / speed;
  load_ends(c, test.size, radius, speed);
  for (std::size_t end : {0, 1}) {
    c.supports[end].fix = {"x", "y", "z"};
    c.supports[end].ramp = 1e-4;
  }
}

/// Strips press a disc along x.
void load_strips(dem::Config& c, const Sample& sample, double speed) {
  const double volume = pi / 4.0 * disc_diameter * disc_diameter * disc_thickness;
  const int elements = std::max(sample.elements, fewest_in_disc);
  const double radius = mean_radius(volume * sample.compactness, elements);
  dem::BodyConfig& body = c.bodies[0];
  body.shape = "cylinder";
  body.size = {};
  body.radius = 0.5 * disc_diameter;
  body.length = disc_thickness;
  body.pack.count = elements;
  const double strip = 0.5 * strip_width, depth = 0.5 * disc_diameter - 2.5 * radius;
  const double ramp = 0.1 * c.time.end;
  c.supports = {support("top", {depth, -strip, -far}, {far, strip, far}, {"x"},
                        {-0.5 * speed, 0.0, 0.0}, ramp),
                support("bottom", {-far, -strip, -far}, {-depth, strip, far}, {"x"},
                        {0.5 * speed, 0.0, 0.0}, ramp)};
  c.probes = {probe("force_top", "top", "force_x", "sum"),
              probe("force_bottom", "bottom", "force_x", "sum"),
              probe("top", "top", "position_x", "mean"),
              probe("bottom", "bottom", "position_x", "mean")};
}

/// A packing without the spheres of the notch. Links reach across 1.44 diameters, the largest ones
/// of which are 4/3 of the mean, so the notch is four mean radii wide.
void write_notched(const std::string& path, const Sample& sample, const Vec3& size, double radius,
                   std::int64_t seed) {
  prepare::PackingTask task;
  task.container = {prepare::Container::Shape::box, size, 0.0, 0.0};
  task.count = count_for(sample, size.x * size.y * size.z);
  task.size_ratio = sample.size_ratio;
  task.solid_volume = sample.compactness * size.x * size.y * size.z;
  task.random = {static_cast<std::uint64_t>(seed), 0};
  const prepare::Packing packing = prepare::pack(task);
  std::string text = "x,y,z,radius\n";
  for (std::size_t e = 0; e < packing.position.size(); ++e) {
    const Vec3& x = packing.position[e];
    if (std::abs(x.x) < 2.0 * radius && x.z < beam_notch - 0.5 * size.z) continue;
    text += fmt::format("{},{},{},{}\n", x.x, x.y, x.z, packing.radius[e]);
  }
  replace_file(path, text);
}

void cut_notch(dem::Config& c, const Sample& sample, const Vec3& size, double radius,
               const std::string& folder) {
  const std::string file = fmt::format("beam-{}-{}.csv", sample.elements, c.seed);
  write_notched(folder + "/" + file, sample, size, radius, c.seed);
  dem::BodyConfig& body = c.bodies[0];
  body.shape = "file";
  body.file = file;
  body.pack = {};
  body.volume = size.x * size.y * size.z - 4.0 * radius * beam_notch * size.y;
}

void load_beam(dem::Config& c, const Vec3& size, double radius, double speed, double apart) {
  // Lines across the beam, as thin as holds three elements: all elements of a support keep one
  // height, so that wide ones clamp the ends of the beam (three radii: a fifth of the moment at the
  // peak, a third after it). An element takes some 4.4 R^2 of a face.
  const double width = std::max(0.5 * radius, 3.0 * 4.4 * radius * radius / (2.0 * size.y));
  const double below = -0.5 * size.z + 2.0 * radius;
  const auto roller = [&](const char* name, double x) {
    return support(name, {x - width, -far, -far}, {x + width, far, below}, {"z"}, {}, 0.0);
  };
  const auto press = [&](const char* name, double x) {
    return support(name, {x - width, -far, -below}, {x + width, far, far}, {"z"},
                   {0.0, 0.0, -speed}, 0.1 * c.time.end);
  };
  c.supports = {roller("left", -0.5 * beam_span), roller("right", 0.5 * beam_span),
                press("top", -0.5 * apart)};
  c.probes = {
      probe("force_top", "top", "force_z", "sum"), probe("force_left", "left", "force_z", "sum"),
      probe("force_right", "right", "force_z", "sum"), probe("top", "top", "position_z", "mean")};
  if (apart == 0.0) return;
  c.supports.push_back(press("top_right", 0.5 * apart));
  c.probes.push_back(probe("force_top_right", "top_right", "force_z", "sum"));
}

bool is_tested_concrete(const dem::MaterialConfig& material) {
  return material.law == "concrete" || material.law == "parallel" || material.law == "ldpm";
}

}  // namespace

Sample sample_of(const dem::Config& config, const std::string& material) {
  Sample sample;
  const auto found = std::find_if(config.materials.begin(), config.materials.end(),
                                  [&](const auto& m) { return m.name == material; });
  if (found == config.materials.end())
    throw InputError(no_such_material(material, config.materials, is_tested_concrete));
  if (!is_tested_concrete(*found))
    throw InputError(
        fmt::format("material {} has the law {}: only concrete, parallel bonds and ldpm are "
                    "tested; nothing was run",
                    material, found->law));
  sample.material = *found;
  if (found->link_damping > 0.0) sample.damping = 0.0;
  sample.contact = config.contact;
  for (const dem::BodyConfig& body : config.bodies)
    if (body.material == material && (body.pack.count > 0 || !body.pack.sieves.empty())) {
      const dem::PackConfig& pack = body.pack;
      sample.size_ratio = pack.sieves.empty()
                              ? pack.size_ratio
                              : std::min(pack.sieves.back() / pack.sieves.front(), 10.0);
      sample.compactness = pack.porosity > 0.0 ? 1.0 - pack.porosity : pack.compactness;
      break;
    }
  if (!config.bodies.empty() && config.links.count == 0 && config.links.per_element == 0.0)
    sample.range = config.links.range;
  return sample;
}

const std::vector<SpecimenTest>& specimen_tests() {
  const Vec3 prism{prism_edge, prism_edge, prism_height}, cube{prism_edge, prism_edge, prism_edge};
  static const std::vector<SpecimenTest> tests{
      {"compression_prism", "compression, prism, smooth ends", Loading::compression, prism},
      {"compression_cube", "compression, cube, smooth ends", Loading::compression, cube},
      {"platens_prism", "compression, prism, rough platens", Loading::platens, prism},
      {"platens_cube", "compression, cube, rough platens", Loading::platens, cube},
      {"tension", "direct tension, prism", Loading::tension, prism},
      {"tension_notched",
       "direct tension, notched prism",
       Loading::notched_tension,
       {prism_edge, prism_edge, 0.15},
       0.0,
       0.025},
      {"brazilian",
       "Brazilian, disc",
       Loading::brazilian,
       {disc_diameter, disc_diameter, disc_thickness}},
      {"bending",
       "three-point bending, notched beam",
       Loading::bending,
       {beam_length, beam_edge, beam_edge},
       0.0,
       beam_notch},
      {"bending_plain",
       "three-point bending, plain beam",
       Loading::bending,
       {beam_length, beam_edge, beam_edge}},
      {"bending_thirds",
       "four-point bending, plain beam",
       Loading::bending,
       {beam_length, beam_edge, beam_edge},
       0.0,
       0.0,
       beam_span / 3.0},
      {"triaxial_5", "triaxial compression at 5 MPa", Loading::triaxial, prism, 5e6},
      {"triaxial_20", "triaxial compression at 20 MPa", Loading::triaxial, prism, 20e6},
      {"triaxial_50", "triaxial compression at 50 MPa", Loading::triaxial, prism, 50e6},
      {"triaxial_100", "triaxial compression at 100 MPa", Loading::triaxial, prism, 100e6},
      {"triaxial_200", "triaxial compression at 200 MPa", Loading::triaxial, prism, 200e6},
      {"triaxial_500", "triaxial compression at 500 MPa", Loading::triaxial, prism, 500e6, 0.0, 0.0,
       true},
      {"triaxial_650", "triaxial compression at 650 MPa", Loading::triaxial, prism, 650e6, 0.0, 0.0,
       true},
      {"oedometer", "oedometer, cube", Loading::oedometer, cube}};
  return tests;
}

bool has_walls(const SpecimenTest& test) {
  return test.loading == Loading::platens || test.loading == Loading::triaxial ||
         test.loading == Loading::oedometer;
}

std::vector<SpecimenTest> tests_of(const dem::MaterialConfig& material) {
  return material.law == "ldpm" ? ldpm_tests(material) : specimen_tests();
}

dem::Config case_of(const SpecimenTest& test, const Sample& sample, std::int64_t seed,
                    const std::string& folder) {
  if (sample.material.law == "ldpm") return ldpm_case_of(test, sample, seed);
  dem::Config c;
  c.title = test.title;
  c.seed = seed;
  c.local_damping = sample.damping;
  c.materials = {sample.material};
  c.materials[0].rate = "none";  // all of them are quasi-static, though they load in milliseconds
  c.contact = sample.contact;
  c.links.range = sample.range;
  c.time.evaluate_every = 1;  // as the numbers of docs/results were found, to the last bit
  c.output.frames = 0;
  c.output.fields = c.output.pictures = false;
  c.energy.stop = 0.1;
  c.search.margin = 0.5;
  add_body(c, sample, test.size);
  const double prism = prism_edge * prism_edge * prism_height;
  const double radius = mean_radius(prism * sample.compactness, sample.elements);
  // Speeds and times: strains of 0.5 % in compression at 0.6/s and of 0.05 % in tension at 0.2/s,
  // as slow as halving the rate changes the strength by less than packings differ.
  const double height = test.size.z;
  switch (test.loading) {
    case Loading::compression:
      c.time.end = 5e-3 / 0.6;
      load_ends(c, test.size, radius, -0.6 * height);
      break;
    case Loading::platens:
      c.time.end = 8e-3 / 0.8;
      load_by_platens(c, test.size, 0.8 * height);
      break;
    case Loading::tension:
      c.time.end = 5e-4 / 0.2;
      load_ends(c, test.size, radius, 0.2 * height);
      break;
    case Loading::notched_tension:
      pull_notched(c, test, radius);
      break;
    case Loading::brazilian:
      c.time.end = 6e-3;
      load_strips(c, sample, 0.05);
      break;
    case Loading::bending:
      c.local_damping = std::min(sample.damping, 0.05);  // more: work of the falling halves
      c.time.end = 7e-3;
      if (test.notch > 0.0) cut_notch(c, sample, test.size, radius, folder);
      load_beam(c, test.size, radius, 0.08, test.apart);
      break;
    case Loading::triaxial:
      load_triaxially(c, test.size, test.pressure);
      break;
    case Loading::oedometer:
      c.time.end = 0.14 / 4.0;
      load_between_sides(c, test.size, 4.0 * height);
      break;
    case Loading::hydrostatic:
    case Loading::biaxial:
    case Loading::plate:
    case Loading::plane_disc:
    case Loading::pulled_plate:
      throw InputError(test.title + " is no test of spheres");
  }
  return c;
}

}  // namespace breccia::laboratory
