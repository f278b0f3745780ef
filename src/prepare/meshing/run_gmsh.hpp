#pragma once
// The program gmsh, which runs beside Breccia and is never a part of it.

#include <cstdint>
#include <string>

namespace breccia::prepare {

/// A folder that goes when its owner does.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  std::string file(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

struct GmshTask {
  std::string geo;     ///< file in the language of gmsh
  std::string what{};  ///< what messages call it
  double edge = 0.0;   ///< no edge is longer; 0: what the file says  [m]
  std::int64_t seed = 1;
  int dimension = 2;
  std::string program = "gmsh";
};

/// Lets gmsh make a mesh, on one thread and without settings of the user.
/// @param folder  for its files
/// @returns the mesh, a binary file of version 4.1
/// @throws InputError if gmsh is not installed, or what it says if it fails
std::string run_gmsh(const GmshTask& task, const TemporaryFolder& folder);

/// Where a program is that the shell would start; empty: nowhere.
std::string on_path(const std::string& program);

/// Error that says which program makes a mesh and is not installed. @param what  whose mesh
std::string no_mesher(const std::string& what, const std::string& program = "gmsh");

}  // namespace breccia::prepare
