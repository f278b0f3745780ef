// The slab of cases/rc_slab in DEM-Engine.
//
//   dem_engine_slab FOLDER [--steps N] [--windows N] [--copies N] [--still] [--whole] [--contacts]
//
// FOLDER holds elements.csv, links.csv and dt.txt as for the other peers. Every link of Breccia is
// a contact that is there from the start and carries a bond: a spring along the axis and one across
// it, of a round beam of the smaller end's radius, without moments; it breaks at once where one of
// the two forces reaches its strength. DEM-Engine itself has no bonds: this is its force model of
// one's own. It knows a pair only within a margin around the spheres, so margins hold the longest
// links, and the model is called for every pair of spheres that are as near, linked or not.
//
//   --steps N     steps of a window (2000)      --windows N   windows (5; one more goes before)
//   --copies N    slabs side by side (1)        --still       the rock stands still
//   --whole       bonds do not break            --contacts    no bonds: spheres and Hertz contacts
//   alone
//
// The last line says all as JSON.
#include <DEM/API.h>

#include <DEM/HostSideHelpers.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

constexpr double young = 30e9, shear = 12.5e9;      // [Pa]
constexpr double tension = 2.2e6, cohesion = 11e6;  // [Pa]
constexpr double friction = 0.5;                    // [-]
constexpr float speed = 30.0f;                      // of the rock  [m/s]
constexpr double pitch = 2.0;                       // of copies, along x and y  [m]
enum Family : unsigned { concrete = 1, held_concrete = 2, steel = 3, held_steel = 4 };

struct Element {
  double x, y, z, radius, mass;
  std::string group;
  bool held;
};

std::vector<std::vector<std::string>> rows(const std::string& path) {
  std::ifstream file(path);
  if (!file) {
    std::fprintf(stderr, "%s: cannot be read\n", path.c_str());
    std::exit(2);
  }
  std::vector<std::vector<std::string>> all;
  std::string line, cell;
  std::getline(file, line);  // names
  std::getline(file, line);  // units
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    all.emplace_back();
    while (std::getline(cells, cell, ',')) all.back().push_back(cell);
  }
  return all;
}

/// What acts between two spheres, as text that DEM-Engine compiles.
std::string law(bool whole) {
  char constants[512];
  std::snprintf(constants, sizeof constants,
                "const float k_young = %.8ef, k_shear = %.8ef, k_tension = %.8ef, k_cohesion = "
                "%.8ef, k_friction = %.8ef;\n",
                young, shear, whole ? 1e30 : tension, whole ? 1e30 : cohesion, friction);
  return constants + std::string(R"(
float3 spin_a = cross(ARotVel, locCPA), spin_b = cross(BRotVel, locCPB);
applyOriQToVector3<float, deme::oriQ_t>(spin_a.x, spin_a.y, spin_a.z, AOriQ.w, AOriQ.x, AOriQ.y, AOriQ.z);
applyOriQToVector3<float, deme::oriQ_t>(spin_b.x, spin_b.y, spin_b.z, BOriQ.w, BOriQ.x, BOriQ.y, BOriQ.z);
const float3 past = (ALinVel + spin_a) - (BLinVel + spin_b);
float3 slip = make_float3(slip_x, slip_y, slip_z) + ts * (past - dot(past, B2A) * B2A);
slip = slip - dot(slip, B2A) * B2A;
const float reach = (ARadius < BRadius) ? ARadius : BRadius;
const float section = 3.14159265f * reach * reach;
if (bond > 0.5f) {
  const float span = ARadius + BRadius - rest;
  const float along = k_young * section / span * (float)(overlapDepth - (double)rest);
  const float3 across = (-k_shear * section / span) * slip;
  if (-along >= k_tension * section || length(across) >= k_cohesion * section) {
    bond = 0.f;
    slip = make_float3(0.f, 0.f, 0.f);
  } else {
    force = along * B2A + across;
  }
}
if (bond < 0.5f) {
  if (overlapDepth > 0.) {
    const float along = k_young * reach * (float)overlapDepth;
    float3 across = (-0.5f * k_young * reach) * slip;
    const float sliding = length(across);
    if (sliding > k_friction * along) {
      across = (k_friction * along / sliding) * across;
      slip = (-2.f / (k_young * reach)) * across;
    }
    force = along * B2A + across;
  } else {
    slip = make_float3(0.f, 0.f, 0.f);
  }
}
slip_x = slip.x;
slip_y = slip.y;
slip_z = slip.z;
)");
}

struct Scene {
  std::vector<Element> elements;
  std::vector<std::pair<unsigned, unsigned>> links;  ///< ordered, the lower number first
  std::vector<float> rest;  ///< overlap of each link at the start, below zero  [m]
  double dt = 0.0, gap = 0.0, steel_gap = 0.0;  ///< longest gaps of links  [s, m, m]
};

Scene read(const std::string& folder) {
  Scene scene;
  for (const auto& c : rows(folder + "/elements.csv"))
    scene.elements.push_back({std::stod(c[0]), std::stod(c[1]), std::stod(c[2]), std::stod(c[3]),
                              std::stod(c[4]), c[5], c[6] != "0"});
  for (const auto& c : rows(folder + "/links.csv")) {
    const unsigned a = std::stoul(c[0]), b = std::stoul(c[1]);
    scene.links.emplace_back(std::min(a, b), std::max(a, b));
  }
  std::sort(scene.links.begin(), scene.links.end());
  for (const auto& [a, b] : scene.links) {
    const Element &p = scene.elements[a], &q = scene.elements[b];
    const double gap = std::hypot(p.x - q.x, p.y - q.y, p.z - q.z) - p.radius - q.radius;
    scene.rest.push_back(static_cast<float>(-gap));
    double& longest = p.group == "steel" || q.group == "steel" ? scene.steel_gap : scene.gap;
    longest = std::max(longest, gap);
  }
  std::ifstream(folder + "/dt.txt") >> scene.dt;
  return scene;
}

struct Options {
  std::string folder;
  int steps = 2000, windows = 5, copies = 1;
  bool still = false, whole = false, contacts = false;
};

Options read_options(int count, char** words) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    const auto number = [&] { return std::atoi(words[++i]); };
    if (word == "--steps")
      options.steps = number();
    else if (word == "--windows")
      options.windows = number();
    else if (word == "--copies")
      options.copies = number();
    else if (word == "--still")
      options.still = true;
    else if (word == "--whole")
      options.whole = true;
    else if (word == "--contacts")
      options.contacts = true;
    else
      options.folder = word;
  }
  return options;
}

void add_spheres(deme::DEMSolver& solver, const Scene& scene, const Options& options,
                 const std::shared_ptr<deme::DEMMaterial>& material) {
  std::vector<std::shared_ptr<deme::DEMClumpTemplate>> kinds, types;
  for (const Element& e : scene.elements)
    kinds.push_back(
        solver.LoadSphereType(static_cast<float>(e.mass), static_cast<float>(e.radius), material));
  std::vector<float3> places, speeds;
  std::vector<unsigned> families;
  std::vector<std::pair<deme::bodyID_t, deme::bodyID_t>> pairs;
  std::vector<float> rest;
  const int row = static_cast<int>(std::lround(std::sqrt(options.copies)));
  for (int copy = 0; copy < options.copies; ++copy) {
    const auto first = static_cast<unsigned>(places.size());
    for (std::size_t i = 0; i < scene.elements.size(); ++i) {
      const Element& e = scene.elements[i];
      types.push_back(kinds[i]);
      places.push_back(make_float3(e.x + pitch * (copy % row), e.y + pitch * (copy / row), e.z));
      speeds.push_back(make_float3(0, 0, e.group == "impactor" && !options.still ? -speed : 0.0f));
      families.push_back(e.group == "steel" ? (e.held ? held_steel : steel)
                                            : (e.held ? held_concrete : concrete));
    }
    for (const auto& [a, b] : scene.links) pairs.emplace_back(a + first, b + first);
    rest.insert(rest.end(), scene.rest.begin(), scene.rest.end());
  }
  const auto batch = solver.AddClumps(types, places);
  batch->SetVel(speeds);
  batch->SetFamilies(families);
  if (options.contacts) return;
  const std::vector<float> none(pairs.size(), 0.0f);
  batch->SetExistingContacts(pairs);
  batch->SetExistingContactWildcards({{"bond", std::vector<float>(pairs.size(), 1.0f)},
                                      {"rest", rest},
                                      {"slip_x", none},
                                      {"slip_y", none},
                                      {"slip_z", none}});
}

std::size_t bonds(deme::DEMSolver& solver) {
  const auto info = solver.GetContactDetailedInfo();
  const std::vector<float>& bond = info->Get<float>("bond");
  return static_cast<std::size_t>(
      std::count_if(bond.begin(), bond.end(), [](float b) { return b > 0.5f; }));
}

double kinetic(deme::DEMSolver& solver, const Scene& scene, std::size_t count) {
  const std::vector<float3> v = solver.GetOwnerVelocity(0, static_cast<deme::bodyID_t>(count));
  double sum = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Element& e = scene.elements[i % scene.elements.size()];
    sum += 0.5 * e.mass *
           (double(v[i].x) * v[i].x + double(v[i].y) * v[i].y + double(v[i].z) * v[i].z);
  }
  return sum;
}

}  // namespace

int main(int count, char** words) {
  const Options options = read_options(count, words);
  const Scene scene = read(options.folder);
  const std::size_t spheres = scene.elements.size() * options.copies;

  deme::DEMSolver solver(1);
  solver.SetVerbosity("WARNING");
  solver.DisableJitifyClumpTemplates();  // every sphere has a radius of its own
  solver.DisableJitifyMassProperties();
  solver.SetCollectAccRightAfterForceCalc();
  solver.SetErrorOutAvgContacts(1000);
  solver.SetContactOutputContent({"OWNER", "FORCE", "CNT_WILDCARD"});
  const auto material = solver.LoadMaterial(
      {{"E", float(young)}, {"nu", 0.2f}, {"CoR", 0.9f}, {"mu", float(friction)}, {"Crr", 0.0f}});
  if (options.contacts) {
    solver.UseFrictionalHertzianModel();
  } else {
    const auto model = solver.DefineContactForceModel(law(options.whole));
    model->SetPerContactWildcards({"bond", "rest", "slip_x", "slip_y", "slip_z"});
    const double slack = 2e-4;  // links stretch  [m]
    for (const unsigned family : {concrete, held_concrete})
      solver.SetFamilyExtraMargin(family, float(scene.gap + slack));
    for (const unsigned family : {steel, held_steel})
      solver.SetFamilyExtraMargin(family, float(scene.steel_gap + slack));
  }
  for (const unsigned family : {held_concrete, held_steel}) solver.SetFamilyFixed(family);
  const double far = 1.5 + pitch * std::ceil(std::sqrt(options.copies) + 1);
  solver.InstructBoxDomainDimension({-1.5f, float(far)}, {-1.5f, float(far)}, {-1.5f, 1.5f});
  solver.InstructBoxDomainBoundingBC("none", material);
  solver.SetInitTimeStep(scene.dt);
  solver.SetGravitationalAcceleration(make_float3(0, 0, 0));
  add_spheres(solver, scene, options, material);
  solver.Initialize(true);

  const std::size_t linked = options.contacts ? 0 : bonds(solver), near = solver.GetNumContacts();
  const double energy = kinetic(solver, scene, spheres);
  std::string microseconds;
  for (int window = 0; window <= options.windows; ++window) {
    const auto start = std::chrono::steady_clock::now();
    solver.DoDynamicsThenSync((options.steps - 0.5) * scene.dt);
    const std::chrono::duration<double, std::micro> spent =
        std::chrono::steady_clock::now() - start;
    if (window == 0) continue;  // it compiles and takes memory
    char text[32];
    std::snprintf(text, sizeof text, "%s%.6g", microseconds.empty() ? "" : ", ",
                  spent.count() / options.steps);
    microseconds += text;
  }
  const std::size_t left = options.contacts ? 0 : bonds(solver);
  std::printf(
      "\n{\"program\": \"DEM-Engine%s\", \"elements\": %zu, \"links\": %zu, \"links_at_end\": %zu, "
      "\"pairs\": %zu, \"steps\": %d, "
      "\"us_a_step\": [%s], \"kinetic\": [%.9g, %.9g]}\n",
      options.contacts ? ", contacts alone" : "", spheres, linked, left, near,
      options.steps * options.windows, microseconds.c_str(), energy,
      kinetic(solver, scene, spheres));
}
