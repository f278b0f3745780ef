#pragma once
// Sums of forces and moves at one go: forces of an element stay in registers, its corners are read
// once. Elements of SummedApart are summed up before and moved by their force in memory.
//
// A step that another one follows at once leaves the sums to the move of that one
// (MovingRun::sum_up, ClockedRun::sum_forces); whoever reads Elements::force comes after a step
// that none follows.

#include "fdem_shared/motion.hpp"
#include "fdem_shared/shape.hpp"
#include "fdem_shared/summed_apart.hpp"

namespace breccia::fdem_shared {

/// Sums of those elements that are summed apart, by threads of their groups.
template <class Sums>
struct SumApart {
  static constexpr const char* name = Sums::name;
  Sums sums;
  View<const Index> group;
  Index elements;

  struct Loaded {
    typename Sums::template Loaded<double> of;
    Index element;  ///< -1: none
  };
  BR_HD void set(const StepTime& now) { sums.set(now); }
  BR_HD void load_early(Index i, Loaded& loaded) const {
    const Index t = apart_group * read_now(&group[i / apart_group]) + i % apart_group;
    loaded.element = t < elements ? t : -1;
    if (loaded.element >= 0) sums.load_early(t, loaded.of);
  }
  BR_HD void load_late(Index, Loaded& loaded) const {
    if (loaded.element >= 0) sums.load_late(loaded.element, loaded.of);
  }
  BR_HD void update(Index, const Loaded& loaded) const {
    if (loaded.element >= 0) sums.update(loaded.element, loaded.of);
  }
};
/// Sums of the others.
template <class Sums>
struct SumOthers {
  static constexpr const char* name = Sums::name;
  Sums sums;
  ApartView apart;

  struct Loaded {
    typename Sums::template Loaded<double> of;
    bool apart;
  };
  BR_HD void set(const StepTime& now) { sums.set(now); }
  BR_HD void load_early(Index t, Loaded& loaded) const {
    loaded.apart = apart(t);
    if (!loaded.apart) sums.load_early(t, loaded.of);
  }
  BR_HD void load_late(Index t, Loaded& loaded) const {
    if (!loaded.apart) sums.load_late(t, loaded.of);
  }
  BR_HD void update(Index t, const Loaded& loaded) const {
    if (!loaded.apart) sums.update(t, loaded.of);
  }
};

/// The sum of forces of each element and its move, or its move alone where it was summed up apart.
template <class Sums, class Move>
struct SumAndMove {
  static constexpr const char* name = "fdem.sum_and_move";
  static constexpr int least_blocks = 4;  ///< of a GPU's launch: a bound on its registers
  Sums sums;
  Move move;
  ApartView apart;

  template <class R>
  struct Loaded {
    typename Sums::template Loaded<R> sums;
    typename Move::template Loaded<R> move;
    bool apart;  ///< alike in a pack
  };
  BR_HD void set(const StepTime& now) {
    sums.set(now);
    move.set(now);
  }
  /// A pack that is computed in single precision loads part by part.
  template <class V>
  struct Loaded<SingleOf<V>> {};
  template <class R>
  BR_HD void load_early(Index t, Loaded<R>& loaded) const {
    if constexpr (!is_single<R>) {
      loaded.apart = apart(t);
      move.begin_loading(t, loaded.move);
      if (!loaded.apart) sums.load_own(t, loaded.sums);
      loaded.move.nodes.wait();
    }
  }
  template <class R>
  BR_HD void load_late(Index t, Loaded<R>& loaded) const {
    if constexpr (!is_single<R>) {
      if (loaded.apart)
        move.load_late(t, loaded.move);
      else
        sums.load_late(t, loaded.sums);
    }
  }
  template <class R>
  BR_HD Moved update(Index t, Loaded<R>& loaded) const {
    if constexpr (is_single<R>) {
      return update_parts<R>(t);
    } else {
      if (loaded.apart) {
        loaded.move.force.wait();
      } else {
        loaded.sums.nodes = loaded.move.nodes;
        sums.sum(t, loaded.sums, loaded.move.force.numbers);
      }
      return move.go(t, loaded.move);
    }
  }
  /// @returns whether the element has used its margin up
  BR_HD bool operator()(Index t) const { return run_at<double>(*this, t) == Moved::beyond; }

 private:
  template <class S>
  Moved update_parts(Index t) const {
    Moved moved = Moved::within;
    sums.template sum_parts<S>(
        t, [&, this]<class W, std::size_t count>(Index first, const W(&total)[count]) {
          typename Move::template Loaded<W> own;
          move.begin_loading(first, own);
          own.nodes.wait();
          for (std::size_t k = 0; k < count; ++k) own.force.numbers[k] = total[k];
          if (move.go(first, own) == Moved::beyond) moved = Moved::beyond;
        });
    return moved;
  }
};

}  // namespace breccia::fdem_shared
