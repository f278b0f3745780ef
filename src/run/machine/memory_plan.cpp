#include "run/machine/memory_plan.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>

#include "exec/error.hpp"
#include "io/round_numbers.hpp"
#include "math/constants.hpp"
#include "prepare/meshing/body_mesh.hpp"
#include "prepare/packing/body_packing.hpp"

namespace breccia {
namespace {

constexpr double no_bound = std::numeric_limits<double>::infinity();

/// The number that a file holds, or that follows a word in it.
std::optional<double> number_in(const std::string& path, const std::string& word = "") {
  std::ifstream file(path);
  std::string text;
  while (!word.empty() && file >> text && text != word) {
  }
  double number = 0.0;
  if (file >> number) return number;
  return std::nullopt;
}

/// Memory that a control group and those above it leave.  [bytes]
/// @param limit, usage  names of the files of one version of control groups
double left_in_groups(const std::string& folder, std::string group, const char* limit,
                      const char* usage) {
  double least = no_bound;
  while (true) {
    const std::string start = folder + group + "/";
    const auto most = number_in(start + limit), used = number_in(start + usage);
    // Pages of files that are not in use are given back when memory is asked for.
    const double cached = number_in(start + "memory.stat", "inactive_file").value_or(0.0);
    if (most && used) least = std::min(least, *most - (*used - cached));
    if (group.empty()) return least;
    group.erase(group.rfind('/'));
  }
}

double left_in_control_groups(const std::string& root) {
  std::ifstream file(root + "/proc/self/cgroup");
  double least = no_bound;
  for (std::string line; std::getline(file, line);) {
    const std::size_t path = line.find(":/");
    if (path == std::string::npos) continue;
    std::string group = line.substr(path + 1);
    if (group == "/") group.clear();
    const std::string base = root + "/sys/fs/cgroup";
    if (line.starts_with("0::"))
      least = std::min(least, left_in_groups(base, group, "memory.max", "memory.current"));
    else if (line.find(":memory:") != std::string::npos)
      least = std::min(least, left_in_groups(base + "/memory", group, "memory.limit_in_bytes",
                                             "memory.usage_in_bytes"));
  }
  return least;
}

double left_of_limit(const std::string& root) {
  struct rlimit limit {};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return no_bound;
  const double pages = number_in(root + "/proc/self/statm").value_or(0.0);
  return static_cast<double>(limit.rlim_cur) - pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

constexpr double equilateral = 0.433;  ///< area of a triangle over the square of its edge  [-]

/// Of one body of triangles; 0 where its mesh alone tells.
double triangles_of(const fdem::BodyConfig& body) {
  if (body.shape == "hexagons") return 6.0 * body.hexagons.count;
  const bool rectangle = body.shape == "plate" || body.shape == "beam";
  const double area =
      rectangle ? body.size.x * body.size.y
                : pi * (body.radius * body.radius - body.inner_radius * body.inner_radius);
  const double each = equilateral * body.mesh_size * body.mesh_size;
  const bool known = rectangle || body.shape == "disc" || body.shape == "ring";
  return known && area > 0.0 && each > 0.0 ? area / each : 0.0;
}

/// Of a body whose file is its outline; 0 of others, and where the file cannot be read.
double triangles_in_outline(const fdem::BodyConfig& body, const std::string& folder) {
  if (body.shape != "outline" || folder.empty() || !(body.mesh_size > 0.0)) return 0.0;
  try {
    const std::vector<Vec2> corners = prepare::read_outline(folder + "/" + body.file);
    double twice = 0.0;
    for (std::size_t k = 0; k < corners.size(); ++k)
      twice += cross(corners[k], corners[(k + 1) % corners.size()]);
    double area = 0.5 * std::abs(twice);
    for (const fdem::HoleConfig& hole : body.holes) area -= pi * hole.radius * hole.radius;
    return std::max(0.0, area) / (equilateral * body.mesh_size * body.mesh_size);
  } catch (const Error&) {
    return 0.0;
  }
}

}  // namespace

double tetrahedra_of(const fdem3::BodyConfig& body) {
  double volume = 0.0;
  if (body.shape == "box") volume = body.size.x * body.size.y * body.size.z;
  if (body.shape == "cylinder") volume = pi * body.radius * body.radius * body.height;
  if (body.shape == "sphere") volume = 4.0 / 3.0 * pi * body.radius * body.radius * body.radius;
  const double h = body.mesh_size;
  if (!(volume > 0.0) || !(h > 0.0)) return 0.0;
  // Six to a cube; of free meshes by gmsh one to 0.094 cubes of the mean edge (measured).
  return volume / (h * h * h) * (body.structured ? 6.0 : 1.0 / 0.094);
}

// Measured peaks: 50,000 and 200,000 packed elements with 6 links each, 64,000 and 257,000
// triangles with 1.5 joints each, per item the same for both sizes to 3 %; 511,104 tetrahedra
// with 2, and 100 million on an H200.
MemoryPlan memory_plan(const dem::Config& config, const std::string&) {
  constexpr double build = 640.0, linked = 2400.0, loose = 1000.0;  // bytes of an element
  MemoryPlan plan{.items = 0.0, .kind = "elements"};
  for (const dem::BodyConfig& body : config.bodies) {
    const bool packed = body.shape == "box" || body.shape == "sphere" || body.shape == "cylinder" ||
                        body.shape == "stl";
    const bool grains = std::any_of(
        config.materials.begin(), config.materials.end(),
        [&](const dem::MaterialConfig& m) { return m.name == body.material && m.law == "grain"; });
    const double count =
        packed ? prepare::elements_in(body.pack, prepare::container_of(body).volume()) : 0.0;
    plan.items += count;
    plan.build_bytes += build * count;
    plan.run_bytes += (grains ? loose : linked) * count;
  }
  plan.host_bytes = plan.run_bytes;
  return plan;
}

MemoryPlan memory_plan(const fdem::Config& config, const std::string& folder) {
  constexpr double build = 270.0, run = 1700.0;  // bytes of a triangle
  constexpr double most = 2e8;  // more are refused with the body's name, whatever the memory
  MemoryPlan plan{.items = 0.0, .kind = "triangles"};
  for (const fdem::BodyConfig& body : config.bodies)
    if (const double count = triangles_of(body); count < most)
      plan.items += count + triangles_in_outline(body, folder);
  plan.build_bytes = build * plan.items;
  plan.run_bytes = plan.host_bytes = run * plan.items;
  return plan;
}

MemoryPlan memory_plan(const fdem3::Config& config, const std::string&) {
  // Bytes of a tetrahedron with two joints: of a mesh of cubes, of one by gmsh with that program
  // beside it, of a run, and of one that writes frames; likewise on the host of a GPU, and of one
  // that writes checkpoints there.
  constexpr double cubes = 350.0, free = 900.0, whole = 1100.0, framed = 1600.0;
  constexpr double host = 400.0, host_saved = 850.0, host_framed = 1250.0;
  MemoryPlan plan{.items = 0.0, .kind = "tetrahedra"};
  for (const fdem3::BodyConfig& body : config.bodies) {
    const double count = tetrahedra_of(body);
    plan.items += count;
    plan.build_bytes += (body.structured ? cubes : free) * count;
  }
  const bool frames = config.output.fields || (config.output.frames > 0 && config.output.pictures);
  plan.run_bytes = (frames ? framed : whole) * plan.items;
  plan.host_bytes = (frames                       ? host_framed
                     : config.checkpoint.keep > 0 ? host_saved
                                                  : host) *
                    plan.items;
  return plan;
}

MemoryPlan memory_plan(const coupled::Config& config, const std::string&) {
  const MemoryPlan a = memory_plan(static_cast<const dem::Config&>(config.spheres)),
                   b = memory_plan(static_cast<const fdem3::Config&>(config.tetrahedra));
  return {a.items + b.items, "spheres and tetrahedra", a.build_bytes + b.build_bytes,
          a.run_bytes + b.run_bytes, a.host_bytes + b.host_bytes};
}

double available_memory(const std::string& root) {
  constexpr double kibibyte = 1024.0;
  const auto machine = number_in(root + "/proc/meminfo", "MemAvailable:");
  return std::min({machine ? *machine * kibibyte : no_bound, left_of_limit(root),
                   left_in_control_groups(root)});
}

std::string memory_text(double bytes) {
  constexpr std::array units{"B", "kB", "MB", "GB", "TB", "PB"};
  std::size_t unit = 0;
  for (; bytes >= 1000.0 && unit + 1 < units.size(); ++unit) bytes /= 1000.0;
  return fmt::format("{:.3g} {}", bytes, units[unit]);
}

void refuse_without_memory(const MemoryPlan& plan, double bytes, int sharers,
                           const std::string& what) {
  const double available = available_memory();
  if (!(bytes * sharers > available)) return;
  throw DeviceError(
      fmt::format("{} needs about {} of memory ({} {}{}), and {} are available; nothing was run\n"
                  "  use fewer {}, or a machine with more memory",
                  what, memory_text(bytes * sharers), count_text(plan.items), plan.kind,
                  sharers > 1 ? fmt::format(", built by each of {} ranks", sharers) : "",
                  memory_text(std::max(available, 0.0)), plan.kind));
}

}  // namespace breccia
