#include "report/scene.hpp"

#include <algorithm>
#include <limits>

#include "exec/error.hpp"
#include "io/case/case_source.hpp"
#include "io/case/toml.hpp"

namespace breccia::report {
namespace {

double number(const toml::table& table, const char* key, double otherwise) {
  return table[key].value<double>().value_or(otherwise);
}

std::string text(const toml::table& table, const char* key) {
  return table[key].value<std::string>().value_or("");
}

/// A vector of two or three numbers.
Vec3 vector(const toml::table& table, const char* key, const Vec3& otherwise) {
  const toml::array* const list = table[key].as_array();
  if (list == nullptr || list->size() < 2) return otherwise;
  Vec3 v = otherwise;
  v.x = (*list)[0].value<double>().value_or(v.x);
  v.y = (*list)[1].value<double>().value_or(v.y);
  if (list->size() > 2) v.z = (*list)[2].value<double>().value_or(v.z);
  return v;
}

template <class Take>
void each_of(const toml::table& table, const char* key, const Take& take) {
  const toml::array* const list = table[key].as_array();
  if (list == nullptr) return;
  for (const toml::node& node : *list)
    if (const toml::table* const item = node.as_table()) take(*item);
}

Strength strength_of(std::string name, const toml::table& material) {
  Strength strength{std::move(name), true, 0.0};
  if (const toml::table* const joint = material["joint"].as_table()) {
    strength.tension = number(*joint, "tension", 0.0);
    strength.breaks = text(material, "joints") != "none";
  } else {
    strength.tension = number(material, "tensile_strength", 0.0);
    strength.breaks = text(material, "law") == "concrete";
  }
  return strength;
}

void add_materials(const toml::table& all, Scene& scene) {
  const toml::table* const materials = all["material"].as_table();
  if (materials == nullptr) return;
  std::vector<std::pair<toml::source_index, Strength>> found;
  for (const auto& [name, node] : *materials)
    if (const toml::table* const material = node.as_table())
      found.emplace_back(name.source().begin.line, strength_of(std::string(name.str()), *material));
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (auto& [line, strength] : found) scene.strengths.push_back(std::move(strength));
}

void add_region(const toml::table& item, bool load, Scene& scene) {
  constexpr double far = std::numeric_limits<double>::infinity();
  scene.regions.push_back({text(item, "name"), vector(item, "min", {-far, -far, -far}),
                           vector(item, "max", {far, far, far}), load});
}

}  // namespace

Scene scene_of(const std::string& case_text) {
  Scene scene;
  toml::table all;
  try {
    check_case_source(case_text, "case.toml");
    all = toml::parse(case_text);
  } catch (const InputError&) {
    return scene;
  } catch (const toml::parse_error&) {
    return scene;
  }
  scene.title = text(all, "title");
  if (const toml::table* const output = all["output"].as_table()) {
    scene.color = text(*output, "color");
    scene.view = text(*output, "view");
    if (const toml::array* const curves = (*output)["curves"].as_array())
      for (const toml::node& curve : *curves) scene.curves.push_back(curve.value_or(std::string()));
  }
  add_materials(all, scene);
  each_of(all, "body", [&](const toml::table& body) {
    scene.materials[text(body, "name")] = text(body, "material");
    if (const toml::table* const bars = body["rebar"].as_table();
        bars != nullptr && text(body, "shape") == "rebar")
      scene.bar_radius = 0.5 * number(*bars, "diameter", 0.0);
  });
  each_of(all, "wall", [&](const toml::table& wall) {
    scene.walls.push_back({text(wall, "name"), vector(wall, "point", {}),
                           vector(wall, "normal", {0.0, 0.0, 1.0}), vector(wall, "velocity", {})});
  });
  each_of(all, "support", [&](const toml::table& item) { add_region(item, false, scene); });
  each_of(all, "load", [&](const toml::table& item) { add_region(item, true, scene); });
  return scene;
}

}  // namespace breccia::report
