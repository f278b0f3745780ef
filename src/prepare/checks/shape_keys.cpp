#include "prepare/checks/shape_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace breccia::prepare {
namespace {

/// A key, whether it is given, and the shapes that read it.
struct ShapeKey {
  const char* name;
  bool given;
  std::vector<std::string_view> shapes;
};

/// "boxes, cylinders and files"
std::string several(const std::vector<std::string_view>& shapes) {
  const auto plural = [](std::string_view shape) {
    return shape == "box"        ? "boxes"
           : shape == "disc"     ? "discs"
           : shape == "stl"      ? "STL surfaces"
           : shape == "geo"      ? ".geo files"
           : shape == "mesh"     ? "mesh files"
           : shape == "hexagons" ? "hexagons"
                                 : std::string(shape) + "s";
  };
  std::string text;
  for (std::size_t k = 0; k < shapes.size(); ++k)
    text += (k == 0 ? "" : k + 1 < shapes.size() ? ", " : " and ") + plural(shapes[k]);
  return text;
}

/// @param path  of the keys, with a dot behind it
void look(const std::string& path, const std::string& shape, const std::vector<ShapeKey>& keys,
          std::vector<std::string>& problems) {
  for (const ShapeKey& key : keys) {
    if (!key.given || std::find(key.shapes.begin(), key.shapes.end(), shape) != key.shapes.end())
      continue;
    problems.push_back(
        fmt::format("{}{} is of {}; shape is {}", path, key.name, several(key.shapes), shape));
  }
}

void look_at_solids(const std::string& path, const std::vector<dem::CutConfig>& solids,
                    std::vector<std::string>& problems) {
  for (std::size_t k = 0; k < solids.size(); ++k) {
    const dem::CutConfig& s = solids[k];
    look(fmt::format("{}[{}].", path, k), s.shape,
         {{"size", norm(s.size) > 0.0, {"box"}},
          {"radius", s.radius > 0.0, {"sphere", "cylinder"}},
          {"length", s.length > 0.0, {"cylinder"}},
          {"file", !s.file.empty(), {"stl"}},
          {"file_unit", s.file_unit != dem::CutConfig{}.file_unit, {"stl"}}},
         problems);
  }
}

}  // namespace

std::vector<std::string> keys_of_other_shapes(const dem::BodyConfig& b) {
  std::vector<std::string> problems;
  const std::string path = "body." + b.name + ".";
  look(path, b.shape,
       {{"size", norm(b.size) > 0.0, {"box", "file"}},
        {"radius", b.radius > 0.0, {"sphere", "cylinder", "element"}},
        {"length", b.length > 0.0, {"cylinder"}},
        {"file", !b.file.empty(), {"stl", "file"}},
        {"file_unit", b.file_unit != dem::BodyConfig{}.file_unit, {"stl"}},
        {"volume", b.volume > 0.0, {"file"}},
        {"rebar", !b.rebar.in.empty(), {"rebar"}}},
       problems);
  look_at_solids(path + "join", b.joins, problems);
  look_at_solids(path + "cut", b.cuts, problems);
  return problems;
}

std::vector<std::string> keys_of_other_shapes(const fdem::BodyConfig& b) {
  std::vector<std::string> problems;
  look("body." + b.name + ".", b.shape,
       {{"size", norm(b.size) > 0.0, {"plate", "beam", "hexagons", "part"}},
        {"radius", b.radius > 0.0, {"disc", "ring", "part"}},
        {"inner_radius", b.inner_radius > 0.0, {"ring"}},
        {"corners", !b.corners.empty(), {"part"}},
        {"of", !b.of.empty(), {"part"}},
        {"hexagons", b.hexagons.count > 0, {"hexagons"}}},
       problems);
  return problems;
}

std::vector<std::string> keys_of_other_shapes(const fdem3::BodyConfig& b) {
  std::vector<std::string> problems;
  look("body." + b.name + ".", b.shape,
       {{"size", norm(b.size) > 0.0, {"box", "part"}},
        {"radius", b.radius > 0.0, {"cylinder", "sphere", "part"}},
        {"height", b.height > 0.0, {"cylinder", "part"}},
        {"of", !b.of.empty(), {"part"}}},
       problems);
  return problems;
}

}  // namespace breccia::prepare
