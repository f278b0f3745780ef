#include "io/case/material_library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string_view>

#include "exec/error.hpp"
#include "io/case/case_file.hpp"
#include "io/case/materials_text.hpp"
#include "io/case/suggestion.hpp"
#include "io/case/units.hpp"
#include "io/case/use_materials.hpp"

namespace breccia {
namespace {

constexpr std::array methods{"dem3d", "fdem2d"};

const toml::table& library() {
  static const toml::table tables = toml::parse(materials_text());
  return tables;
}

std::string text_of(const toml::table& table, const char* key) {
  return table[key].value_or(std::string());
}

MaterialTarget target_of(const std::string& name, const toml::node& node) {
  MaterialTarget target{name, 0.0, target_unit(name)};
  if (const auto text = node.value_exact<std::string>()) {
    std::string problem;
    target.value = parse_quantity(*text, target.unit, problem);
    if (!problem.empty()) throw InputError("materials.toml: " + name + ": " + problem);
  } else {
    target.value = node.value_or(0.0);
  }
  return target;
}

/// In the order of the file.
template <class Visit>
void each_in_order(const toml::table& table, Visit&& visit) {
  std::vector<std::pair<toml::source_position, std::string>> order;
  for (const auto& [key, node] : table)
    order.emplace_back(node.source().begin, std::string(key.str()));
  std::sort(order.begin(), order.end());
  for (const auto& [at, key] : order) visit(key, *table.get(key));
}

/// A value as people write it in a case.
std::string toml_text(const toml::node& node) {
  if (const toml::table* table = node.as_table()) {
    std::string text;
    each_in_order(*table, [&](const std::string& key, const toml::node& value) {
      text += (text.empty() ? "{ " : ", ") + key + " = " + toml_text(value);
    });
    return text + " }";
  }
  if (const auto number = node.value_exact<double>()) return value_text(*number);
  if (const auto integer = node.value_exact<std::int64_t>()) return value_text(*integer);
  return value_text(node.value_or(std::string()));
}

MaterialBlock block_of(const char* method, const toml::table& table) {
  MaterialBlock block{method, text_of(table, "record"), ""};
  each_in_order(table, [&](const std::string& key, const toml::node& node) {
    if (key != "record") block.keys += key + " = " + toml_text(node) + "\n";
  });
  return block;
}

/// Adds to `own` what `given` has beyond it.
void complete(toml::table& own, const toml::table& given) {
  for (const auto& [name, node] : given) {
    const std::string_view key = name.str();  // clang 14 captures no structured binding
    if (key == "record") continue;
    toml::node* const there = own.get(key);
    if (there == nullptr)
      node.visit([&](const auto& value) { own.insert(key, value); });
    else if (there->is_table() && node.is_table())
      complete(*there->as_table(), *node.as_table());
  }
}

}  // namespace

std::string target_unit(const std::string& target) {
  if (target == "poisson") return "-";
  if (target == "fracture_energy" || target == "slide_energy") return "J/m2";
  if (target == "friction_angle") return "rad";
  for (const char* stress :
       {"young", "compression", "tension", "brazilian", "confinement", "yield"})
    if (target == stress) return "Pa";
  return "";
}

const std::vector<NamedMaterial>& named_materials() {
  static const std::vector<NamedMaterial> materials = [] {
    std::vector<NamedMaterial> list;
    each_in_order(library(), [&](const std::string& name, const toml::node& node) {
      const toml::table& table = *node.as_table();
      NamedMaterial material{name, text_of(table, "title"), text_of(table, "source"), {}, {}};
      if (const toml::table* targets = table["target"].as_table())
        each_in_order(*targets, [&](const std::string& target, const toml::node& value) {
          material.targets.push_back(target_of(target, value));
        });
      for (const char* method : methods)
        if (const toml::table* block = table[method].as_table())
          material.blocks.push_back(block_of(method, *block));
      list.push_back(std::move(material));
    });
    return list;
  }();
  return materials;
}

const NamedMaterial* named_material(const std::string& name) {
  for (const NamedMaterial& material : named_materials())
    if (material.name == name) return &material;
  return nullptr;
}

namespace {

bool of_file(const toml::node& node) {
  return node.source().path != nullptr;
}

/// Takes out of a table what stands in the file, and adds the names of that and their lines.
void drop_what_the_file_says(toml::table& table, const std::string& before,
                             std::vector<std::string>& names, std::set<std::uint32_t>& lines) {
  std::vector<std::string> dropped;
  for (auto&& [name, node] : table) {
    const std::string key(name.str());
    if (key == "use") continue;
    if (toml::table* const below = node.as_table()) {
      drop_what_the_file_says(*below, before + key + ".", names, lines);
      if (below->empty()) dropped.push_back(key);
    } else if (of_file(node)) {
      names.push_back(before + key);
      lines.insert(node.source().begin.line);
      dropped.push_back(key);
    }
  }
  for (const std::string& key : dropped) table.erase(key);
}

/// A quantity in SI, whatever its unit; a number as it is.
std::optional<double> si_value(const toml::node& node) {
  if (const auto number = node.value<double>()) return number;
  const auto text = node.value_exact<std::string>();
  for (const char* unit : {"Pa", "rad", "m", "J/m2", "kg/m3", "-"}) {
    std::string problem;
    if (!text) break;
    const double value = parse_quantity(*text, unit, problem);
    if (problem.empty()) return value;
  }
  return {};
}

/// The keys of `own` that say something else than `given`, with their places.
void list_other_values(const toml::table& own, const toml::table& given, const std::string& before,
                       const std::string& material, std::vector<std::string>& list) {
  each_in_order(own, [&](const std::string& key, const toml::node& node) {
    const toml::node* const there = given.get(key);
    if (there == nullptr || key == "use") return;
    if (node.is_table() && there->is_table())
      return list_other_values(*node.as_table(), *there->as_table(), before + key + ".", material,
                               list);
    const auto value = si_value(node), usual = si_value(*there);
    const std::string here = toml_text(node), of_material = toml_text(*there);
    if (value && usual ? *value == *usual : here == of_material) return;
    const std::string place =
        of_file(node) ? fmt::format("line {}", node.source().begin.line) : "--set";
    list.push_back(
        fmt::format("{}{} = {} ({}; {}: {})", before, key, here, place, material, of_material));
  });
}

/// @param where  before the key in messages
void use_in(toml::table& root, const std::string& of_case, const std::string& where,
            std::vector<Problem>& problems, std::vector<std::string>& notes) {
  toml::table* const materials = root["material"].as_table();
  if (materials == nullptr) return;
  // Rock has the same numbers for triangles and for tetrahedra.
  const std::string method = of_case == "fdem3d" ? "fdem2d" : of_case;
  for (auto&& [key, node] : *materials) {
    toml::table* const own = node.as_table();
    if (own == nullptr) continue;
    const auto use = own->find("use");
    const auto name =
        use != own->end() ? use->second.value_exact<std::string>() : std::optional<std::string>();
    if (!name || name->empty()) continue;
    const std::string path = fmt::format("{}material.{}", where, std::string(key.str()));
    const toml::table* const given = library()[*name].as_table();
    if (given != nullptr && (*given)[method].is_table()) {
      const toml::table& numbers = *(*given)[method].as_table();
      if (use->first.source().path ==
          nullptr) {  // the file's numbers are those of another material
        std::vector<std::string> names;
        std::set<std::uint32_t> lines;
        drop_what_the_file_says(*own, "", names, lines);
        if (!names.empty())
          notes.push_back(fmt::format(
              "{}.use = \"{}\" by --set takes the place of what the file says of this material, "
              "lines {} to {}: {}",
              path, *name, *lines.begin(), *lines.rbegin(), fmt::join(names, ", ")));
      }
      std::vector<std::string> others;
      list_other_values(*own, numbers, "", *name, others);
      if (!others.empty())
        notes.push_back(fmt::format("{} uses {} but for its own keys: {}", path, *name,
                                    fmt::join(others, ", ")));
      if (of_case != method)
        notes.push_back(
            fmt::format("{}.use = \"{}\": its numbers were found with triangles in plane stress; "
                        "tetrahedra show others, moduli by a few percent, strengths by more",
                        path, *name));
      complete(*own, numbers);
      continue;
    }
    std::string text = fmt::format("{}.use = \"{}\"", path, *name);
    if (given == nullptr) {
      std::set<std::string> names;
      for (const NamedMaterial& material : named_materials()) names.insert(material.name);
      text += " is no material of the program" + suggestion(*name, names) +
              "\n    'breccia materials' lists them";
    } else {
      text += " has no numbers for method " + of_case;
    }
    const bool from_file = of_file(use->second);
    problems.push_back(
        {from_file ? use->second.source().begin.line : 0, (from_file ? "" : "--set ") + text});
  }
}

}  // namespace

void use_named_materials(toml::table& root, std::vector<Problem>& problems,
                         std::vector<std::string>& notes) {
  if (!root["method"].is_array())
    return use_in(root, root["method"].value_or(std::string("dem3d")), "", problems, notes);
  if (toml::table* const part = root["spheres"].as_table())
    use_in(*part, "dem3d", "spheres.", problems, notes);
  if (toml::table* const part = root["tetrahedra"].as_table())
    use_in(*part, "fdem3d", "tetrahedra.", problems, notes);
}

}  // namespace breccia
