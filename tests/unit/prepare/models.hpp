#pragma once
// Cases that several tests of prepare build models from.

#include <string>
#include <vector>

#include "dem/setup/config.hpp"
#include "exec/error.hpp"
#include "prepare/checks/check_case.hpp"
#include "prepare/shapes/surface.hpp"

namespace breccia::dem {

/// An STL file of lengths in millimetres.
inline std::string stl_text(const std::vector<prepare::Surface::Triangle>& triangles) {
  std::string text = "solid one\n";
  for (const prepare::Surface::Triangle& t : triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const Vec3& v : t)
      text += "vertex " + std::to_string(1000.0 * v.x) + " " + std::to_string(1000.0 * v.y) + " " +
              std::to_string(1000.0 * v.z) + "\n";
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid one\n";
}
/// The words of check_case() about a case; empty: it is good.
inline std::string problem_of(const Config& config) {
  try {
    check_case(config);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline Config case_with_materials() {
  Config config;
  MaterialConfig material;
  material.name = "c30";
  config.materials.push_back(material);
  material.name = "b500";
  material.law = "steel";
  material.density = 7850.0;
  config.materials.push_back(material);
  material.name = "bond";
  material.law = "interface";
  config.materials.push_back(material);
  material.name = "gravel";
  material.law = "grain";
  material.density = 2600.0;
  config.materials.push_back(material);
  return config;
}

inline BodyConfig box_body(const std::string& name, const Vec3& size, int count,
                           double compactness) {
  BodyConfig body;
  body.name = name;
  body.material = "c30";
  body.size = size;
  body.pack = {.count = count, .size_ratio = 2.0, .compactness = compactness};
  return body;
}

inline BodyConfig sphere_body(const std::string& name, const Vec3& center, double radius, int count,
                              double compactness) {
  BodyConfig body = box_body(name, {}, count, compactness);
  body.shape = "sphere";
  body.center = center;
  body.radius = radius;
  return body;
}

inline BodyConfig rebar_body(const std::string& name, const std::string& host, int bars,
                             int elements) {
  BodyConfig body;
  body.name = name;
  body.shape = "rebar";
  body.material = "b500";
  body.rebar.in = host;
  body.rebar.interface_law = "bond";
  body.rebar.bars = bars;
  body.rebar.elements = elements;
  return body;
}

/// The scene of Durand et al. 2012, section 5, as cases/rc_slab/case.toml states it.
inline Config slab_of_the_paper() {
  Config config = case_with_materials();
  config.bodies = {box_body("slab", {1.0, 1.0, 0.1}, 12718, 0.56),
                   rebar_body("steel", "slab", 7, 28),
                   sphere_body("impactor", {0.0, 0.0, 0.164}, 0.113, 772, 0.56)};
  config.bodies[2].velocity = {0.0, 0.0, -30.0};
  config.links.count = 79211;
  return config;
}

/// A small cube of particles around coarse grains.
inline Config ldpm_cube() {
  Config config = case_with_materials();
  config.materials[0].law = "ldpm";
  config.bodies = {box_body("cube", {0.04, 0.04, 0.04}, 0, 0.6)};
  return config;
}

/// A small reinforced slab.
inline Config small_slab() {
  Config config = case_with_materials();
  config.bodies = {box_body("slab", {0.3, 0.2, 0.1}, 900, 0.5), rebar_body("steel", "slab", 2, 8)};
  config.links.range = 1.4;
  return config;
}

}  // namespace breccia::dem
