#pragma once
// Bodies of triangles for tests, and what is measured on a model.

#include <algorithm>
#include <cmath>
#include <string>

#include "exec/error.hpp"
#include "prepare/build_fdem.hpp"
#include "prepare/meshing/mesh.hpp"
#include "prepare/meshing/mesh_check.hpp"

namespace breccia::fdem {

inline const FdemNames usual_names{{"rock", "steel", "quartz", "feldspar", "biotite"},
                                   {"rock_joint", "vein"}};

inline BodyConfig regular_plate(const Vec2& size, double edge) {
  BodyConfig body;
  body.name = "plate";
  body.material = "rock";
  body.size = size;
  body.mesh_size = edge;
  body.structured = true;
  return body;
}

inline BodyConfig disc_of(double radius, double edge) {
  BodyConfig body;
  body.name = "disc";
  body.shape = "disc";
  body.material = "rock";
  body.radius = radius;
  body.mesh_size = edge;
  return body;
}

inline Model built(const std::vector<BodyConfig>& bodies,
                   const std::vector<DiscontinuityConfig>& discontinuities = {},
                   std::int64_t seed = 1, const std::string& folder = ".") {
  return build_fdem_model(bodies, discontinuities, usual_names, seed, folder);
}

/// The message of the InputError that building throws; empty if none.
inline std::string refusal(const std::vector<BodyConfig>& bodies,
                           const std::vector<DiscontinuityConfig>& discontinuities = {},
                           const std::string& folder = ".") {
  try {
    built(bodies, discontinuities, 1, folder);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline double area_of(const Model& m, int group) {
  double sum = 0.0;
  for (std::size_t t = 0; t < m.triangle.size(); ++t)
    if (m.group[t] == group) sum += prepare::signed_area(m.point, m.triangle[t]);
  return sum;
}

inline int count_of(const Model& m, int group) {
  return static_cast<int>(std::count(m.group.begin(), m.group.end(), group));
}

/// Edges with a triangle on both sides.
inline int interior_edges(const Model& m) {
  const auto edges = prepare::edges_of(m.triangle);
  return static_cast<int>(std::count_if(edges.begin(), edges.end(),
                                        [](const auto& edge) { return edge.triangles[1] >= 0; }));
}

/// The smallest angle of all triangles.  [degrees]
inline double smallest_angle(const Model& m) {
  double least = 180.0;
  for (const auto& t : m.triangle)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 a = prepare::at(m.point, t[k]);
      const Vec2 u = prepare::at(m.point, t[(k + 1) % 3]) - a,
                 v = prepare::at(m.point, t[(k + 2) % 3]) - a;
      least = std::min(least, std::atan2(cross(u, v), dot(u, v)) * 57.29577951308232);
    }
  return least;
}

inline bool is_sound(const Model& m) {
  return prepare::mesh_problems(
             {.point = m.point, .triangle = m.triangle, .parts = {}, .edge_sets = {}},
             prepare::plain_names())
      .empty();
}

inline bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace breccia::fdem
