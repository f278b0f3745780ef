#include "run/method/shown.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "core/probe_curve.hpp"
#include "exec/error.hpp"
#include "exec/no_memory.hpp"
#include "io/case/suggestion.hpp"
#include "io/json.hpp"
#include "io/picture/color_map.hpp"
#include "io/picture/picture.hpp"
#include "run/method/coupled_method.hpp"
#include "run/method/dem_method.hpp"
#include "run/method/emission_table.hpp"
#include "run/method/fdem3_method.hpp"
#include "run/method/fdem_method.hpp"
#include "run/results/summary.hpp"

namespace breccia {
namespace {

/// Names that checks and pictures may use.
struct Shown {
  std::set<std::string> numbers;  ///< paths into summary.json, without those of probes
  Frame frame;
};

void add_numbers(const Json& json, const std::string& path, std::set<std::string>& paths) {
  for (const auto& [key, value] : json.items()) {
    const std::string below = path.empty() ? key : path + "." + key;
    if (value.is_object()) add_numbers(value, below, paths);
    if (value.is_number()) paths.insert(below);
  }
}

Shown shown_by(Method& specimen) {
  Summary summary;
  summary.facts = specimen.facts();
  summary.energy = specimen.energy();
  Shown shown;
  const NeedsMemory scope;
  add_numbers(read_json(to_json(summary)), "", shown.numbers);
  for (const char* const part : {"", "spheres.", "tetrahedra."})
    if (const std::string heard = part + std::string("emission.");
        shown.numbers.contains(heard + "events"))
      for (const char* const number : emission_numbers) shown.numbers.insert(heard + number);
  for (const char* const what : {"joints", "links"})  // where a stage takes bodies out
    for (const std::string& number : std::set(shown.numbers))
      if (number.ends_with(std::string("fracture.broken_") + what))
        shown.numbers.insert(number.substr(0, number.rfind("broken_")) + "removed_" + what);
  shown.frame = specimen.frame();
  return shown;
}

std::set<std::string> field_names(const Frame& frame) {
  std::set<std::string> names;
  for (const auto* fields :
       {&frame.point_fields, &frame.line_fields, &frame.triangle_fields, &frame.tetrahedron_fields})
    for (const FrameField& field : *fields)
      names.insert(field.name + (field.components == 3 ? "[_x, _y, _z]" : ""));
  return names;
}

/// The problem of a check that no run can evaluate; empty: none.
std::string problem_of(const CheckConfig& c, const std::vector<ProbeConfig>& probes,
                       const Shown& shown, double end) {
  const std::string where = fmt::format("check.{}.value = {:?}", c.name, c.value);
  const bool at_time = c.value.starts_with("probe.") && c.value.ends_with(".at");
  if (at_time != (c.at >= 0.0))
    return at_time ? where + " needs `at`, the time when it is read"
                   : fmt::format("check.{}.at is of a value probe.<name>.at; it is {:?}", c.name,
                                 c.value);
  if (c.at > end)
    return fmt::format("check.{}.at = {:.6g} s: the case ends at {:.6g} s", c.name, c.at, end);
  if (c.value.starts_with("stages_s.")) return "";  // as many as the run comes to
  if (!c.value.starts_with("probe."))
    return shown.numbers.contains(c.value)
               ? ""
               : where + " is no number of summary.json" + suggestion(c.value, shown.numbers);
  const std::size_t dot = c.value.rfind('.');
  const std::string name = dot > 5 ? c.value.substr(6, dot - 6) : "",
                    which = c.value.substr(dot + 1);
  std::string known;
  for (const ProbeConfig& probe : probes) {
    if (probe.name == name)
      return which == "last" || which == "min" || which == "max" || which == "at"
                 ? ""
                 : where + " must end in .last, .min, .max or .at";
    known += (known.empty() ? "" : ", ") + probe.name;
  }
  return where + " is not of a probe; there are: " + (known.empty() ? "none" : known);
}

/// The problem of a curve over a probe, or of one, that the case does not have; empty: none.
std::string problem_of_curve(const std::string& text, const std::vector<ProbeConfig>& probes) {
  const std::optional<ProbeCurve> curve = ProbeCurve::parsed(text);
  const std::string where = fmt::format("output.curves = {:?}", text);
  if (!curve)
    return where + " is not of the form \"force over deflection\", the names of two probes";
  std::set<std::string> names;
  for (const ProbeConfig& probe : probes) names.insert(probe.name);
  for (const std::string& name : {curve->y.probe, curve->x.probe})
    if (!names.contains(name))
      return fmt::format("{}: {} is no probe{}", where, name, suggestion(name, names));
  return "";
}

/// Problems of keys by which pictures are drawn: each is found by drawing one.
std::vector<std::string> problems_of_pictures(const OutputConfig& output, const Frame& frame) {
  std::vector<std::string> problems;
  const std::set<std::string> more{"displacement", "force", "stress"};
  for (const std::string& name : output.more)
    if (!more.contains(name))
      problems.push_back(fmt::format("output.more: {:?} is none of displacement, force, stress{}",
                                     name, suggestion(name, more)));
  try {
    frame_format(output.format);
  } catch (const InputError& error) {
    problems.push_back(fmt::format("output.format: {}", error.what()));
  }
  if (!output.range.empty() && (output.range.size() != 2 || !(output.range[0] < output.range[1])))
    problems.push_back("output.range needs two values, the lower first, such as [0, 2.5e6]");
  const auto try_out = [&](const char* key, RenderOptions options) {
    options.field = "";
    options.view = output.view;
    options.width = options.height = 64;
    try {
      render(frame, options);
    } catch (const InputError& error) {
      problems.push_back(fmt::format("output.{}: {}", key, error.what()));
    }
  };
  if (!output.clip.empty()) try_out("clip", {.clip = output.clip});
  if (!output.arrows.empty()) try_out("arrows", {.arrows = output.arrows});
  if (!output.hide.empty()) try_out("hide", {.hidden = {output.hide.begin(), output.hide.end()}});
  if (!output.map.empty()) {
    try {
      map_named(output.map);
    } catch (const InputError& error) {
      problems.push_back(fmt::format("output.map: {}", error.what()));
    }
  }
  return problems;
}

/// Fields that frames of a case have and its specimen's have not: of supports, bars and facets.
template <class Config>
std::set<std::string> more_fields(const Config& config) {
  std::set<std::string> more;
  const auto add = [&](const auto& part) {
    if (!part.supports.empty()) more.insert("held");
    for (const auto& body : part.bodies)
      if (body.shape == "rebar") more.insert("bar");
    if constexpr (requires { part.materials.front().law; })
      for (const auto& material : part.materials)
        if (material.law == "ldpm") more.insert({"opening", "slip"});
  };
  if constexpr (requires { config.spheres; })
    add(config.spheres), add(config.tetrahedra);
  else
    add(config);
  return more;
}

/// @param more  fields of the case's frames besides the specimen's
void refuse_what_is_not_shown(const CaseConfig& config, Method& specimen,
                              const std::set<std::string>& more) {
  const Shown shown = shown_by(specimen);
  std::set<std::string> fields = field_names(shown.frame);
  fields.insert(more.begin(), more.end());
  std::vector<std::string> problems;
  for (const CheckConfig& check : config.checks)
    problems.push_back(problem_of(check, config.probes, shown, config.time.end));
  for (const std::string& curve : config.output.curves)
    problems.push_back(problem_of_curve(curve, config.probes));
  if (!has_field(shown.frame, config.output.color) && !more.contains(config.output.color))
    problems.push_back(fmt::format(
        "output.color = {:?} is no field of the frames{}; allowed are {}, and \"\" for "
        "none",
        config.output.color, config.output.color == "speed" ? ", it is called velocity there" : "",
        fmt::join(fields, ", ")));
  for (std::string& problem : problems_of_pictures(config.output, shown.frame))
    problems.push_back(std::move(problem));
  std::erase(problems, "");
  if (problems.empty()) return;
  throw InputError(fmt::format("{} problem{} in the case; nothing was run.\n  {}", problems.size(),
                               problems.size() == 1 ? "" : "s", fmt::join(problems, "\n  ")));
}

/// One element a body.
dem::Model specimen_of(const dem::Config& config) {
  dem::Model model;
  for (const dem::BodyConfig& body : config.bodies) {
    model.group.push_back(static_cast<std::int16_t>(model.groups.size()));
    model.position.push_back({10.0 * static_cast<double>(model.groups.size()), 0.0, 0.0});
    model.groups.push_back(body.name);
  }
  const std::size_t count = model.groups.size();
  model.material.assign(count, 0);
  model.radius = model.mass = model.inertia = PlainVector<double>(count, 1.0);
  model.velocity = model.spin = PlainVector<Vec3>(count, Vec3{});
  model.bar_previous = model.bar_next = PlainVector<Index>(count, -1);
  return model;
}
/// One tetrahedron a body.
fdem3::Model specimen_of(const fdem3::Config& config) {
  fdem3::Model model;
  for (const fdem3::BodyConfig& body : config.bodies) {
    const auto first = static_cast<Index>(model.point.size());
    const double x = 10.0 * static_cast<double>(model.groups.size());
    for (const Vec3& corner :
         {Vec3{x, 0.0, 0.0}, Vec3{x + 1.0, 0.0, 0.0}, Vec3{x, 1.0, 0.0}, Vec3{x, 0.0, 1.0}})
      model.point.push_back(corner);
    model.tetrahedron.push_back({first, first + 1, first + 2, first + 3});
    model.group.push_back(static_cast<std::int16_t>(model.groups.size()));
    model.groups.push_back(body.name);
  }
  const std::size_t count = model.groups.size();
  model.material.resize(count);
  model.velocity.resize(count);
  model.strength.assign(count, 1.0F);
  return model;
}
/// The case of such a specimen.
template <class Config>
Config case_of_specimen(const CaseConfig& config) {
  Config one;
  one.domain.show = config.domain.show;
  one.output = config.output;
  return one;
}

/// Its fluids. @param part  part(load, outlet): lets an outlet be elsewhere
template <class Given, class Config, class Part>
void add_fluids(const Given& config, Config& one, const Part& part) {
  for (const auto& load : config.loads)
    if (load.kind == "fluid") {
      auto& added = one.loads.emplace_back();
      added.name = load.name;
      added.kind = load.kind;
      added.viscosity = load.viscosity;
      if (load.outlets.empty()) continue;
      part(added, added.outlets.emplace_back().region);
    }
}

/// Its bolts. @param put  put(bolt): where it is
template <class Given, class Config, class Put>
void add_bolts(const Given& config, Config& one, const Put& put) {
  if (config.bodies.empty()) return;
  for (const auto& bolt : config.bolts) {
    one.bolts.emplace_back().name = bolt.name;
    put(one.bolts.back());
  }
}
/// In the first tetrahedron.
void put_in_space(fdem3::BoltConfig& bolt) {
  bolt.points = {{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}};
}

/// One edge of a tetrahedron, and the one opposite.
void part_outlet(fdem3::LoadConfig& load, fdem3::RegionConfig& outlet) {
  load.region.max = {0.5, 0.5, no_limit};
  outlet.center = {1.0, 1.0, 0.0};
  outlet.radius = 1.1;
}

}  // namespace

void check_shown(const dem::Config& config) {
  auto one = case_of_specimen<dem::Config>(config);
  one.materials.emplace_back();
  refuse_what_is_not_shown(config, *make_method(one, specimen_of(config), {}), more_fields(config));
}

void check_shown(const coupled::Config& config) {
  auto one = case_of_specimen<coupled::Config>(config);
  one.spheres.materials.emplace_back();
  one.tetrahedra.materials.emplace_back();
  add_fluids(config.tetrahedra, one.tetrahedra, part_outlet);
  add_bolts(config.tetrahedra, one.tetrahedra, put_in_space);
  coupled::Model model{specimen_of(config.spheres), specimen_of(config.tetrahedra)};
  for (Vec3& place : model.spheres.position) place.y = 100.0;  // clear of the tetrahedra
  refuse_what_is_not_shown(config, *make_method(one, model, {}), more_fields(config));
}

void check_shown(const fdem::Config& config) {
  fdem::Config one;
  one.materials.emplace_back();
  one.domain.show = config.domain.show;
  one.output = config.output;
  add_fluids(config, one, [](fdem::LoadConfig& load, fdem::RegionConfig& outlet) {
    load.region.max = {0.5, 0.5};  // the first corner, and another one
    outlet.min = {0.5, -0.5};
  });
  fdem::Model model;  // one triangle a body
  for (const fdem::BodyConfig& body : config.bodies) {
    const auto first = static_cast<Index>(model.point.size());
    const double x = 10.0 * static_cast<double>(model.groups.size());
    for (const Vec2& corner : {Vec2{x, 0.0}, Vec2{x + 1.0, 0.0}, Vec2{x, 1.0}})
      model.point.push_back(corner);
    model.triangle.push_back({first, first + 1, first + 2});
    model.group.push_back(static_cast<std::int16_t>(model.groups.size()));
    model.groups.push_back(body.name);
  }
  add_bolts(config, one, [](auto& bolt) { bolt.points = {{0.1, 0.1}, {0.3, 0.3}}; });
  const std::size_t count = model.groups.size();
  model.material.resize(count);
  model.velocity.resize(count);
  model.strength.assign(count, 1.0F);
  refuse_what_is_not_shown(config, *make_method(one, model, {}), more_fields(config));
}

void check_shown(const fdem3::Config& config) {
  auto one = case_of_specimen<fdem3::Config>(config);
  one.materials.emplace_back();
  add_fluids(config, one, part_outlet);
  add_bolts(config, one, put_in_space);
  refuse_what_is_not_shown(config, *make_method(one, specimen_of(config), {}), more_fields(config));
}

}  // namespace breccia
