#include "dem/setup/removal.hpp"

#include "core/on_host.hpp"
#include "dem/setup/change_array.hpp"
#include "exec/error.hpp"

namespace breccia::dem {
namespace {

// A link lets go for good. What it has spent by softening stays booked as that of its rupture.
void let_go(LinkSet<ConcreteLink>& set, const ConcreteLink& law, const std::vector<Index>& links) {
  with_number(set.precision, [&](auto number) {
    auto& kept = set.kept.as<decltype(number)>();
    const ConcreteLinks on_host = host_copy(set.arrays());
    change_array(set.broke, [&](std::vector<double>& broke) {
      for (const Index i : links) {
        const double opening = on_host.kept.as<decltype(number)>().opening.data()[i];
        if (opening < 0.0) continue;
        broke[static_cast<std::size_t>(i)] +=
            law.tension(on_host.constants(law, i, opening, 0.0)).spent(opening);
      }
    });
    change_array(kept.opening, [&](auto& opening) {
      for (const Index i : links)
        opening[static_cast<std::size_t>(i)] = static_cast<decltype(number)>(link_released);
    });
  });
}
void let_go(LinkSet<ParallelBond>& set, const ParallelBond&, const std::vector<Index>& links) {
  change_array(set.state, [&](std::vector<ParallelBondState>& state) {
    for (const Index i : links) {
      state[static_cast<std::size_t>(i)] = {};
      state[static_cast<std::size_t>(i)].bond = bond_released;
    }
  });
}
void let_go(LinkSet<InterfaceLink>& set, const InterfaceLink& law,
            const std::vector<Index>& links) {
  const InterfaceLinks on_host = host_copy(set.arrays());
  change_array(set.broke, [&](std::vector<double>& broke) {
    for (const Index i : links)
      broke[static_cast<std::size_t>(i)] +=
          law.spent(on_host.stiffness.data()[i], on_host.area.data()[i], on_host.state.data()[i]);
  });
  change_array(set.state, [&](std::vector<InterfaceState>& state) {
    for (const Index i : links)
      state[static_cast<std::size_t>(i)] = {0.0, link_released, 0.0, 0.0, 0.0, 0.0};
  });
}
template <class Law>
void let_go(LinkSet<Law>& set, const Law&, const std::vector<Index>&) {
  throw InputError(std::string("stage.remove: links of kind ") + set.name +
                   " join the body to another one, and cannot be taken out alone");
}

}  // namespace

void cut_off_removed(World& w) {
  std::vector<std::uint8_t> fixed;
  copy_to(fixed, w.elements.fixed);
  if (fixed.empty()) return;  // the whole, on a rank that keeps none of its state
  const auto gone = [&](Index e) { return is_gone(fixed[static_cast<std::size_t>(e)]); };
  change_array(w.elements.state, [&](std::vector<ElementState>& state) {
    for (std::size_t e = 0; e < state.size(); ++e)
      if (is_gone(fixed[e])) state[e].velocity = state[e].spin = {};
  });
  // Energy of contacts with them leaves, too; the next step's search drops them.
  const auto part = [&](auto& contacts, bool of_elements) {
    std::vector<Index> a, b;
    copy_to(a, contacts.pairs.a);
    copy_to(b, contacts.pairs.b);
    change_array(contacts.history.state, [&](std::vector<ContactState>& state) {
      for (std::size_t i = 0; i < state.size(); ++i)
        if (gone(a[i]) || (of_elements && gone(b[i]))) state[i] = {};
    });
  };
  part(w.contacts, true);
  part(w.wall_contacts, false);
  w.each_set([&](auto& set) {
    if (set.size() == 0) return;
    std::vector<Index> a, b;
    copy_to(a, set.a);
    copy_to(b, set.b);
    for (const auto& group : set.groups) {
      std::vector<Index> links;
      for (Index i = group.begin; i < group.end; ++i)
        if (gone(a[static_cast<std::size_t>(i)]) != gone(b[static_cast<std::size_t>(i)]))
          links.push_back(i);
      if (!links.empty()) let_go(set, group.law, links);
    }
  });
  // The next step searches.
  change_array(w.travel.reference, [&](auto& reference) {
    for (std::size_t e = 0; e < reference.size() && e < fixed.size(); ++e)
      if (is_gone(fixed[e])) reference[e] = {1e150, 0.0, 0.0};
  });
  w.graph.clear();
}

}  // namespace breccia::dem
