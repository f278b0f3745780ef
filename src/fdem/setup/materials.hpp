#pragma once
// From what a case says of materials to what kernels read.

#include "fdem/case.hpp"
#include "fdem/contact/couples.hpp"
#include "fdem/joints/joints.hpp"
#include "fdem/setup/config.hpp"

namespace breccia::fdem {

/// Each two have laws of their own: so many have 1.2 GB of them.
inline constexpr std::size_t most_materials = 4000;

/// Laws of joints, and which one joins two materials.
struct BondTable {
  std::vector<JointBond> bonds;
  std::vector<Index> of_pair;   ///< at a * materials + b: index into bonds, or a reason below
  std::vector<Index> of_joint;  ///< of each [joint.<name>]
  std::vector<bool> dormant;    ///< of each material: its joints appear where they are needed
  static constexpr Index nothing = -1, bonded = -2;
};

/// One material: its own strength. Two: that of the [joint.<name>] between them, or else the weaker
/// one in each respect. A material without joints is bonded to itself and joined to no other unless
/// a [joint.<name>] says so. @throws InputError for names that do not exist
BondTable bond_table(const Config& config);

/// Bonds with the strengths of a table instead of their own.
/// @param base  of each bond: the one of the table that it was made of; empty: itself
std::vector<JointBond> with_strengths(std::vector<JointBond> bonds, const BondTable& table,
                                      const std::vector<Index>& base);

/// Whether joints between two materials that fail with the rock have bonds of their own by their
/// directions: of bedded rock the stress along an edge depends on it.
bool depends_on_line(const Config& config, const MaterialConfig& a, const MaterialConfig& b);
/// The bond of such a joint along a line.
JointBond bond_along(const Config& config, const MaterialConfig& a, const MaterialConfig& b,
                     const JointBond& bond, const Vec2& line);

/// @throws InputError for names that do not exist
std::vector<ContactPair> contact_table(const Config& config);

/// @throws InputError where plane strain meets a Poisson's ratio of 0.5 or more, and for bedded
/// rock that cannot be
std::vector<ElasticTriangle> elastic_table(const Config& config);
/// The laws of a run: of materials, or, where stress in situ has a slope, of each triangle, which
/// bears the stress at its middle.
std::vector<ElasticTriangle> elastic_laws(const Config& config, const Case& given);

/// Index of a material. @throws InputError saying where the name was used
std::int16_t material_index(const Config& config, const std::string& name,
                            const std::string& where);

}  // namespace breccia::fdem
