#pragma once
// A bolt: a bar of segments whose nodes a bond ties to the rock. It knows no triangles.

#include <cstddef>
#include <vector>

#include "fdem/bolts/dowel.hpp"

namespace breccia::fdem {

/// Constants of a bolt and its bond, per unit thickness.
struct BoltLaw {
  double stiffness = 0.0;       ///< E A  [N/m]
  double yield = 0.0;           ///< f_y A  [N/m]
  double bond_stiffness = 0.0;  ///< of a length of it  [N/m3]
  double bond_strength = 0.0;   ///< of a length of it  [N/m2]
  Dowel dowel{};                ///< what it bears across
};

/// A node of a bolt, and the segment from it to the next node of the same bolt.
struct BoltNode {
  double slip = 0.0;     ///< s: of the bar against the rock, along the bar  [m]
  double slid = 0.0;     ///< r: the part of it that stays  [m]
  double strain = 0.0;   ///< p: the part of the segment's strain that stays  [-]
  double rest = 0.0;     ///< L0: length of the segment without force; 0: it is not there yet  [m]
  double yielded = 0.0;  ///< work that the segment's yielding took  [J/m]
  double rubbed = 0.0;   ///< work that the bond's slip took  [J/m]
  double force = 0.0;    ///< N of the segment, pulled above 0  [N/m]
  double across = 0.0;   ///< Q of the segment  [N/m]
  double sheared = 0.0;  ///< the part of its offset that stays  [m]
  double crushed = 0.0;  ///< work that that took  [J/m]
  /// The segment as it came, along edges 0 to 1 and 0 to 2 of the triangle where it begins, and of
  /// the one where it ends.  [-]
  Vec2 begin{}, end{};
};

/// The nodes of one bolt. With the distances L_j of the rock's points
///
///   N_j = E A ((L_j + s_j+1 - s_j)/L0_j - 1 - p_j)    |N_j| <= f_y A         segment j
///   q_i = k l_i (s_i - r_i)                           |q_i| <= t l_i         bond at node i
///   N_i - N_i-1 = q_i                                 balance of the bar; s_i = 0 where it is
///   anchored
///
/// with half of both segments as l_i. The bar has no mass of its own: it is in balance at any time.
/// Strain beyond the yield goes into p, slip beyond the bond into r. Rock feels N_i t_i - N_i-1
/// t_i-1 at node i, with the directions t of the segments: what the bar does to it has neither a
/// sum nor a moment. What it bears across: dowel.hpp.
class BoltChain {
 public:
  /// @param length  L_j of each segment, one less than the nodes
  BoltChain(const BoltLaw& law, bool starts_anchored, bool ends_anchored, BoltNode* nodes,
            const std::vector<double>& length)
      : law_(law), anchored_{starts_anchored, ends_anchored}, nodes_(nodes), length_(length) {}

  /// Finds the slips of balance, and keeps what yields and slips.
  void settle();
  /// N of a segment, pulled above 0.  [N/m]
  double force(std::size_t segment) const;
  /// Elastic energy of bar and bond.  [J/m]
  double elastic() const;

 private:
  std::size_t nodes() const { return length_.size() + 1; }
  bool is_anchored(std::size_t i) const {
    return (i == 0 && anchored_[0]) || (i + 1 == nodes() && anchored_[1]);
  }
  double share(std::size_t i) const;
  double elastic_force(std::size_t segment) const;
  double elastic_bond(std::size_t i) const;
  double bond(std::size_t i) const;
  double missing_at(std::size_t i) const;
  double most_missing() const;
  void step_all();
  void step_one(std::size_t i);
  void keep();

  const BoltLaw& law_;
  bool anchored_[2];
  BoltNode* nodes_;
  const std::vector<double>& length_;
};

}  // namespace breccia::fdem
