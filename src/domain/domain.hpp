#pragma once
// A rank's share of a model: what it owns, what it holds ghosts of, and what it asks the others.

#include <algorithm>
#include <string>

#include "core/case_config.hpp"
#include "domain/halo.hpp"
#include "domain/pace.hpp"
#include "domain/partition.hpp"
#include "domain/sharing_sets.hpp"
#include "domain/together.hpp"

namespace breccia {

/// How a rank fared: for scaling tables.
struct DomainCounts {
  std::int64_t migrations = 0;  ///< times that elements were shared out anew
  std::int64_t cuts = 0;        ///< of them with new borders
  std::int64_t moved = 0;       ///< elements that came to this rank from another owner
  std::int64_t ghosts = 0;      ///< elements of others that it holds now
  std::int64_t owned = 0;       ///< elements of its own, now
  std::int64_t load = 0;        ///< when they were shared out last  [-]
  std::int64_t weighed = 0;     ///< the load times the rank's pace  [-]
};
/// Counts of all ranks together.
struct DomainFacts {
  int ranks = 1;
  std::int64_t migrations = 0, cuts = 0, moved = 0;
  double ghosts = 0.0;     ///< over all elements  [-]
  double imbalance = 0.0;  ///< largest load, by paces, over the mean, less one  [-]
  double waited_least = 0.0, waited_mean = 0.0, waited_most = 0.0;  ///< of a rank, for others  [s]
};
/// @param waited  by this rank for others  [s]
DomainFacts domain_facts(Communicator& ranks, const DomainCounts& own, double waited);

/// Which elements a rank owns, as kernels see it.
struct OwnedView {
  View<const std::uint8_t> owned;  ///< none: all of them
  BR_HD bool operator()(Index element) const { return owned.size == 0 || owned[element] != 0; }
};

/// Elements [begin, end).
struct ElementRun {
  Index begin = 0, end = 0;
};

/// The decomposition as a method sees it. A world on one rank has none: it is alone, owns all, and
/// every question is answered by its own numbers.
struct Domain {
  Communicator* ranks = nullptr;  ///< null: alone
  DomainConfig config;
  Partition partition;
  double buffer = 0.0;         ///< how far an element goes before they are shared out anew  [m]
  double margin = 0.0;         ///< largest of the search that ghosts are held for  [m]
  Buffer<std::uint8_t> owned;  ///< 1: this rank owns the element; empty when alone; on the host
  Buffer<std::uint8_t> owned_there;  ///< `owned` where kernels can read it
  Buffer<Vec3>
      migration_reference;   ///< where each stood when they were shared out last; likewise  [m]
  SharingSets sharing_sets;  ///< then
  std::vector<Sphere> migration_reference_spheres;  ///< then: around each element, on the host
  std::int64_t mean_load = 0;                       ///< then, of all ranks  [-]
  std::vector<Ghost> ghosts;                        ///< of others' elements that this rank holds
  Halo halo;                                        ///< of all ghosts
  /// Ghosts that own elements interact with: that must follow their owners in every step. The
  /// others do before a search.
  Halo active_ghosts;
  bool ghosts_selected = false;    ///< otherwise all are taken to be
  std::vector<std::uint8_t> tied;  ///< 1: active as long as elements are not shared out anew
  Vec3 drifted;                    ///< common way of all elements since then  [m]
  double drifted_until = 0.0;      ///< time up to which it is counted  [s]
  std::vector<ElementRun>
      runs;  ///< of elements that loops over own ones take, few ghosts among them
  /// `runs` in two parts: elements that other ranks hold as active ghosts, and all other ones.
  std::vector<ElementRun> boundary_runs, interior_runs;
  DomainCounts counts;
  Pace pace;

  bool single_rank() const { return ranks == nullptr; }
  bool owns(Index element) const { return single_rank() || owned.data()[element] != 0; }

  /// While elements are shared out: calls visit(rank) for each rank that needs the one there.
  template <class Visit>
  void each_sharer(const Sphere& element, const Visit& visit) const {
    sharing_sets.each_sharer(partition, element, sharing_sets.buffer(element.radius), visit);
  }

  OwnedView owned_view() const { return {owned_there.view()}; }

  double least(double value) const { return single_rank() ? value : ranks->least(value); }
  bool any(bool one) const { return single_rank() ? one : ranks->any_of(one ? 1 : 0) != 0; }

  /// Updates ghosts from their owners (active ghosts only, once they are selected). Between start
  /// and finish only reductions may be called; ghosts must not be read.
  template <class T>
  void start_refresh(const Exec& exec, Buffer<T>& items) {
    if (!single_rank()) (ghosts_selected ? active_ghosts : halo).start(exec, *ranks, items);
  }
  template <class T>
  void finish_refresh(const Exec& exec, Buffer<T>& items) {
    if (!single_rank()) (ghosts_selected ? active_ghosts : halo).finish(exec, items);
  }
  template <class T>
  void refresh_all(const Exec& exec, Buffer<T>& items) {
    if (!single_rank() && ghosts_selected) halo.refresh(exec, *ranks, items);
  }
  /// Selects the active ghosts: tied ones, and the ends of pairs. Only on the host.
  void select_active_ghosts(const Buffer<GlobalId>& ids, const Buffer<Index>& a,
                            const Buffer<Index>& b);

  /// All elements move together, as far as they are watched, with this velocity until that time.
  void drift(const Vec3& velocity, double until) {
    drifted += (until - drifted_until) * velocity;
    drifted_until = until;
  }

  /// Calls visit(begin, end) for the parts of [begin, end) that lie in one of the lists of runs.
  template <class Visit>
  static void each_run_of(const std::vector<ElementRun>& runs, Index begin, Index end,
                          const Visit& visit) {
    auto run = std::partition_point(runs.begin(), runs.end(),
                                    [begin](const ElementRun& r) { return r.end <= begin; });
    for (; run != runs.end() && run->begin < end; ++run)
      visit(std::max(begin, run->begin), std::min(end, run->end));
  }
};

}  // namespace breccia
