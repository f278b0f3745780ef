#pragma once
// Sums of one of the four threads that add up for an element of a tile.

#include "dem/pair_forces.hpp"

namespace breccia::dem {

/// Two of an element's stiffnesses, of K and of ratio K (StiffnessSums); none in a step that does
/// not evaluate.
template <bool evaluates>
struct TwoStiffnesses {
  float straight[2], turning[2];

  /// @param part  which two of the eight
  template <class Stored>
  BR_HD static TwoStiffnesses of(const PairForceOf<Stored>& action, int part) {
    // Both at a time, where they lie so.
    struct alignas(sizeof(Stored) == 8 ? 8 : 4) Two {
      float first, second;
    };
    const Two two = reinterpret_cast<const Two*>(action.stiffness)[part];
    const float ratio = action.stiffness[8];
    return {{two.first, two.second}, {ratio * two.first, ratio * two.second}};
  }
  BR_HD void add(const TwoStiffnesses& other) {
    for (int k = 0; k < 2; ++k) {
      straight[k] += other.straight[k];
      turning[k] += other.turning[k];
    }
  }
};
template <>
struct TwoStiffnesses<false> {
  template <class Stored>
  BR_HD static TwoStiffnesses of(const PairForceOf<Stored>&, int) {
    return {};
  }
  BR_HD void add(const TwoStiffnesses&) {}
};

/// Of the actions on an element as one of two ends.
/// @tparam evaluates  as StepTime
template <bool evaluates>
struct PartSum {
  double first, second;  ///< torque on a, force on b; or force on b, torque on b
  TwoStiffnesses<evaluates> stiffness;
  BR_HD void add(const PartSum& other) {
    first += other.first;
    second += other.second;
    stiffness.add(other.stiffness);
  }
};
/// @param first  of the numbers: 0 to 2 for end a, 3 to 5 for b
template <bool evaluates, class Stored>
BR_HD inline PartSum<evaluates> part_of(const PairForceOf<Stored>& action, int first, int part) {
  return {action.numbers[first], action.numbers[first + 3],
          TwoStiffnesses<evaluates>::of(action, part)};
}

}  // namespace breccia::dem
