#include "prepare/build.hpp"

#include <algorithm>
#include <filesystem>

#include "dem/setup/materials.hpp"
#include "dem/setup/model_arrays.hpp"
#include "exec/filling.hpp"
#include "exec/timers.hpp"
#include "math/constants.hpp"
#include "prepare/checks/by_name.hpp"
#include "prepare/checks/check_bodies.hpp"
#include "prepare/checks/refusal.hpp"
#include "prepare/ldpm/body.hpp"
#include "prepare/meshing/heterogeneity.hpp"
#include "prepare/packing/body_packing.hpp"
#include "prepare/packing/linking.hpp"
#include "prepare/packing/ordering.hpp"
#include "prepare/packing/packing.hpp"
#include "prepare/packing/rebar.hpp"
#include "prepare/packing/spheres_file.hpp"
#include "prepare/packing/stiffness.hpp"
#include "prepare/shapes/carve.hpp"
#include "prepare/shapes/wall_files.hpp"

namespace breccia {
namespace {

using dem::BodyConfig;
using dem::Config;
using dem::MaterialConfig;
using dem::Model;
using prepare::Bar;
using prepare::BodyLinks;
using prepare::container_of;

double ball(double radius) {
  return 4.0 / 3.0 * pi * radius * radius * radius;
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

/// Collects the elements of all bodies.
class Assembly {
 public:
  Assembly(const Config& config, const std::string& case_folder, const Exec& how)
      : config_(config), case_folder_(case_folder), how_(how) {
    for (std::size_t i = 0; i < config.bodies.size(); ++i) {
      const BodyConfig& body = config.bodies[i];
      model_.groups.push_back(body.name);
      body_ = &body;
      group_ = static_cast<std::int16_t>(i);
      material_ = static_cast<std::int16_t>(find_named(config.materials, body.material));
      BodyLinks links{.material = material_, .of_file = body.shape == "file"};
      if (body.shape == "rebar") {
        links = add_bars();
      } else if (body.shape == "element") {
        add({}, body.radius, material().density * ball(body.radius));
      } else if (material().law == "ldpm") {
        add_particles();
        links.kind = BodyLinks::Kind::facets;
      } else {
        is_packed(body) ? add_packing() : add_file();
        if (const auto kind = dem::kind_within(material().law)) {
          links.kind = BodyLinks::Kind::range;
          links.link = *kind;
        }
      }
      links_.push_back(links);
    }
  }

  Model& model() { return model_; }
  std::vector<BodyLinks>& links() { return links_; }

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

  /// Spheres of one density.
  void add_all(const PlainVector<Vec3>& offset, const PlainVector<double>& radius, double density) {
    const std::size_t first = model_.position.size();
    dem::each_element_array(model_,
                            [&](const char*, auto& items) { items.resize(first + radius.size()); });
    each_portion(how_.threads, static_cast<Index>(radius.size()), [&](Index begin, Index end) {
      for (std::size_t k = at(begin); k < at(end); ++k) {
        const std::size_t e = first + k;
        const double mass = density * ball(radius[k]);
        model_.group[e] = group_;
        model_.material[e] = material_;
        model_.radius[e] = radius[k];
        model_.mass[e] = mass;
        model_.inertia[e] = 0.4 * mass * radius[k] * radius[k];
        model_.position[e] = body_->center + offset[k];
        model_.velocity[e] = body_->velocity + cross(body_->spin, offset[k]);
        model_.spin[e] = body_->spin;
        model_.bar_previous[e] = model_.bar_next[e] = -1;
      }
    });
  }

  /// Bars in the body, and the volume of their steel.
  struct Bars {
    std::vector<Bar> axes;
    double volume = 0.0;  ///<  [m3]
  };
  Bars bars_within() const {
    Bars bars;
    for (const BodyConfig& other : config_.bodies) {
      if (other.shape != "rebar" || other.rebar.in != body_->name) continue;
      const auto chains = prepare::chains_through(other.rebar, body_->size);
      bars.volume += prepare::bars_volume(chains);
      for (const prepare::Chain& chain : chains)
        bars.axes.insert(bars.axes.end(), chain.segments.begin(), chain.segments.end());
    }
    return bars;
  }
  void add_packing() {
    const StageTime timed(how_, "packing");
    const Bars bars = bars_within();
    const prepare::BodyPacking packing = prepare::pack_body(
        *body_, bars.axes, bars.volume,
        {static_cast<std::uint64_t>(config_.seed), static_cast<std::uint32_t>(group_)},
        how_.threads);
    add_all(packing.position, packing.radius, material().density / packing.compactness);
  }

  void add_particles() {
    const prepare::LdpmBody body =
        body_->shape == "file"
            ? prepare::ldpm_body(prepare::read_ldpm_mesh(path_of_file()), material())
            : prepare::ldpm_body(
                  container_of(*body_), material(),
                  {static_cast<std::uint64_t>(config_.seed), static_cast<std::uint32_t>(group_)},
                  bars_within().axes);
    const Index first = model_.size();
    for (std::size_t i = 0; i < body.position.size(); ++i)
      add(body.position[i], body.radius[i], material().density * body.cells[i].volume,
          material().density * body.cells[i].inertia, *body_);
    for (const prepare::LdpmFacet& f : body.facets)
      model_.facets.push_back(
          {first + f.a, first + f.b, first + f.c, first + f.d, body_->center + f.center, f.area});
  }

  std::string path_of_file() const {
    return (std::filesystem::path(case_folder_) / body_->file).string();
  }
  void add_file() {
    const prepare::Spheres spheres = prepare::read_spheres(path_of_file());
    double solid = 0.0;
    for (const double r : spheres.radius) solid += ball(r);
    const double volume = body_->bulk_volume();
    const double density = material().density * (volume > 0.0 ? volume / solid : 1.0);
    add_all({spheres.position.begin(), spheres.position.end()},
            {spheres.radius.begin(), spheres.radius.end()}, density);
  }

  void join(Index before, Index after) {
    model_.bar_next[static_cast<std::size_t>(before)] = after;
    model_.bar_previous[static_cast<std::size_t>(after)] = before;
  }

  BodyLinks add_bars() {
    const dem::RebarConfig& rebar = body_->rebar;
    const int host = find_named(config_.bodies, rebar.in);
    const BodyConfig& box = config_.bodies[static_cast<std::size_t>(host)];
    for (const prepare::Chain& chain : prepare::chains_through(rebar, box.size)) {
      const Index first = model_.size();
      for (std::size_t k = 0; k < chain.centres.size(); ++k) {
        const double mass = chain.mass(material().density, k);
        add(chain.centres[k], chain.radius(), mass, chain.inertia(mass, k), box);
        if (k > 0) join(model_.size() - 2, model_.size() - 1);
      }
      if (chain.closed) join(model_.size() - 1, first);
    }
    return {
        .kind = BodyLinks::Kind::bars,
        .material = material_,
        .host = host,
        .interface = static_cast<std::int16_t>(find_named(config_.materials, rebar.interface_law))};
  }

  const Config& config_;
  const std::string& case_folder_;
  const Exec& how_;
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

constexpr std::uint32_t grain_stream = 0x40000;  ///< of random numbers: packings use those below

/// Links between two grains of a body get the material of its grains' boundaries.
void give_boundaries(Model& model, const Config& config) {
  for (std::size_t b = 0; b < config.bodies.size(); ++b) {
    const dem::GrainsConfig& grains = config.bodies[b].grains;
    if (grains.boundary.empty()) continue;
    const std::vector<std::uint64_t> grain = prepare::voronoi_grains(
        std::vector<Vec3>(model.position.begin(), model.position.end()), grains.size,
        {static_cast<std::uint64_t>(config.seed), grain_stream + static_cast<std::uint32_t>(b)});
    const auto of_body = [&](Index e) {
      return static_cast<std::size_t>(model.group[static_cast<std::size_t>(e)]) == b;
    };
    const auto material = static_cast<std::int16_t>(find_named(config.materials, grains.boundary));
    for (Model::Link& link : model.links)
      if (of_body(link.a) && of_body(link.b) &&
          grain[static_cast<std::size_t>(link.a)] != grain[static_cast<std::size_t>(link.b)])
        link.material = material;
  }
}

void refuse_bars_outside(const Config& config, const std::string& case_folder) {
  std::vector<std::string> problems;
  for (const BodyConfig& host : config.bodies) {
    if (host.shape != "stl" || !prepare::has_bars(config.bodies, host)) continue;
    const std::string path = (std::filesystem::path(case_folder) / host.file).string();
    const auto found =
        prepare::bars_outside(config.bodies, host, prepare::read_surface(path, host.file_unit));
    problems.insert(problems.end(), found.begin(), found.end());
  }
  prepare::refuse(problems, "with the model");
}

}  // namespace

dem::Model build_model(const dem::Config& config, const std::string& case_folder, const Exec& how) {
  const FillingThreads filling(how.threads);
  prepare::refuse(prepare::body_problems(config), "with the model");

  refuse_bars_outside(config, case_folder);
  Config whole = prepare::with_whole_bodies(config, case_folder);
  Assembly assembly(whole, case_folder, how);
  Model& model = assembly.model();
  for (BodyLinks& links : assembly.links())
    if (links.kind == BodyLinks::Kind::bars) {
      const BodyConfig& host = config.bodies[static_cast<std::size_t>(links.host)];
      links.within = prepare::shape_within(
          host, *prepare::item_named(config.materials, host.material), case_folder);
    }
  const auto part = [&how](const char* name, const auto& work) {
    const StageTime timed(how, name);
    work();
  };
  part("order", [&] {
    const double edge = 2.0 * mean_radius(model);
    prepare::reorder(model, prepare::spatial_order(model.position, edge, how.threads), how.threads);
  });
  part("links", [&] {
    prepare::link_elements(model, assembly.links(), config.links, how.threads);
    prepare::link_facets(model);
  });
  part("stiffness", [&] {
    for (MaterialConfig& material : whole.materials) material.bedding = {};  // E is that without
    prepare::set_stiffness(model, whole, how.threads);
  });
  part("carving", [&] {
    give_boundaries(model, config);
    prepare::carve(model, config, case_folder);
    prepare::add_wall_meshes(model, config, case_folder);
  });
  part("overlaps", [&] {
    prepare::refuse(prepare::free_overlaps(model, assembly.links(), how.threads), "with the model");
  });
  return std::move(model);
}

}  // namespace breccia
