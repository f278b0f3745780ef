#include "prepare/ldpm/mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>
#include <string_view>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "prepare/ldpm/facet_file.hpp"
#include "prepare/ldpm/rows.hpp"

namespace breccia::prepare {
namespace {

bool is_flat(const std::vector<Vec3>& x, const Tetrahedron& t) {
  const Vec3 &a = x[at(t[0])], &b = x[at(t[1])], &c = x[at(t[2])], &d = x[at(t[3])];
  const double longest = std::max({norm(b - a), norm(c - a), norm(d - a)});
  return std::abs(six_volumes(a, b, c, d)) <= 6e-9 * longest * longest * longest;
}

/// Particles, and tetrahedra in the order of their file.
struct Parts {
  std::vector<Vec3> position;
  std::vector<double> diameter;
  std::vector<Tetrahedron> tetrahedra;
};

void read_particles(const std::string& path, Parts& parts) {
  read_rows(path, "n x y z d, particles in their order, in mm",
            [&](const std::vector<double>& v, std::size_t) {
              if (v.size() != 5 || v[0] != static_cast<double>(parts.position.size()) || v[4] < 0.0)
                return false;
              parts.position.push_back(millimetre * Vec3{v[1], v[2], v[3]});
              parts.diameter.push_back(millimetre * v[4]);
              return true;
            });
}
void read_nodes(const std::string& path, Parts& parts) {
  read_rows(path, "x y z, a particle, in mm", [&](const std::vector<double>& v, std::size_t) {
    if (v.size() != 3) return false;
    parts.position.push_back(millimetre * Vec3{v[0], v[1], v[2]});
    return true;
  });
}

/// Adds a tetrahedron of four numbers, unless they are not four different particles.
bool add_tetrahedron(const double* corner, Parts& parts) {
  Tetrahedron t{};
  for (std::size_t k = 0; k < 4; ++k) {
    const double c = corner[k];
    if (!(c >= 0.0 && c < static_cast<double>(parts.position.size())) || c != std::floor(c))
      return false;
    t[k] = static_cast<Index>(c);
  }
  std::sort(t.begin(), t.end());
  if (std::adjacent_find(t.begin(), t.end()) != t.end()) return false;
  parts.tetrahedra.push_back(t);
  return true;
}
std::string four_of(const Parts& parts) {
  return fmt::format("four different particles of 0 to {}",
                     static_cast<double>(parts.position.size()) - 1.0);
}
void read_tetrahedra(const std::string& path, Parts& parts) {
  read_rows(path, four_of(parts), [&](const std::vector<double>& v, std::size_t) {
    return v.size() == 4 && add_tetrahedron(v.data(), parts);
  });
}

/// A legacy VTK file in text: POINTS, then CELLS of four points each.
class VtkFile {
 public:
  explicit VtkFile(const std::string& path) : path_(path), words_(read_whole_file(path)) {}

  void read(Parts& parts) {
    const double points = section("POINTS");
    std::string type;
    words_ >> type;
    for (double k = 0; k < points; ++k) {
      Vec3 p{};
      if (!(words_ >> p.x >> p.y >> p.z)) fail(fmt::format("point {:.0f}", k));
      parts.position.push_back(millimetre * p);
    }
    const double cells = section("CELLS");
    number();
    for (double k = 0; k < cells; ++k) {
      double corner[5];
      for (double& c : corner) c = number();
      if (corner[0] != 4.0 || !add_tetrahedron(corner + 1, parts))
        fail(fmt::format("cell {:.0f} as {}", k, four_of(parts)));
    }
  }

 private:
  /// The number behind a word.
  double section(const std::string& name) {
    std::string word;
    while (word != name)
      if (!(words_ >> word)) fail(name);
    const double count = number();
    if (!(count >= 0.0)) fail("the number of " + name);
    return count;
  }
  double number() {
    double value = 0.0;
    return words_ >> value ? value : std::numeric_limits<double>::quiet_NaN();
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(
        fmt::format("{}: a mesh of tetrahedra in legacy VTK (text) has no {}, or it "
                    "cannot be read",
                    path_, what));
  }

  std::string path_;
  std::istringstream words_;
};

/// Particles and tetrahedra beside facets, from the first of their files that is there.
Parts parts_of(const std::string& name) {
  namespace fs = std::filesystem;
  const std::string tets = name + "-data-tets.dat", vtk = name + "-para-mesh.000.vtk";
  const std::string particles = name + "-data-particles.dat", nodes = name + "-data-nodes.dat";
  Parts parts;
  if (!fs::exists(tets) && fs::exists(vtk)) {
    VtkFile(vtk).read(parts);
    return parts;
  }
  if (!fs::exists(particles) && fs::exists(nodes))
    read_nodes(nodes, parts);
  else
    read_particles(particles, parts);
  read_tetrahedra(tets, parts);
  return parts;
}

}  // namespace

LdpmMesh read_ldpm_mesh(const std::string& path) {
  constexpr std::string_view ends[] = {"-data-tets.dat", "-data-facets.dat",
                                       "-data-facetsVertices.dat"};
  const auto* const end = std::find_if(std::begin(ends), std::end(ends),
                                       [&](std::string_view e) { return path.ends_with(e); });
  if (end == std::end(ends))
    throw InputError(
        fmt::format("{}: particles of law ldpm are read from <name>{} and, beside it, "
                    "<name>-data-particles.dat; with facets of a file from <name>{} or <name>{}",
                    path, ends[0], ends[1], ends[2]));
  const std::string name = path.substr(0, path.size() - end->size());
  const bool tessellated = end != ends;
  Parts parts;
  if (tessellated) {
    parts = parts_of(name);
  } else {
    read_particles(name + "-data-particles.dat", parts);
    read_tetrahedra(path, parts);
  }
  std::vector<bool> met(parts.position.size(), false), flat;
  LdpmMesh mesh;
  for (const Tetrahedron& t : parts.tetrahedra) {
    flat.push_back(is_flat(parts.position, t));
    if (flat.back()) continue;
    mesh.tetrahedra.push_back(t);
    for (const Index corner : t) met[at(corner)] = true;
  }
  const auto lost = std::find(met.begin(), met.end(), false);
  if (lost != met.end())
    throw InputError(
        fmt::format("{}: particle {} is the corner of no tetrahedron", path, lost - met.begin()));
  if (mesh.tetrahedra.empty()) throw InputError(path + " holds no tetrahedra");
  if (tessellated)
    mesh.facets = read_ldpm_facets(name, end == ends + 1, parts.position, parts.tetrahedra, flat);
  else
    mesh.diameter = std::move(parts.diameter);
  mesh.position = std::move(parts.position);
  std::sort(mesh.tetrahedra.begin(), mesh.tetrahedra.end());
  return mesh;
}

}  // namespace breccia::prepare
