#include "run/results/picture_notes.hpp"

#include <fmt/format.h>

#include <charconv>

#include "exec/error.hpp"
#include "exec/no_memory.hpp"
#include "io/json.hpp"
#include "run/machine/machine.hpp"

namespace breccia {
namespace {

Json json_of(const Vec3& v) {
  return Json::array({v.x, v.y, v.z});
}

Vec3 vector_of(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Json json_of(const RenderOptions& o) {
  Json json{{"field", o.field}, {"view", o.view},         {"clip", o.clip},
            {"width", o.width}, {"height", o.height},     {"spheres", o.show_spheres},
            {"map", o.map},     {"links", o.show_links},  {"hidden", o.hidden},
            {"title", o.title}, {"range", Json(nullptr)}, {"extent", Json(nullptr)}};
  json["xray"] = o.xray;
  json["crosses"] = o.crosses;
  json["walls"] = o.walls;
  json["arrows"] = o.arrows;
  json["scale"] = o.scale;
  json["transparent"] = o.transparent;
  json["log"] = o.log;
  if (o.forces) json["forces"] = true;
  json["edges"] = o.edges;
  json["bare"] = o.bare;
  if (o.camera)
    json["camera"] = {{"eye", json_of(o.camera->eye)},
                      {"target", json_of(o.camera->target)},
                      {"up", json_of(o.camera->up)},
                      {"field_of_view", o.camera->field_of_view}};
  if (o.range) json["range"] = {o.range->low, o.range->high};
  if (o.extent) {
    json["extent"] = {{"low", json_of(o.extent->low)},
                      {"high", json_of(o.extent->high)},
                      {"outline", Json::array()},
                      {"points", o.extent->outline_points}};
    for (const Vec3& point : o.extent->outline) json["extent"]["outline"].push_back(json_of(point));
  }
  return json;
}

RenderOptions options_of(const Json& json) {
  RenderOptions o;
  json.at("field").get_to(o.field);
  json.at("view").get_to(o.view);
  json.at("clip").get_to(o.clip);
  json.at("width").get_to(o.width);
  json.at("height").get_to(o.height);
  json.at("spheres").get_to(o.show_spheres);
  json.at("map").get_to(o.map);
  json.at("links").get_to(o.show_links);
  json.at("hidden").get_to(o.hidden);
  json.at("title").get_to(o.title);
  json.at("xray").get_to(o.xray);
  json.at("crosses").get_to(o.crosses);
  json.at("walls").get_to(o.walls);
  json.at("arrows").get_to(o.arrows);
  json.at("scale").get_to(o.scale);
  json.at("transparent").get_to(o.transparent);
  json.at("log").get_to(o.log);
  o.forces = json.value("forces", false);
  json.at("edges").get_to(o.edges);
  json.at("bare").get_to(o.bare);
  if (json.contains("camera")) {
    const Json& camera = json.at("camera");
    o.camera = Viewpoint{vector_of(camera.at("eye")), vector_of(camera.at("target")),
                         vector_of(camera.at("up")), camera.at("field_of_view").get<double>()};
  }
  if (const Json& range = json.at("range"); !range.is_null())
    o.range = ValueRange{range.at(0).get<double>(), range.at(1).get<double>()};
  if (const Json& extent = json.at("extent"); !extent.is_null()) {
    Extent& e = o.extent.emplace();
    e.low = vector_of(extent.at("low"));
    e.high = vector_of(extent.at("high"));
    for (std::size_t i = 0; i < e.outline.size(); ++i)
      e.outline[i] = vector_of(extent.at("outline").at(i));
    e.outline_points = extent.at("points").get<std::int64_t>();
    if (e.outline_points < 0 || e.outline_points > static_cast<std::int64_t>(e.outline.size()))
      throw InputError("points of the outline");
  }
  return o;
}

}  // namespace

std::vector<PngNote> notes_of_case(const std::string& name, const std::string& text,
                                   std::int64_t seed) {
  return {{"Software", "breccia " + this_build().version},
          {"Case", name},
          {"Seed", std::to_string(seed)},
          {"Case file", text}};
}

std::vector<PngNote> notes_of_picture(const PictureMoment& moment, const RenderOptions& options) {
  const NeedsMemory scope;
  Json json{{"step", moment.step}, {"time", moment.time}};
  if (moment.frame) json["frame"] = *moment.frame;
  json["options"] = json_of(options);
  std::vector<PngNote> notes;
  if (moment.hash) notes.push_back({"State hash", fmt::format("{:016x}", *moment.hash)});
  notes.push_back({"Picture", json_text(json)});
  return notes;
}

PictureRecipe recipe_of(const std::vector<PngNote>& notes, const std::string& path) {
  PictureRecipe recipe;
  const std::string software = note(notes, "Software"), picture = note(notes, "Picture");
  recipe.case_name = note(notes, "Case");
  recipe.case_text = note(notes, "Case file");
  if (!software.starts_with("breccia ") || recipe.case_text.empty())
    throw InputError(path +
                     ": the picture does not say of which run it is; pictures of `run` and "
                     "`render` do, unless another program has changed them");
  recipe.version = software.substr(8);
  if (picture.empty())
    throw InputError(path +
                     ": a frame whose step is not known, since log.jsonl does not tell it: the "
                     "picture names its case but cannot be drawn again");
  try {
    const NeedsMemory scope;
    const Json json = read_json(picture);
    json.at("step").get_to(recipe.moment.step);
    json.at("time").get_to(recipe.moment.time);
    if (json.contains("frame")) recipe.moment.frame = json.at("frame").get<int>();
    recipe.options = options_of(json.at("options"));
  } catch (const std::exception&) {
    throw InputError(path + ": the text \"Picture\" in the picture is damaged");
  }
  const std::string hash = note(notes, "State hash");
  std::uint64_t value = 0;
  if (!hash.empty()) {
    if (std::from_chars(hash.data(), hash.data() + hash.size(), value, 16).ec != std::errc{})
      throw InputError(path + ": the text \"State hash\" in the picture is damaged");
    recipe.moment.hash = value;
  }
  return recipe;
}

}  // namespace breccia
