#pragma once
// Constants that a case gives to a DEM run: written by set-up, read by all else.
//
// `stage` marks what configure() writes anew where a stage of the case begins, and after loading a
// checkpoint. Constants of single elements and links (mass, length, ...) lie beside their state,
// with which they migrate: dem/elements.hpp, dem/links/.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/gauge.hpp"
#include "core/output_config.hpp"
#include "dem/laws/contact.hpp"
#include "dem/setup/config.hpp"
#include "dem/wall_mesh.hpp"
#include "exec/buffer.hpp"
#include "math/mat3.hpp"

namespace breccia::dem {

/// A named set of elements that probes and servos read: a body or a support.
struct ElementSet {
  std::string name;
  Buffer<Index> members;  ///< global ids in the whole model, ascending  [-]
};

/// How the mass of a rigid wall is spread, in its own frame: along, normal x along, normal.
struct MassSpread {
  Vec3 offset{};                 ///< from the centre of mass to the wall's point  [m]
  Sym3 inertia{};                ///< about the centre of mass  [kg m2]
  Sym3 inverse{};                ///< of it  [1/(kg m2)]
  double least_mass = no_limit;  ///< that a push on any of its parts feels  [kg]
};

/// A wall with mass, which moves by the forces on it.
struct FreeWall {
  double mass = no_limit;  ///< infinite: it moves as it is told  [kg]
  Vec3 normal{};           ///< unit; it moves along this only, unless it is zero  [-]
  Vec3 axes{};             ///< 1 along axes in which it moves, if it has no normal  [-]
  std::array<ScaledAmplitude, 3> load;  ///< stage; given force over time  [N]
  bool turns = false;                   ///< by the torques on it, too
  MassSpread spread;                    ///< if it turns

  bool is_free() const { return mass < no_limit; }
  /// The part of a force or velocity in directions in which it moves.
  Vec3 allowed(const Vec3& of) const {
    if (dot(normal, normal) > 0.0) return dot(of, normal) * normal;
    return {axes.x * of.x, axes.y * of.y, axes.z * of.z};
  }
  Vec3 load_at(double time) const {
    const auto part = [&](const ScaledAmplitude& of) { return of.scale * of.amplitude.at(time); };
    return {part(load[0]), part(load[1]), part(load[2])};
  }
};

/// How a wall turns that a table tells.
struct WallSpin {
  std::array<ScaledAmplitude, 3> about;  ///< x, y, z  [rad/s]

  Vec3 at(double time) const {
    const auto part = [&](const ScaledAmplitude& of) { return of.scale * of.amplitude.at(time); };
    return {part(about[0]), part(about[1]), part(about[2])};
  }
};

/// Surfaces of walls of triangles, side by side.
struct WallMeshes {
  /// Nodes of a wall's tree; none: it is no mesh.
  struct Part {
    Index first = 0, last = 0;
    Index first_triangle = 0, last_triangle = 0;
    bool closed = false;
  };
  std::vector<Part> parts;         ///< empty: no wall is a mesh  (walls)
  Buffer<MeshNode> nodes;          ///< (nodes)
  Buffer<MeshTriangle> triangles;  ///< (triangles)
  Buffer<Index> starts;            ///< first end at each vertex, and the end  [-]  (vertices + 1)
  Buffer<Vec3> ends;               ///< other ends of edges, vertex by vertex  [m]  (ends)
  Buffer<Vec3> out;                ///< out of the surface  [-]  (vertices)
};

struct Case {
  TimeConfig time;
  SearchConfig search;
  Vec3 gravity{};                  ///< stage  [m/s2]
  double local_damping = 0.0;      ///< stage  [-]
  double mean_radius = 0.0;        ///< of all elements  [m]
  double largest_margin = 0.0;     ///< half the smallest radius of linked concrete  [m]
  ContactLaw contact{};            ///< stage: its friction
  double contact_step = no_limit;  ///< stage; that resolves a contact of two like elements  [s]
  double first_contact_step = no_limit;  ///< likewise, as the case begins  [s]
  std::vector<double> first_young;       ///< as the case begins  [Pa]  (materials)
  Index materials = 0;                   ///< how many there are  [-]
  std::vector<std::uint8_t> bars;        ///< 1: its elements are bars  [-]  (materials)
  std::vector<double> densities;         ///< of bodies  [kg/m3]  (materials)
  MoreFields shown;                      ///< in frames
  EmissionConfig emission;               ///< which breaks are one event

  std::vector<std::string> warnings;  ///< what set-up found doubtful, for people
  std::vector<ElementSet> sets;       ///< bodies, then supports
  std::vector<ElementSet> tied;       ///< members of supports that links join to others; none
                                      ///< where no servo moves it  (supports)
  std::vector<std::uint8_t> removed;  ///< stage; 1: taken out by now  (bodies)
  std::vector<std::string> wall_names;
  std::vector<Vec3> wall_starts;      ///< points of walls at the start  [m]  (walls)
  std::vector<double> wall_friction;  ///< stage; below 0: that of all contacts  [-]  (walls)
  std::vector<WallSpin> wall_spins;   ///< stage; empty: none changes between stages  (walls)
  std::vector<FreeWall> free_walls;   ///< empty: none has mass  (walls)
  std::vector<Vec3> dashpots;  ///< of absorbing supports over the square of an element's radius, of
                               ///< others 0  [kg/(s m2)]  (supports)
  std::vector<double> masses;  ///< of supports' elements together  [kg]  (supports)
  WallMeshes meshes;           ///< of walls of triangles
  Buffer<ContactPair> contact_pairs;  ///< stage; of materials p, q at p materials + q (materials^2)
  Buffer<ContactPair> wall_pairs;     ///< stage; of a material with a wall  (materials)

  Buffer<Vec3> starts;  ///< places at the start, by global id; empty: nothing needs them
                        ///< [m]  (elements of the whole model)
  std::vector<ProbeFit> strain_fits;  ///< of probes of strain

  /// Visits the arrays that kernels read.
  template <class Visit>
  void each_array(Visit&& visit) {
    visit(contact_pairs), visit(wall_pairs), visit(starts);
    visit(meshes.nodes), visit(meshes.triangles);
    visit(meshes.starts), visit(meshes.ends), visit(meshes.out);
  }
};

}  // namespace breccia::dem
