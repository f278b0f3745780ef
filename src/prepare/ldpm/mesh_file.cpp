#include "prepare/ldpm/mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <sstream>

#include "exec/error.hpp"
#include "io/whole_file.hpp"

namespace breccia::prepare {
namespace {

constexpr double millimetre = 1e-3;
constexpr std::string_view tets = "-data-tets.dat";

/// The finite numbers of a line, or none if it holds anything else.
std::vector<double> numbers_of(const std::string& line) {
  std::istringstream words(line);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    double value = 0.0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || rest != word.data() + word.size() || !std::isfinite(value))
      return {};
    numbers.push_back(value);
  }
  return numbers;
}

/// Hands the numbers of each line to `take`, which says whether they are what is wanted.
void read_lines(const std::string& path, const std::string& wanted,
                const std::function<bool(const std::vector<double>&)>& take) {
  std::istringstream file(read_whole_file(path));
  std::size_t number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == std::string::npos || line[begin] == '#' || line.compare(begin, 2, "//") == 0)
      continue;
    if (!take(numbers_of(line)))
      throw InputError(fmt::format("{}, line {} is not {}", path, number, wanted));
  }
}

bool is_flat(const LdpmMesh& mesh, const Tetrahedron& t) {
  const Vec3 &a = mesh.position[at(t[0])], &b = mesh.position[at(t[1])];
  const Vec3 &c = mesh.position[at(t[2])], &d = mesh.position[at(t[3])];
  const double longest = std::max({norm(b - a), norm(c - a), norm(d - a)});
  return std::abs(six_volumes(a, b, c, d)) <= 6e-9 * longest * longest * longest;
}

}  // namespace

LdpmMesh read_ldpm_mesh(const std::string& path) {
  if (!path.ends_with(tets))
    throw InputError(
        fmt::format("{}: particles of law ldpm are read from <name>{} and, beside it, "
                    "<name>-data-particles.dat",
                    path, tets));
  const std::string particles = path.substr(0, path.size() - tets.size()) + "-data-particles.dat";
  LdpmMesh mesh;
  read_lines(particles, "n x y z d, particles in their order, in mm",
             [&](const std::vector<double>& v) {
               if (v.size() != 5 || v[0] != static_cast<double>(mesh.position.size()) || v[4] < 0.0)
                 return false;
               mesh.position.push_back(millimetre * Vec3{v[1], v[2], v[3]});
               mesh.diameter.push_back(millimetre * v[4]);
               return true;
             });
  const auto count = static_cast<double>(mesh.position.size());
  std::vector<bool> met(mesh.position.size(), false);
  read_lines(path, fmt::format("four different particles of 0 to {}", count - 1.0),
             [&](const std::vector<double>& v) {
               if (v.size() != 4) return false;
               Tetrahedron t{};
               for (std::size_t k = 0; k < 4; ++k) {
                 if (!(v[k] >= 0.0 && v[k] < count) || v[k] != std::floor(v[k])) return false;
                 t[k] = static_cast<Index>(v[k]);
               }
               std::sort(t.begin(), t.end());
               if (std::adjacent_find(t.begin(), t.end()) != t.end()) return false;
               if (is_flat(mesh, t)) return true;
               mesh.tetrahedra.push_back(t);
               for (const Index corner : t) met[at(corner)] = true;
               return true;
             });
  const auto lost = std::find(met.begin(), met.end(), false);
  if (lost != met.end())
    throw InputError(
        fmt::format("{}: particle {} is the corner of no tetrahedron", path, lost - met.begin()));
  if (mesh.tetrahedra.empty()) throw InputError(path + " holds no tetrahedra");
  std::sort(mesh.tetrahedra.begin(), mesh.tetrahedra.end());
  return mesh;
}

}  // namespace breccia::prepare
