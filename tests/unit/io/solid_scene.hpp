#pragma once
// Frames of tetrahedra whose surfaces, sections and silhouettes are known.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "io/frame.hpp"

namespace breccia::solid_scene {

/// A block of cells of unit edge, six tetrahedra a cell about its diagonal, each with corners of
/// its own. Faces without a neighbour are exposed.
class Block {
 public:
  /// Cells in each direction; the block begins at the origin.
  Block(int nx, int ny, int nz) {
    const auto number = [=](int x, int y, int z) { return x + (nx + 1) * (y + (ny + 1) * z); };
    for (int z = 0; z < nz; ++z)
      for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x) {
          std::array<int, 3> way{0, 1, 2};
          do {
            std::array<int, 3> at{x, y, z};
            std::array<int, 4> nodes{number(x, y, z), 0, 0, 0};
            for (std::size_t k = 0; k < 3; ++k) {
              ++at[static_cast<std::size_t>(way[k])];
              nodes[k + 1] = number(at[0], at[1], at[2]);
            }
            // An odd order of axes turns the tetrahedron inside out.
            if ((way[0] > way[1]) != ((way[1] > way[2]) != (way[0] > way[2])))
              std::swap(nodes[1], nodes[2]);
            add(nodes, nx, ny);
          } while (std::next_permutation(way.begin(), way.end()));
        }
    std::vector<std::int32_t> exposed;
    for (std::size_t t = 0; t < nodes_.size(); ++t) {
      exposed.push_back(0);
      for (int face = 0; face < 4; ++face)
        if (faces_[key(t, face)].size() == 1) exposed.back() |= 1 << face;
    }
    frame.tetrahedron_fields.push_back(whole_numbers("exposed", std::move(exposed)));
  }

  /// A field of one number a tetrahedron, by its centre.
  void add_field(const char* name, const char* unit, const std::function<double(Vec3)>& value) {
    FrameField field{name, unit, 1, {}};
    for (std::size_t t = 0; t < nodes_.size(); ++t)
      field.values.push_back(static_cast<float>(value(centre(t))));
    frame.tetrahedron_fields.push_back(std::move(field));
  }
  void add_numbers(const char* name, const std::function<int(Vec3)>& value) {
    std::vector<std::int32_t> numbers;
    for (std::size_t t = 0; t < nodes_.size(); ++t) numbers.push_back(value(centre(t)));
    frame.tetrahedron_fields.push_back(whole_numbers(name, std::move(numbers)));
  }

  /// Breaks the joints between tetrahedra on either side of the plane x, those for which a mode
  /// (0 opened ... 1 slid) is given: not for -1. The upper side moves by `opening`.
  void crack(double x, const std::function<double(Vec3)>& mode, const Vec3& opening) {
    std::vector<std::int32_t>& exposed = *frame.tetrahedron_fields[0].integers;
    FrameField modes{"mode", "-", 1, {}}, damage{"damage", "-", 1, {}}, time{"time", "s", 1, {}};
    std::vector<Vec3> middles;
    for (const auto& [nodes, sides] : faces_) {
      if (sides.size() != 2) continue;
      const bool above = centre(sides[0].first).x > x;
      if (above == (centre(sides[1].first).x > x)) continue;
      std::array<Vec3, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) corners[k] = corner(sides[0], k);
      const double of = mode((1.0 / 3.0) * (corners[0] + corners[1] + corners[2]));
      if (of < 0.0) continue;
      for (const auto& [tetrahedron, face] : sides) exposed[tetrahedron] |= 1 << face;
      for (const Vec3& p : corners) middles.push_back(p + 0.5 * opening);
      modes.values.push_back(static_cast<float>(of));
      damage.values.push_back(1.0F);
      time.values.push_back(1e-3F);
    }
    for (std::size_t t = 0; t < nodes_.size(); ++t)
      for (std::size_t k = 0; k < 4 && centre_before_[t].x > x; ++k)
        frame.position[4 * t + k] += opening;
    for (const Vec3& p : middles) {
      frame.triangles.push_back(static_cast<std::int32_t>(frame.position.size()));
      frame.position.push_back(p);
    }
    frame.triangle_fields = {modes, damage, time};
    std::vector<float>& values = frame.tetrahedron_fields[0].values;
    values.assign(exposed.begin(), exposed.end());
  }

  Frame frame;

 private:
  using Face = std::pair<std::size_t, int>;  ///< of a tetrahedron

  void add(const std::array<int, 4>& nodes, int nx, int ny) {
    const std::size_t t = nodes_.size();
    nodes_.push_back(nodes);
    for (const int node : nodes) {
      frame.tetrahedra.push_back(static_cast<std::int32_t>(frame.position.size()));
      frame.position.push_back({1.0 * (node % (nx + 1)), 1.0 * (node / (nx + 1) % (ny + 1)),
                                1.0 * (node / ((nx + 1) * (ny + 1)))});
    }
    centre_before_.push_back(centre(t));
    for (int face = 0; face < 4; ++face) faces_[key(t, face)].push_back({t, face});
  }
  std::array<int, 3> key(std::size_t t, int face) const {
    std::array<int, 3> nodes{};
    for (std::size_t k = 0; k < 3; ++k)
      nodes[k] = nodes_[t][static_cast<std::size_t>(tetrahedron_faces[face][k])];
    std::sort(nodes.begin(), nodes.end());
    return nodes;
  }
  Vec3 corner(const Face& of, std::size_t k) const {
    return frame.position[4 * of.first + static_cast<std::size_t>(tetrahedron_faces[of.second][k])];
  }
  Vec3 centre(std::size_t t) const {
    Vec3 sum{};
    for (std::size_t k = 0; k < 4; ++k) sum += 0.25 * frame.position[4 * t + k];
    return sum;
  }

  std::vector<std::array<int, 4>> nodes_;
  std::vector<Vec3> centre_before_;
  std::map<std::array<int, 3>, std::vector<Face>> faces_;
};

/// Six times the volume of a tetrahedron.
inline double six_volumes(const Frame& frame, std::size_t t) {
  const Vec3* const p = &frame.position[4 * t];
  return dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]);
}

}  // namespace breccia::solid_scene
