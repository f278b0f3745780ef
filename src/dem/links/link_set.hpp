#pragma once
// Links of one law: their arrays, the groups of one material each, and how ranks number them.

#include <string>
#include <string_view>
#include <vector>

#include "core/energy.hpp"
#include "core/fields.hpp"
#include "core/kernel.hpp"
#include "dem/elements.hpp"
#include "dem/lanes/link_ends.hpp"
#include "dem/pair_forces.hpp"
#include "dem/setup/model.hpp"
#include "domain/domain.hpp"

namespace breccia::dem {

/// Elements that links join, a's global id below b's; written by set-up, and where elements change
/// places. No step reads or writes when links broke: rows of the history note it. One item a link.
struct LinkEnds {
  Buffer<Index> a, b;          ///< places in memory  [-]
  Buffer<double> seen_broken;  ///< when a row of the history first found it broken; below 0: not
                               ///< yet  [s]  (note_breaks)

  template <class Visit>
  void each_field(Visit&& field) {
    field("a", "-", a);
    field("b", "-", b);
    field("seen_broken", "s", seen_broken);
  }
  static bool older_files_lack(std::string_view array) { return array == "seen_broken"; }
  template <class Visit>
  void each_end(Visit&& visit) {
    visit("a", a);
    visit("b", b);
  }
  template <class Visit>
  void each_end(Visit&& visit) const {
    visit("a", a);
    visit("b", b);
  }
  Index size() const { return a.size(); }
};

/// The arrays of all links of a law: ends, constants, state, what they have spent. One item a link;
/// in brackets who writes it, in the words of World: constant (set-up alone) or pairs (its kernel
/// of forces); all of it moves with its link between ranks. One definition a law, with
///
///   kind, name             its LinkKind, and its word in files
///   swept                  whether the host sums its forces as they come (concrete alone)
///   each_field             visits the arrays; each_end, those of elements: LinkEnds, from which it
///                          derives, or more of them
///   broken(), released()   kernels: whether link i is broken, and whether it has let go of its
///                          ends, which may then touch as others do
template <class Law>
struct LinkArrays;

/// Neighbouring links of one material: one loop.
template <class Law>
struct LinkGroup {
  Law law;                    ///< (constant)
  Index begin = 0, end = 0;   ///< of its links here (set-up, ranks)
  std::int16_t material = 0;  ///< (constant)
  Buffer<Index> starts =
      Buffer<Index>();  ///< first link of each element a, and the end; swept on the host only
  Index first_number = 0, end_number = 0;  ///< of its links in the whole model; ranks only
  double bulk = 1.0;                       ///< Model::Bulk::factor of its bodies  [-]  (constant)
  double strength = 1.0;                   ///< Model::Link::strength of its links  [-]  (constant)
};

/// The laws of all groups where a device's kernels can read them, in the order of the groups;
/// filled by derive().
template <class Law>
struct GroupLaws {
  Buffer<Law> laws;
  Buffer<Index> ends;  ///< of each group; equal to the one before where a group has no link here

  template <class Form>
  const Buffer<Law>& as() const {
    static_assert(std::is_same_v<Form, Law>);
    return laws;
  }
};

/// The group of link i: the first that ends beyond it.
BR_HD inline Index group_of(const View<const Index>& ends, Index i) {
  Index group = 0;
  while (i >= read_now(&ends[group])) ++group;
  return group;
}

/// All links of a law.
template <class Law>
struct LinkSet : LinkArrays<Law> {
  std::vector<LinkGroup<Law>> groups;
  GroupLaws<Law> on_device;
  Buffer<Index> numbers;  ///< in the whole model, ascending; empty on one rank, which holds all

  LinkArrays<Law>& arrays() { return *this; }
  const LinkArrays<Law>& arrays() const { return *this; }
};

/// Arrays of the elements that kernels of links read.
struct ElementsView {
  View<const ElementState> state;
  View<const double> mass, inertia;

  BR_HD PairEnd<double> end(Index i) const {
    const ElementState& s = state[i];
    return {s.position, s.velocity, s.spin};
  }
  BR_HD double radius(Index i) const { return state[i].radius; }
};

/// Elements and time, as a kernel of forces needs them.
struct LinkSpace {
  ElementsView elements;
  double dt;          ///< the step that moved the elements to where they are  [s]
  std::int64_t step;  ///< steps taken before
  bool evaluates;     ///< as StepTime
};

/// Energies of one group of links.
/// @tparam Shares  a kernel with add_to(energies, law, link); with add_to<R>() for packs, too
template <class Law, class Shares>
struct GroupEnergies {
  Law law;
  Index first;
  Shares shares;
  View<const std::uint8_t> fixed;
  BR_HD void add_to(Energies& sum, Index k) const {
    const Index i = first + k;
    if (!is_gone(fixed[shares.a[i]])) return add(sum, i);
    Energies spent;
    add(spent, i);
    spent.elastic = ExactSum();  // it left with its element
    sum = sum + spent;
  }
  /// Of a pack of links. @returns whether none of them has left with its element
  template <class R>
  bool add_pack(EnergiesOf<R>& sum, Index k) const {
    for (Index j = 0; j < width_of<R>; ++j)
      if (is_gone(fixed[shares.a[first + k + j]])) return false;
    shares.template add_to<R>(sum, law, first + k);
    return true;
  }

 private:
  BR_HD void add(Energies& sum, Index i) const {
    if constexpr (requires { shares.template add_to<double>(sum, law, i); })
      shares.template add_to<double>(sum, law, i);
    else
      shares.add_to(sum, law, i);
  }
};

/// How far a link has gone, as pictures show it.
enum class LinkStage : std::uint8_t { whole, softened, broken };

}  // namespace breccia::dem
