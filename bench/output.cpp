// Output of benchmarks: a table for people, JSON for programs, and answers line by line.

#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <istream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <sstream>

#include "bench/benchmark.hpp"
#include "bench/scenes.hpp"
#include "core/precision.hpp"
#include "dem/world.hpp"
#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "prepare/build.hpp"
#include "run/machine/machine.hpp"

namespace breccia {
namespace {

using Json = nlohmann::ordered_json;

/// Elements as x, y, z, radius, mass, group, fixed; links as the places of their two ends.
Json export_slab(const dem::World& w, const dem::Model& model, const std::string& folder) {
  std::vector<std::uint8_t> fixed;
  copy_to(fixed, w.elements.fixed);
  std::string elements = "x,y,z,radius,mass,group,fixed\nm,m,m,m,kg,-,-\n", links = "a,b\n-,-\n";
  for (std::size_t e = 0; e < model.position.size(); ++e) {
    const Vec3& x = model.position[e];
    elements += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{},{}\n", x.x, x.y, x.z,
                            model.radius[e], model.mass[e],
                            model.groups[static_cast<std::size_t>(model.group[e])], fixed[e]);
  }
  for (const dem::Model::Link& link : model.links) links += fmt::format("{},{}\n", link.a, link.b);
  replace_file(folder + "/elements.csv", elements);
  replace_file(folder + "/links.csv", links);
  return {{"elements", model.position.size()},
          {"links", model.links.size()},
          {"dt", w.next_dt},
          {"threads", w.exec.threads}};
}

}  // namespace

void pace_slab(std::istream& commands, std::ostream& answers, const Exec& exec) {
  const dem::Config config = slab_scene(1.0);
  const dem::Model model = build_model(config, "");
  dem::World w = dem::make_world(config, model, exec);
  std::string line;
  while (std::getline(commands, line)) {
    std::istringstream words(line);
    std::string verb, argument;
    words >> verb >> argument;
    Json answer;
    if (verb == "export") {
      answer = export_slab(w, model, argument);
    } else if (verb == "steps" || verb == "until") {
      const std::int64_t first = w.step;
      const auto last = verb == "steps" ? first + std::atoll(argument.c_str()) : INT64_MAX;
      const double end = verb == "until" ? std::atof(argument.c_str()) : no_limit;
      const auto start = std::chrono::steady_clock::now();
      const std::clock_t processor = std::clock();
      while (w.step < last && w.time < end) dem::step(w);
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
      answer = {
          {"seconds", spent.count()},
          {"processor_seconds", static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC},
          {"steps", w.step - first},
          {"time", w.time},
          {"dt", w.last_dt},
          {"searches", w.searches}};
    } else {
      throw InputError(fmt::format("'{}': there are steps N, until T and export FOLDER", line));
    }
    answers << answer.dump() << std::endl;  // the other side waits for the line
  }
}

std::string benchmark_json(const std::vector<std::pair<std::string, std::vector<Measurement>>>& all,
                           const Exec& exec, const std::string& device) {
  const Build& build = this_build();
  Json json;
  json["machine"] = {{"cpu", processor_name()}, {"device", device}, {"threads", exec.threads}};
  json["precision"] = word_of(exec.precision);
  json["breccia"] = {{"version", build.version},
                     {"commit", build.commit},
                     {"build", {{"type", build.type}, {"compiler", build.compiler}}}};
  json["benchmarks"] = Json::object();
  for (const auto& [name, measurements] : all)
    for (const Measurement& m : measurements) {
      Json& entry = json["benchmarks"][name][m.part][m.name];
      if (m.text.empty())
        entry = {{"value", m.median}, {"min", m.least}, {"max", m.most}, {"unit", m.unit}};
      else
        entry = m.text;
    }
  return json.dump(2) + "\n";
}

std::string benchmark_table(const std::string& name, const std::vector<Measurement>& measurements) {
  std::string table = fmt::format("{:<34} {:>12} {:>12} {:>12}\n", name, "median", "min", "max");
  std::string part;
  for (const Measurement& m : measurements) {
    if (m.part != part) table += fmt::format(" {}\n", m.part);
    part = m.part;
    if (!m.text.empty()) {
      table += fmt::format("  {:<32} {:>12}\n", m.name, m.text);
      continue;
    }
    table += fmt::format("  {:<32} {:>12.6g}", m.name, m.median);
    table += m.least == m.most ? fmt::format(" {:>25}", "")
                               : fmt::format(" {:>12.6g} {:>12.6g}", m.least, m.most);
    table += " " + (m.unit == "-" ? std::string{} : m.unit) + "\n";
  }
  return table;
}

}  // namespace breccia
