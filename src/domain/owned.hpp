#pragma once
// Loops over the items of this rank: they pass over those of ghosts, of which kernels know nothing.
//
// An item belongs to the rank that owns its element: the item itself, or the one that a functor
// names, such as the first element of a pair.

#include "domain/domain.hpp"
#include "exec/for_each.hpp"

namespace breccia {

/// Items that are elements.
struct ItemItself {
  BR_HD Index operator()(Index i) const { return i; }
};
/// The element that is listed for each item.
/// @tparam share  numbers that an element has in the list: its corners or sides; 1: one
template <Index share = 1>
struct ListedElement {
  View<const Index> listed;
  Index first = 0;  ///< place of item 0 in the list
  BR_HD Index operator()(Index i) const { return listed[first + i] / share; }
};
/// Elements of the members of a set, or of all items.
template <Index share = 1>
struct MemberElement {
  View<const Index> members;  ///< empty: all items
  BR_HD Index operator()(Index i) const { return (members.size > 0 ? members[i] : i) / share; }
};
/// The element that is listed for each of a selection of items.
struct SelectedElement {
  View<const Index> selected, listed;
  BR_HD Index operator()(Index k) const { return listed[selected[k]]; }
};

/// A kernel of a fold that finds `neutral` in items of ghosts.
template <class Value, class Kernel, class ElementOf>
struct FoldOwned {
  OwnedView owned;
  ElementOf element_of;
  Value neutral;
  Kernel kernel;
  BR_HD Value operator()(Index i) const { return owned(element_of(i)) ? kernel(i) : neutral; }
};
/// A kernel with add_to() that adds nothing for items of ghosts.
template <class Kernel, class ElementOf>
struct AddOwned {
  OwnedView owned;
  ElementOf element_of;
  Kernel kernel;
  template <class Value>
  BR_HD void add_to(Value& value, Index i) const {
    if (owned(element_of(i))) kernel.add_to(value, i);
  }
  /// Of items [begin, end), where the kernel can add several at once.
  template <class Value>
  void add_run(Value& value, Index begin, Index end) const requires requires {
    kernel.add_run(value, begin, end);
  }
  {
    if (owned.owned.size == 0) return kernel.add_run(value, begin, end);
    for (Index i = begin; i < end; ++i) add_to(value, i);
  }
};
/// The items of a kernel whose elements this rank owns, for fold, FoldSum and items_where.
/// @param neutral  what an item of a ghost counts as
template <class Value, class Kernel, class ElementOf = ItemItself>
auto of_owned(const Domain& domain, const Value& neutral, const Kernel& kernel,
              const ElementOf& element_of = {}) {
  if constexpr (requires(Value & value) { kernel.add_to(value, Index{}); })
    return AddOwned<Kernel, ElementOf>{domain.owned_view(), element_of, kernel};
  else
    return FoldOwned<Value, Kernel, ElementOf>{domain.owned_view(), element_of, neutral, kernel};
}

/// A condition on pairs that also asks for one element at least that this rank owns.
template <class Kernel>
struct EitherOwned {
  OwnedView owned;
  View<const Index> a, b;
  Kernel kernel;
  BR_HD bool operator()(Index i) const { return (owned(a[i]) || owned(b[i])) && kernel(i); }
};
template <class Kernel>
EitherOwned<Kernel> of_either_owned(const Domain& domain, View<const Index> a, View<const Index> b,
                                    const Kernel& kernel) {
  return {domain.owned_view(), a, b, kernel};
}

/// A kernel that does nothing for items of ghosts.
template <class Kernel, class ElementOf>
struct ForOwned {
  OwnedView owned;
  ElementOf element_of;
  Kernel kernel;
  BR_HD void operator()(Index i) const {
    if (owned(element_of(i))) kernel(i);
  }
};

#if defined(BR_CUDA) && !defined(__CUDACC__)
inline namespace host_loops {
#else
inline namespace loops {
#endif

/// for_each() over the items whose elements this rank owns.
template <class Kernel, class ElementOf = ItemItself>
void for_each_owned(const Exec& exec, const Domain& domain, Index count, const Kernel& kernel,
                    const ElementOf& element_of = {}) {
  for_each(exec, count, ForOwned<Kernel, ElementOf>{domain.owned_view(), element_of, kernel});
}

/// fold_later() over the items whose elements this rank owns.
template <class Value, class Kernel, class Combine, class ElementOf = ItemItself>
Later<Value> fold_owned_later(const Exec& exec, const Domain& domain, Index count,
                              const Value& neutral, const Kernel& kernel, const Combine& combine,
                              const ElementOf& element_of = {}) {
  return fold_later(exec, count, neutral, of_owned(domain, neutral, kernel, element_of), combine);
}
/// fold() over the items whose elements this rank owns.
template <class Value, class Kernel, class Combine, class ElementOf = ItemItself>
Value fold_owned(const Exec& exec, const Domain& domain, Index count, const Value& neutral,
                 const Kernel& kernel, const Combine& combine, const ElementOf& element_of = {}) {
  return fold_owned_later(exec, domain, count, neutral, kernel, combine, element_of).value();
}

}  // namespace loops
}  // namespace breccia
