#pragma once
// Rock bolts: bars tied to elements, whose forces act on their corners as loads do. Written in
// pulling.hpp, made for each method in its bolts.cpp.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/case_config.hpp"
#include "core/probe.hpp"
#include "exec/buffer.hpp"
#include "fdem_shared/bolts/chain.hpp"
#include "fdem_shared/shape.hpp"

namespace breccia::fdem_shared {

/// Corners of a triangle, or of a tetrahedron.
template <class Vector>
inline constexpr std::size_t corners_of_element = std::is_same_v<Vector, Vec2> ? 3 : 4;

/// A node of a bolt in an element: constant shares of its corners tell where it is.
template <class Vector>
struct BoltPlaceOf {
  Index element;  ///< of the whole mesh  [-]
  std::array<double, corners_of_element<Vector>> share;
  Vector point{};  ///< at the start  [m]
};

/// Constants of a bolt.
template <class Vector>
struct BoltOf {
  std::string name;
  BoltLaw law;
  bool anchored[2] = {false, false};
  std::int32_t stage = 0;                   ///< it is there from this stage on  [-]
  std::vector<BoltPlaceOf<Vector>> places;  ///< of its nodes
};

/// Bolts of a run: the same on all ranks. @tparam Side  that bears a load
template <class Vector, class Side>
struct BoltStateOf {
  double time = -1.0;  ///< they are in balance with the positions then; below 0: none [s]
  Buffer<BoltNodeOf<Vector>> nodes;  ///< of all bolts, one after the other
  std::vector<Side> pull;            ///< on sides, by global id
};

/// Brings bolts into balance with the rock at the time of the world, and lists what they do to it:
/// the loads of `list_loaded(part)` have it from then on. All ranks call it in each step.
template <class World>
void pull_bolts(World& part);

/// How a node of a bolt is.
template <class Vector>
struct BoltRowOf {
  std::size_t bolt;
  Vector place;   ///<  [m]
  double force;   ///< of the segment that begins here; 0 at the end  [N; in 2D N/m]
  double across;  ///< likewise; in space its size  [N; in 2D N/m]
  double slip;    ///<  [m]
};
template <class World>
std::vector<BoltRowOf<typename ShapeOf<World>::Vector>> bolt_rows(const World& whole);

/// A segment of a bolt that is there, as frames show it.
template <class Vector>
struct BoltSegmentOf {
  std::size_t bolt;
  Vector begin, end;     ///<  [m]
  double force, across;  ///< likewise  [N; in 2D N/m]
  double slip;           ///< of its begin  [m]
};
/// All of them, on each rank. All ranks call it.
template <class World>
std::vector<BoltSegmentOf<typename ShapeOf<World>::Vector>> bolt_segments(const World& part);

/// Forces of a bolt's segments in the probe's box; none: the probe reads no bolt. On
/// ranks the first one reads it.
template <class World>
std::optional<Readings> read_bolt(const World& part, const ProbeConfig& probe);

/// Energies of a bolt: stored, spent by yield, rubbed off in its bond, spent across.
/// [J; in 2D J/m]
struct BoltEnergy {
  double elastic = 0.0, yielded = 0.0, rubbed = 0.0, crushed = 0.0;
};
template <class World>
std::vector<BoltEnergy> bolt_energies(const World& whole);

}  // namespace breccia::fdem_shared
