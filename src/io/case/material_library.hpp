#pragma once
// The materials that the program brings along: numbers with their sources (materials.toml).

#include <string>
#include <vector>

namespace breccia {

/// A macroscopic number of a material, as a laboratory measures it.
struct MaterialTarget {
  std::string name;    ///< young, poisson, compression, tension, brazilian, fracture_energy, ...
  double value = 0.0;  ///<  [SI]
  std::string unit;
};

/// A material's keys of [material.<name>] for a method.
struct MaterialBlock {
  std::string method;  ///< dem3d, fdem2d
  std::string record;  ///< how the local numbers among them were found
  std::string keys;    ///< lines of TOML
};

struct NamedMaterial {
  std::string name, title, source;
  std::vector<MaterialTarget> targets;
  std::vector<MaterialBlock> blocks;
};

/// All of them, in the order of the file.
const std::vector<NamedMaterial>& named_materials();

/// Null if there is none of this name.
const NamedMaterial* named_material(const std::string& name);

/// The unit of a target by its name; empty: there is none of this name.
std::string target_unit(const std::string& target);

}  // namespace breccia
