#include "prepare/packing/spheres_file.hpp"

#include <fmt/format.h>

#include "exec/error.hpp"
#include "prepare/csv_numbers.hpp"

namespace breccia::prepare {

Spheres read_spheres(const std::string& path) {
  Spheres spheres;
  read_csv(path, 4, "x,y,z,radius in metres with a positive radius",
           [&](const std::vector<double>& v) {
             if (!(v[3] > 0.0)) return false;
             spheres.position.push_back({v[0], v[1], v[2]});
             spheres.radius.push_back(v[3]);
             return true;
           });
  if (spheres.radius.empty()) throw InputError(fmt::format("{} holds no spheres", path));
  return spheres;
}

}  // namespace breccia::prepare
