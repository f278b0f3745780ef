// From a case to what is between spheres and tetrahedra: laws, bonds, first forces.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/on_host.hpp"
#include "core/set_up.hpp"
#include "coupled/setup/tie.hpp"
#include "coupled/world.hpp"
#include "dem/stepping/step.hpp"
#include "domain/together.hpp"
#include "exec/error.hpp"
#include "fdem3/stepping/step.hpp"

namespace breccia::coupled {
namespace {

/// E of the contact of two solids.
double contact_modulus(double young_a, double poisson_a, double young_b, double poisson_b) {
  return 1.0 / ((1.0 - poisson_a * poisson_a) / young_a + (1.0 - poisson_b * poisson_b) / young_b);
}

std::vector<PressLaw> press_laws(const Config& config) {
  std::vector<PressLaw> laws;
  for (const dem::MaterialConfig& p : config.spheres.materials)
    for (const fdem3::MaterialConfig& q : config.tetrahedra.materials)
      laws.push_back(
          {config.coupling.stiffness * contact_modulus(p.young, p.poisson, q.young, q.poisson),
           config.coupling.tangential, config.coupling.friction});
  return laws;
}

fdem::JointBond bond_law(const BondConfig& bond, double young) {
  constexpr double unbroken = 1e18;  // strength of what does not break  [Pa]
  fdem::JointBond law{};
  law.stiffness = bond.stiffness * young;
  law.tension = bond.breaks ? bond.tensile_strength : unbroken;
  law.cohesion = bond.breaks ? bond.cohesion : unbroken;
  law.friction = std::tan(bond.friction_angle);
  law.softening_open = fdem::exact_softening_factor * bond.energy_open;
  law.softening_slide = fdem::exact_softening_factor * bond.energy_slide;
  return law;
}

/// Bonds whose elastic stretch is no small part of what they bear until they break.
void warn_of_long(const BondConfig& bond, const fdem::JointBond& law,
                  const std::vector<BallBond>& ties, std::vector<std::string>& warnings) {
  double longest = 0.0;
  for (const BallBond& b : ties) longest = std::max(longest, b.length);
  const double enough = 0.25 * law.softening_open * law.stiffness / (law.tension * law.tension);
  if (longest > enough)
    warnings.push_back(fmt::format(
        "bond.{}: bonds {:.3g} m long stretch as much before they soften as while they do; smaller "
        "spheres, or a larger stiffness or energy_open, would keep G_I",
        bond.name, longest));
}

/// Items of the world that ranks share, or of the one that is alone.
Index count_of_all(const Domain& domain, Index here) {
  if (domain.single_rank()) return here;
  std::vector<std::int64_t> owned{domain.counts.owned};
  domain.ranks->add_up(owned);
  return static_cast<Index>(owned[0]);
}

/// An array of the items of all ranks, in the order of their numbers.
template <class T>
Buffer<T> of_all(const Domain& domain, const Buffer<GlobalId>& ids, const Buffer<T>& items) {
  if (domain.single_rank()) return items;
  struct Numbered {
    GlobalId id;
    T item;
  };
  std::vector<Numbered> own;
  for (Index i = 0; i < ids.size(); ++i)
    if (domain.owns(i)) own.push_back({ids.data()[i], items.data()[i]});
  std::vector<Numbered> all = joined(*domain.ranks, own);
  std::sort(all.begin(), all.end(),
            [](const Numbered& a, const Numbered& b) { return a.id < b.id; });
  Buffer<T> whole(Space::host, static_cast<Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) whole.data()[i] = all[i].item;
  return whole;
}

void warn_of_overlaps(const World& w, std::vector<std::string>& warnings) {
  const double touching = count(w).touching;
  if (touching > 0.0)
    warnings.push_back(fmt::format(
        "{} spheres overlap a body of tetrahedra at the start, and are pushed out", touching));
}

}  // namespace

World::World(dem::World& of_spheres, fdem3::World& of_tetrahedra)
    : spheres(&of_spheres), tetrahedra(&of_tetrahedra) {
  each_array([&](auto& array) {
    array = std::remove_reference_t<decltype(array)>(of_spheres.exec.space);
  });
}

World make_world(const Config& config, dem::World& spheres, fdem3::World& tetrahedra) {
  World w(spheres, tetrahedra);
  tetrahedra.meets_spheres = true;
  tetrahedra.next_dt = fdem3::choose_time_step(tetrahedra);
  const Space space = spheres.exec.space;
  Case& given = w.given.change(SetUp{});
  given.safety = config.time.safety;
  given.skin = spheres.given->search.margin * spheres.given->mean_radius;
  given.materials = static_cast<Index>(config.tetrahedra.materials.size());
  given.spheres = count_of_all(spheres.domain, spheres.elements.size());
  given.tetrahedra = count_of_all(tetrahedra.domain, tetrahedra.tetrahedra.size());
  copy_to(given.laws, press_laws(config));
  std::vector<fdem::JointBond> laws;
  std::vector<BallBond> ties;
  dem::Elements elements;
  fdem3::Tetrahedra solids;
  if (!config.bonds.empty()) {
    const OnHost own(spheres.elements, space);
    elements.id = of_all(spheres.domain, own->id, own->id);
    elements.group = of_all(spheres.domain, own->id, own->group);
    elements.state = of_all(spheres.domain, own->id, own->state);
    const OnHost mesh(tetrahedra.tetrahedra, space);
    solids.id = of_all(tetrahedra.domain, mesh->id, mesh->id);
    solids.group = of_all(tetrahedra.domain, mesh->id, mesh->group);
    solids.material = of_all(tetrahedra.domain, mesh->id, mesh->material);
    solids.nodes = of_all(tetrahedra.domain, mesh->id, mesh->nodes);
    solids.exposed = of_all(tetrahedra.domain, mesh->id, mesh->exposed);
  }
  for (const BondConfig& bond : config.bonds) {
    const std::vector<BallBond> more =
        ties_of(bond, static_cast<Index>(laws.size()), w, elements, solids);
    const Index material = solids.material.data()[more.front().tetrahedron];
    laws.push_back(
        bond_law(bond, config.tetrahedra.materials[static_cast<std::size_t>(material)].young));
    warn_of_long(bond, laws.back(), more, given.warnings);
    given.bond_names.push_back(bond.name);
    ties.insert(ties.end(), more.begin(), more.end());
  }
  std::stable_sort(ties.begin(), ties.end(),
                   [](const BallBond& a, const BallBond& b) { return a.sphere < b.sphere; });
  copy_to(given.bonds, laws);
  copy_to(w.bonds.tie, ties);
  w.bonds.state.resize(static_cast<Index>(ties.size()));

  w.stable_step = tetrahedra.next_dt;
  if (!spheres.domain.single_rank()) dem::find_critical(spheres);
  find_faces(w);
  press(w);
  fdem3::share_bundle_forces(tetrahedra);
  dem::StepwiseRun{}.choose_step(spheres);
  note_stable_step(w);
  choose_common_step(w);
  warn_of_overlaps(w, given.warnings);
  return w;
}

}  // namespace breccia::coupled
