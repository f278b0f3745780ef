// The mesh part of Abaqus input files.

#include "exec/error.hpp"
#include "prepare/mesh_file.hpp"

namespace breccia::prepare {

Mesh parse_abaqus(std::string_view, const std::string& name) {
  throw InputError(name + ": Abaqus files cannot be read yet; allowed is .msh (Gmsh 4.1)");
}

}  // namespace breccia::prepare
