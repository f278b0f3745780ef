#pragma once
// Couples that act and damaged joints, listed on a device from step to step. A warp that takes 32
// of all items waits for those with more to do than others, each a long chain of its own.
//
// One launch holds two kernels. BusyWide gives each item that is listed several threads. NotListed
// looks at all others, one thread each: an item that asks for more than a look is evaluated by that
// thread, and listed for the steps to come if it is busy then. The sums of forces let
// what was listed in their step count (CountLists). A search lists anew. The order of a list
// changes from run to run, but each item writes only its own forces.

#include "core/kernel.hpp"
#include "core/select.hpp"
#include "exec/buffer.hpp"
#include "exec/for_each.hpp"
#include "fdem_shared/busy_items.hpp"

namespace breccia::fdem_shared {

/// Takes over what a search lists.
struct BeginList {
  static constexpr const char* name = "fdem.begin_list";
  View<const Index> first;
  View<Index> item;
  View<std::uint8_t> listed;
  BR_HD void operator()(Index k) const {
    item[k] = first[k];
    listed[first[k]] = 1;
  }
};

/// Lists, of so many items, those that a kernel calls busy.
template <class Busy>
void begin_list(const Exec& exec, KeptList& list, Index items, const Busy& busy) {
  const Buffer<Index> first = items_where(exec, items, busy);
  list.item.resize(items);
  list.listed.resize_unfilled(items);
  clear_bytes(list.listed.data(), exec.space, static_cast<std::size_t>(items));
  list.begun = first.size();
  copy_to(list.count, std::vector<Index>{list.begun, list.begun});
  for_each(exec, list.begun, BeginList{first.view(), list.item.view(), list.listed.view()});
}

/// A list for one step at a time.
inline void begin_empty(KeptList& list, Index items) {
  list.item.resize(items);
  copy_to(list.count, std::vector<Index>{0, 0});
}

/// The items that are not listed.
/// @tparam Busy  tells of an item that has been evaluated whether to list it
template <class Kernel, class Busy>
struct NotListed : Kernel {
  static constexpr int least_blocks = least_blocks_of<Kernel>();
  Busy busy;
  View<std::uint8_t> listed;
  View<Index> item, count;

  NotListed(const Kernel& of, const Busy& by, KeptList& list)
      : Kernel(of),
        busy(by),
        listed(list.listed.view()),
        item(list.item.view()),
        count(list.count.view()) {}

  struct Loaded {
    typename LoadedBy<Kernel>::Loaded of;
    std::uint8_t listed;
  };
  BR_HD void load_early(Index i, Loaded& loaded) const {
    loaded.listed = read_now(&listed[i]);
    Kernel::load_early(i, loaded.of);
  }
  BR_HD void load_late(Index i, Loaded& loaded) const { Kernel::load_late(i, loaded.of); }
  BR_HD bool update(Index i, const Loaded& loaded) const {
    return loaded.listed != 0 || Kernel::update(i, loaded.of);
  }
  BR_HD bool update_at(const StepTime& now, Index i, const Loaded& loaded) const {
    if (loaded.listed != 0) return true;
    if constexpr (requires { Kernel::update_at(now, i, loaded.of); })
      return Kernel::update_at(now, i, loaded.of);
    else
      return Kernel::update(i, loaded.of);
  }
  BR_HD void slow(Index i) const {
    Kernel::slow(i);
    if (!busy(i)) return;
    listed[i] = 1;
    item[place_at_end(count[1])] = i;
  }
};

/// The sums of forces that follow. A list for one step, whose second number is 0, is empty then.
template <class Sums>
struct CountLists : Sums {
  Index *couples, *joints;  ///< KeptList::count; null: no list

  template <class Read>
  BR_HD void update(Index i, const Read& loaded) const {
    count(i);
    Sums::update(i, loaded);
  }
  template <class Read, class Numbers>
  BR_HD void sum(Index i, const Read& loaded, Numbers& numbers) const {
    count(i);
    Sums::sum(i, loaded, numbers);
  }

 private:
  BR_HD void count(Index i) const {
    if (i == 0 && couples != nullptr) couples[0] = couples[1];
    if (i == 0 && joints != nullptr) joints[0] = joints[1];
  }
};

/// Groups of threads for a list: enough for what it held at the last search and what may come.
template <class Wide>
Index groups_for(const KeptList& list, Index items, Index most) {
  constexpr Index spare = 1024;
  return groups_of<Wide>(items, std::min(most, 2 * list.begun + spare));
}

}  // namespace breccia::fdem_shared
