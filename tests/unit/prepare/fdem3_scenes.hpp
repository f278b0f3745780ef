#pragma once
// Bodies of tetrahedra for tests, and what is measured on a model.

#include <algorithm>
#include <string>
#include <vector>

#include "exec/error.hpp"
#include "prepare/build_fdem3.hpp"
#include "prepare/tetrahedra/tet_check.hpp"

namespace breccia::fdem3 {

inline BodyConfig regular_box(const Vec3& size, double edge) {
  BodyConfig body;
  body.name = "block";
  body.material = "rock";
  body.size = size;
  body.mesh_size = edge;
  body.structured = true;
  return body;
}

inline Config case_of(const std::vector<BodyConfig>& bodies, std::int64_t seed = 1) {
  Config config;
  config.seed = seed;
  for (const char* name : {"rock", "steel", "quartz", "feldspar", "biotite"}) {
    config.materials.emplace_back();
    config.materials.back().name = name;
  }
  config.joint_laws.emplace_back();
  config.joint_laws.back().name = "vein";
  config.bodies = bodies;
  return config;
}

inline Model built(const std::vector<BodyConfig>& bodies, std::int64_t seed = 1,
                   const std::string& folder = ".") {
  return build_model(case_of(bodies, seed), folder);
}

/// The message of the InputError that `work` throws; empty if none.
template <class Work>
std::string refusal_of(const Work& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}
inline std::string refusal(const Config& config, const std::string& folder = ".") {
  return refusal_of([&] { build_model(config, folder); });
}

inline double volume_of(const Model& m, int group = 0) {
  double sum = 0.0;
  for (std::size_t t = 0; t < m.tetrahedron.size(); ++t)
    if (m.group[t] == group) sum += prepare::signed_volume(m.point, m.tetrahedron[t]);
  return sum;
}

inline double least_volume(const Model& m) {
  double least = 1e300;
  for (const auto& t : m.tetrahedron) least = std::min(least, prepare::signed_volume(m.point, t));
  return least;
}

inline bool is_sound(const Model& m) {
  return prepare::mesh_problems(
             {.point = m.point, .tetrahedron = m.tetrahedron, .volumes = {}, .face_sets = {}},
             prepare::plain_tet_names())
      .empty();
}

inline bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace breccia::fdem3
