#include "prepare/build.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "exec/error.hpp"
#include "math/constants.hpp"
#include "prepare/linking.hpp"
#include "prepare/ordering.hpp"
#include "prepare/packing.hpp"
#include "prepare/rebar.hpp"
#include "prepare/spheres_file.hpp"

namespace breccia {
namespace {

using dem::BodyConfig;
using dem::Config;
using dem::MaterialConfig;
using dem::Model;
using prepare::Bar;
using prepare::BodyLinks;
using prepare::Container;

double ball(double radius) {
  return 4.0 / 3.0 * pi * radius * radius * radius;
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

template <class Named>
int find_named(const std::vector<Named>& list, const std::string& name) {
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i].name == name) return static_cast<int>(i);
  return -1;
}

bool is_packed(const BodyConfig& body) {
  return body.shape == "box" || body.shape == "sphere" || body.shape == "cylinder";
}

Container container_of(const BodyConfig& body) {
  const auto shape = body.shape == "sphere"     ? Container::Shape::sphere
                     : body.shape == "cylinder" ? Container::Shape::cylinder
                                                : Container::Shape::box;
  return {.shape = shape, .size = body.size, .radius = body.radius, .length = body.length};
}

/// Everything that keeps a case's bodies from being built, one sentence each.
class BodyCheck {
 public:
  explicit BodyCheck(const Config& config) : config_(config) {
    if (config.bodies.empty()) problems_.push_back("a case needs at least one [[body]]");
    for (std::size_t i = 0; i < config.bodies.size(); ++i) check(i);
  }
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  template <class... Args>
  void require(bool holds, const BodyConfig& body, fmt::format_string<Args...> text,
               Args&&... args) {
    if (!holds)
      problems_.push_back(
          fmt::format("body {}: {}", body.name, fmt::format(text, std::forward<Args>(args)...)));
  }

  void check_material(const BodyConfig& body, const std::string& name,
                      const std::vector<std::string>& laws) {
    const int index = find_named(config_.materials, name);
    require(index >= 0, body, "\"{}\" is not a material of the case", name);
    if (index < 0) return;
    const std::string& law = config_.materials[static_cast<std::size_t>(index)].law;
    require(std::find(laws.begin(), laws.end(), law) != laws.end(), body,
            "material {} has law {}; needed is {}", name, law, joined(laws, " or "));
  }

  void check(std::size_t index) {
    const BodyConfig& body = config_.bodies[index];
    require(find_named(config_.bodies, body.name) == static_cast<int>(index), body,
            "another body has this name");
    if (body.shape == "rebar") return check_rebar(body);
    if (body.shape == "element")
      check_material(body, body.material, {"concrete", "grain", "steel"});
    else
      check_material(body, body.material, {"concrete", "grain"});
    if (body.shape == "file") {
      require(!body.file.empty(), body, "shape file needs the key file");
      const int material = find_named(config_.materials, body.material);
      const bool bulk =
          material >= 0 && config_.materials[static_cast<std::size_t>(material)].law == "concrete";
      require(!bulk || body.bulk_volume() > 0.0, body,
              "concrete from a file needs the key volume, or size");
    }
    if (body.shape == "box")
      require(std::min({body.size.x, body.size.y, body.size.z}) > 0.0, body,
              "a box needs a positive size in each direction");
    if (body.shape == "sphere" || body.shape == "cylinder" || body.shape == "element")
      require(body.radius > 0.0, body, "shape {} needs a positive radius", body.shape);
    if (body.shape == "cylinder")
      require(body.length > 0.0, body, "a cylinder needs a positive length");
    if (is_packed(body)) require(body.pack.count > 0, body, "pack.count must be at least 1");
  }

  void check_rebar(const BodyConfig& body) {
    check_material(body, body.material, {"steel"});
    check_material(body, body.rebar.interface_law, {"interface"});
    require(norm(body.velocity) == 0.0 && norm(body.spin) == 0.0, body,
            "bars move with the body they reinforce; give velocity and spin there");
    const int host = find_named(config_.bodies, body.rebar.in);
    require(host >= 0, body, "rebar.in = \"{}\" is not a body of the case", body.rebar.in);
    if (host < 0) return;
    const BodyConfig& box = config_.bodies[static_cast<std::size_t>(host)];
    require(box.shape == "box", body, "{} is not a box", box.name);
    if (box.shape != "box") return;
    for (const std::string& problem : prepare::bar_problems(body.rebar, box.size))
      require(false, body, "{}", problem);
  }

  const Config& config_;
  std::vector<std::string> problems_;
};

[[noreturn]] void refuse(const std::vector<std::string>& problems) {
  throw InputError(fmt::format("{} problem{} with the model; nothing was run.\n  {}",
                               problems.size(), problems.size() == 1 ? "" : "s",
                               joined(problems, "\n  ")));
}

/// Collects the elements of all bodies.
class Assembly {
 public:
  Assembly(const Config& config, const std::string& case_folder)
      : config_(config), case_folder_(case_folder) {
    for (std::size_t i = 0; i < config.bodies.size(); ++i) {
      const BodyConfig& body = config.bodies[i];
      model_.groups.push_back(body.name);
      body_ = &body;
      group_ = static_cast<std::int16_t>(i);
      material_ = static_cast<std::int16_t>(find_named(config.materials, body.material));
      BodyLinks links{.material = material_};
      if (body.shape == "rebar") {
        links = add_bars();
      } else if (body.shape == "element") {
        add({}, body.radius, material().density * ball(body.radius));
      } else {
        is_packed(body) ? add_packing() : add_file();
        if (material().law == "concrete") links.kind = BodyLinks::Kind::concrete;
      }
      links_.push_back(links);
    }
  }

  Model& model() { return model_; }
  const std::vector<BodyLinks>& links() const { return links_; }

 private:
  const MaterialConfig& material() const {
    return config_.materials[static_cast<std::size_t>(material_)];
  }

  /// A sphere at `offset` from the body's centre.
  void add(const Vec3& offset, double radius, double mass) {
    add(offset, radius, mass, 0.4 * mass * radius * radius, *body_);
  }

  void add(const Vec3& offset, double radius, double mass, double inertia,
           const BodyConfig& moves_as) {
    model_.group.push_back(group_);
    model_.material.push_back(material_);
    model_.radius.push_back(radius);
    model_.mass.push_back(mass);
    model_.inertia.push_back(inertia);
    model_.position.push_back(moves_as.center + offset);
    model_.velocity.push_back(moves_as.velocity + cross(moves_as.spin, offset));
    model_.spin.push_back(moves_as.spin);
    model_.bar_previous.push_back(-1);
    model_.bar_next.push_back(-1);
  }

  void add_packing() {
    const Container container = container_of(*body_);
    std::vector<Bar> bars;
    double volume = container.volume();
    for (const BodyConfig& other : config_.bodies) {
      if (other.shape != "rebar" || other.rebar.in != body_->name) continue;
      const auto more = prepare::bars_through(other.rebar, body_->size);
      volume -= prepare::bars_volume(other.rebar, more);
      bars.insert(bars.end(), more.begin(), more.end());
    }
    const double compactness = body_->pack.compactness;
    const prepare::Packing packing = prepare::pack(
        {.container = container,
         .obstacles = bars,
         .count = body_->pack.count,
         .size_ratio = body_->pack.size_ratio,
         .solid_volume = compactness * volume,
         .random = {static_cast<std::uint64_t>(config_.seed), static_cast<std::uint32_t>(group_)}});
    const double density = material().density / compactness;
    for (std::size_t i = 0; i < packing.radius.size(); ++i)
      add(packing.position[i], packing.radius[i], density * ball(packing.radius[i]));
  }

  void add_file() {
    const std::filesystem::path folder = case_folder_;
    const prepare::Spheres spheres = prepare::read_spheres((folder / body_->file).string());
    double solid = 0.0;
    for (const double r : spheres.radius) solid += ball(r);
    const double volume = body_->bulk_volume();
    const double density = material().density * (volume > 0.0 ? volume / solid : 1.0);
    for (std::size_t i = 0; i < spheres.radius.size(); ++i)
      add(spheres.position[i], spheres.radius[i], density * ball(spheres.radius[i]));
  }

  BodyLinks add_bars() {
    const dem::RebarConfig& rebar = body_->rebar;
    const int host = find_named(config_.bodies, rebar.in);
    const BodyConfig& box = config_.bodies[static_cast<std::size_t>(host)];
    for (const Bar& bar : prepare::bars_through(rebar, box.size)) {
      const prepare::BarElements piece = prepare::bar_elements(rebar, bar);
      for (int k = 0; k < rebar.elements; ++k) {
        const Index index = model_.size();
        const double mass = piece.mass(material().density, k, rebar.elements);
        add(prepare::bar_element_centre(bar, k, rebar.elements), bar.radius, mass,
            piece.inertia(mass), box);
        if (k == 0) continue;
        model_.bar_previous.back() = index - 1;
        model_.bar_next[static_cast<std::size_t>(index - 1)] = index;
      }
    }
    return {
        .kind = BodyLinks::Kind::bars,
        .material = material_,
        .host = host,
        .interface = static_cast<std::int16_t>(find_named(config_.materials, rebar.interface_law))};
  }

  const Config& config_;
  const std::string& case_folder_;
  const BodyConfig* body_ = nullptr;
  std::int16_t group_ = 0, material_ = 0;
  Model model_;
  std::vector<BodyLinks> links_;
};

double mean_radius(const Model& model) {
  double sum = 0.0;
  for (const double r : model.radius) sum += r;
  return sum / static_cast<double>(model.radius.size());
}

}  // namespace

dem::Model build_model(const dem::Config& config, const std::string& case_folder) {
  const BodyCheck check(config);
  if (!check.problems().empty()) refuse(check.problems());

  Assembly assembly(config, case_folder);
  Model& model = assembly.model();
  prepare::reorder(model, prepare::spatial_order(model.position, 2.0 * mean_radius(model)));
  prepare::link_elements(model, assembly.links(), config.links);

  const auto overlaps = prepare::free_overlaps(model, assembly.links());
  if (!overlaps.empty()) refuse(overlaps);
  return std::move(model);
}

}  // namespace breccia
