// breccia materials [NAME]: the materials that a case may use by name.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "app/commands.hpp"
#include "exec/error.hpp"
#include "io/case/material_library.hpp"
#include "io/case/suggestion.hpp"
#include "io/round_numbers.hpp"

namespace breccia::app {
namespace {

std::string value_with_unit(const MaterialTarget& target) {
  if (target.unit == "rad")
    return fmt::format("{:.4g} deg", target.value * 180.0 / std::acos(-1.0));
  const ScaledUnit scaled = scaled_unit(target.unit, std::abs(target.value));
  return fmt::format("{:.4g}{}{}", target.value * scaled.factor, scaled.unit.empty() ? "" : " ",
                     scaled.unit);
}

/// The text in lines of at most 80 columns, each behind `head`.
std::string wrapped(const std::string& text, const std::string& head) {
  constexpr std::size_t width = 80;
  std::string result, line = head;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    if (line.size() > head.size() && line.size() + 1 + end - begin > width) {
      result += line + "\n";
      line = head;
    }
    line += (line.size() > head.size() ? " " : "") + text.substr(begin, end - begin);
    begin = end + 1;
  }
  return result + line + "\n";
}

void list_all() {
  for (const NamedMaterial& material : named_materials()) {
    fmt::print("{:<22} {}\n", material.name, material.title);
    std::string numbers;
    for (const MaterialTarget& target : material.targets)
      numbers += (numbers.empty() ? "" : ", ") + target.name + " " + value_with_unit(target);
    for (const MaterialBlock& block : material.blocks) numbers += ", " + block.method;
    fmt::print("{}", wrapped(numbers, "  "));
  }
}

void describe_material(const std::string& name) {
  const NamedMaterial* const material = named_material(name);
  if (material == nullptr) {
    std::set<std::string> names;
    for (const NamedMaterial& other : named_materials()) names.insert(other.name);
    throw InputError(
        fmt::format("{} is no material of the program{}", name, suggestion(name, names)));
  }
  fmt::print("# {}: {}\n", material->name, material->title);
  for (const MaterialTarget& target : material->targets)
    fmt::print("#   {:<16} {}\n", target.name, value_with_unit(target));
  fmt::print("{}", wrapped("Source: " + material->source + ".", "# "));
  for (const MaterialBlock& block : material->blocks)
    fmt::print("\n# method = \"{}\"\n{}[material.{}]\n{}", block.method,
               wrapped("Local numbers: " + block.record + ".", "# "), material->name, block.keys);
}

}  // namespace

void add_materials(CLI::App& program) {
  const auto name = std::make_shared<std::string>();
  CLI::App* const command =
      program.add_subcommand("materials", "the materials that a case may use by name");
  command->add_option("NAME", *name, "one of them: its numbers, source, record");
  command->footer(
      "In a case:\n"
      "\n"
      "  [material.slab]\n"
      "  use = \"C30\"\n"
      "  density = 2450.0   # keys that stand there take the place of the material's\n"
      "\n"
      "The completed case.toml of a run holds the full numbers.");
  command->callback([name] { name->empty() ? list_all() : describe_material(*name); });
}

}  // namespace breccia::app
