#include "bench/tiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/set_up.hpp"
#include "dem/ranks.hpp"
#include "fdem/ranks.hpp"
#include "prepare/build.hpp"
#include "prepare/build_fdem.hpp"

namespace breccia {
namespace {

Exec on_host(Exec exec) {
  exec.space = Space::host;
  return exec;
}

/// Places in the tiles of a rank become global ids.
void number_elements(dem::World& w, Index first) {
  for (GlobalId& id : w.elements.id.host()) id += first;
  const PairKey both = (static_cast<PairKey>(first) << 32) | static_cast<std::uint32_t>(first);
  for (PairKey& key : w.contacts.pairs.key.host()) key += both;
}

/// Links of a law in each tile, and so in all.
template <class Law>
void number_links(std::vector<dem::LinkGroup<Law>>& groups, Buffer<Index>& numbers,
                  const TileRun& tiles, int built) {
  if (groups.empty()) return;  // a kind that slabs lack
  BR_ASSERT(groups.size() == 1);
  const Index each = groups[0].end / built;
  groups[0].first_number = 0;
  groups[0].end_number = tiles.count * each;
  numbers.resize(groups[0].end);
  std::iota(numbers.host().begin(), numbers.host().end(), tiles.first * each);
}

/// Where the triangles of one tile that touch a side lie, and which vertex of the next tile is one
/// of this tile's.
class PlateTile {
 public:
  static constexpr double edge = 1e-3;  ///< of a triangle  [m]

  explicit PlateTile(Index triangles) {
    const double high = 0.5 * std::sqrt(3.0) * edge;
    const double rows = 2.0 * std::max(1.0, std::round(std::sqrt(triangles / std::sqrt(3.0)) / 2));
    const double columns = std::max(1.0, std::round(rows * high / edge));
    size_ = {columns * edge, rows * high};
    fdem::BodyConfig body;
    body.name = "plate";
    body.material = "rock";
    body.shape = "plate";
    body.structured = true;
    body.mesh_size = edge;
    body.size = size_;
    body.velocity = {0.3, 1.0};
    model_ = build_fdem_model({body}, {}, {{"rock"}, {}}, 1, "");
    const auto by_x = [](const Vec2& p) { return p.x; };
    const auto by_y = [](const Vec2& p) { return p.y; };
    match(left, right, by_x, by_y);
    match(below, above, by_y, by_x);
  }

  enum Side { left, right, below, above };

  const fdem::Model& model() const { return model_; }
  const Vec2& size() const { return size_; }
  Index triangles() const { return model_.size(); }
  Index vertices() const { return static_cast<Index>(model_.point.size()); }
  /// Vertices on a side, from one of its ends to the other.
  const std::vector<Index>& side(Side s) const { return side_[s]; }
  bool lies_on(Side s, Index vertex) const { return place_[s][at(vertex)] >= 0; }
  /// Number of this vertex in the next tile to the left, or below.
  Index beyond(Side s, Index vertex) const { return side_[s + 1][at(place_[s][at(vertex)])]; }
  /// Triangles with a corner on a side.
  std::vector<Index> triangles_at(Side s) const {
    std::vector<Index> found;
    for (Index t = 0; t < triangles(); ++t) {
      const auto& corners = model_.triangle[at(t)];
      if (std::any_of(corners.begin(), corners.end(), [&](Index v) { return lies_on(s, v); }))
        found.push_back(t);
    }
    return found;
  }

 private:
  /// Lists the vertices of two sides that fall together in neighbouring tiles.
  template <class Across, class Along>
  void match(Side low, Side high, const Across& across, const Along& along) {
    const auto [least, most] =
        std::minmax_element(model_.point.begin(), model_.point.end(),
                            [&](const Vec2& p, const Vec2& q) { return across(p) < across(q); });
    for (const auto& [s, where] :
         {std::pair{low, across(*least)}, std::pair{high, across(*most)}}) {
      for (Index v = 0; v < vertices(); ++v)
        if (across(model_.point[at(v)]) == where) side_[s].push_back(v);
      std::sort(side_[s].begin(), side_[s].end(), [&](Index p, Index q) {
        return along(model_.point[at(p)]) < along(model_.point[at(q)]);
      });
      place_[s].assign(model_.point.size(), -1);
      for (std::size_t i = 0; i < side_[s].size(); ++i)
        place_[s][at(side_[s][i])] = static_cast<Index>(i);
    }
    BR_ASSERT(side_[low].size() == side_[high].size());
  }

  fdem::Model model_;
  Vec2 size_;  ///<  [m]
  std::array<std::vector<Index>, 4> side_, place_;
};

/// The plate's numbers: tile by tile, row by row. A vertex on a side belongs to the tile to its
/// left, or below.
class Plate {
 public:
  explicit Plate(const PlateTiles& tiles) : tiles_(tiles), tile_(tiles.triangles) {}

  const PlateTile& tile() const { return tile_; }
  int count() const { return tiles_.columns * tiles_.rows; }
  Index vertices() const { return count() * tile_.vertices(); }

  Index vertex(int tile, Index v) const {
    int column = tile % tiles_.columns, row = tile / tiles_.columns;
    if (column > 0 && tile_.lies_on(PlateTile::left, v)) {
      v = tile_.beyond(PlateTile::left, v);
      --column;
    }
    if (row > 0 && tile_.lies_on(PlateTile::below, v)) {
      v = tile_.beyond(PlateTile::below, v);
      --row;
    }
    return (row * tiles_.columns + column) * tile_.vertices() + v;
  }
  Vec2 place(Index vertex) const {
    const Index tile = vertex / tile_.vertices();
    const Vec2 shift{tile % tiles_.columns * tile_.size().x,
                     tile / tiles_.columns * tile_.size().y};
    return tile_.model().point[at(vertex % tile_.vertices())] + shift;
  }

  /// Triangles of some tiles, and those of others across their sides; ascending.
  std::vector<Index> triangles_of(const TileRun& run) const {
    const Index each = tile_.triangles();
    std::vector<Index> all;
    std::array<std::vector<Index>, 4> near;
    for (const auto s : {PlateTile::left, PlateTile::right, PlateTile::below, PlateTile::above})
      near[s] = tile_.triangles_at(s);
    const auto add = [&](bool there, int tile, PlateTile::Side side_there) {
      if (!there || (tile >= run.first && tile < run.last)) return;
      for (const Index t : near[side_there]) all.push_back(tile * each + t);
    };
    for (int tile = run.first; tile < run.last; ++tile) {
      const int column = tile % tiles_.columns, row = tile / tiles_.columns;
      add(column > 0, tile - 1, PlateTile::right);
      add(column + 1 < tiles_.columns, tile + 1, PlateTile::left);
      add(row > 0, tile - tiles_.columns, PlateTile::above);
      add(row + 1 < tiles_.rows, tile + tiles_.columns, PlateTile::below);
    }
    for (Index t = run.first * each; t < run.last * each; ++t) all.push_back(t);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  /// World::open_vertex of the whole: 1 at the rim.
  std::vector<std::uint8_t> rim() const {
    std::vector<std::uint8_t> open(at(vertices()), 0);
    const auto mark = [&](bool at_rim, int tile, PlateTile::Side side) {
      if (!at_rim) return;
      for (const Index v : tile_.side(side)) open[at(vertex(tile, v))] = 1;
    };
    for (int tile = 0; tile < count(); ++tile) {
      const int column = tile % tiles_.columns, row = tile / tiles_.columns;
      mark(column == 0, tile, PlateTile::left);
      mark(column + 1 == tiles_.columns, tile, PlateTile::right);
      mark(row == 0, tile, PlateTile::below);
      mark(row + 1 == tiles_.rows, tile, PlateTile::above);
    }
    return open;
  }

  /// Which corners of a triangle are held, as bits.
  Index held(Index triangle) const {
    const Index tile = triangle / tile_.triangles();
    if (tile >= tiles_.columns) return 0;
    Index bits = 0;
    const auto& corners = tile_.model().triangle[at(triangle % tile_.triangles())];
    for (int k = 0; k < 3; ++k)
      if (tile_.lies_on(PlateTile::below, corners[static_cast<std::size_t>(k)])) bits |= 1 << k;
    return bits;
  }

 private:
  PlateTiles tiles_;
  PlateTile tile_;
};

/// A model of some triangles, whose vertices are numbered by themselves.
struct PlatePart {
  fdem::Model model;
  std::vector<Index> vertex;  ///< of the plate, for each of the model's
};
PlatePart part_of(const Plate& plate, const std::vector<Index>& triangles) {
  PlatePart part;
  fdem::Model& m = part.model;
  const fdem::Model& tile = plate.tile().model();
  std::vector<Index> here(at(plate.vertices()), -1);
  m.groups = tile.groups;
  for (const Index t : triangles) {
    std::array<Index, 3> corners = tile.triangle[at(t % tile.size())];
    for (Index& corner : corners) {
      const Index vertex = plate.vertex(t / tile.size(), corner);
      Index& number = here[at(vertex)];
      if (number < 0) {
        number = static_cast<Index>(m.point.size());
        m.point.push_back(plate.place(vertex));
        part.vertex.push_back(vertex);
      }
      corner = number;
    }
    m.triangle.push_back(corners);
  }
  m.group.assign(triangles.size(), 0);
  m.material.assign(triangles.size(), 0);
  m.velocity.assign(triangles.size(), tile.velocity[0]);
  m.strength.assign(triangles.size(), 1.0F);
  return part;
}

/// Holds by the bits of the corners that they hold, the same on all ranks.
void hold_below(fdem::World& w, const Plate& plate, const std::vector<Index>& triangles) {
  std::vector<fdem::Hold> holds(8);
  for (unsigned bits = 0; bits < 8; ++bits)
    for (unsigned k = 0; k < 3; ++k)
      if ((bits >> k & 1) != 0) holds[bits].fixed |= static_cast<std::uint8_t>(3U << (2 * k));
  std::vector<Index> hold;
  for (const Index t : triangles) {
    const Index bits = plate.held(t);
    hold.push_back(bits == 0 ? -1 : bits);
  }
  copy_to(w.given.change(SetUp{}).holds, holds);
  copy_to(w.triangles.hold, hold);
}

/// Numbers of a part become those of the plate. Couples at the part's own rim are none of it.
void number_triangles(fdem::World& w, const Plate& plate, const std::vector<Index>& triangles,
                      const std::vector<Index>& vertex) {
  copy_to(w.triangles.id, triangles);
  for (Index& v : w.vertex) v = vertex[at(v)];
  w.given.change(SetUp{}).open_vertex = plate.rim();
  w.node_vertex.clear();  // both follow from these
  w.border_vertex.clear();
  w.exposed.vertex.resize(plate.vertices());
  resize_fields(w.couples, 0);
  resize_fields(w.reach, 0);
  hold_below(w, plate, triangles);
}

void number_joints(fdem::World& w, const std::vector<Index>& triangles) {
  w.mesh.joint_number.resize(w.joints.size());
  for (Index i = 0; i < w.joints.size(); ++i) {
    const Index edge = w.joints.edge_a.data()[i];
    w.mesh.joint_number.data()[i] = 3 * triangles[at(edge / 3)] + edge % 3;
  }
}

}  // namespace

TileRun tiles_of(int count, const Communicator* ranks) {
  if (ranks == nullptr) return {0, count, count};
  const auto before = [&](std::int64_t rank) {
    return static_cast<int>(rank * count / ranks->size());
  };
  return {before(ranks->rank()), before(ranks->rank() + 1), count};
}

dem::World tiled_slabs(dem::Config config, int count, Communicator* ranks, const Exec& exec) {
  config.supports.clear();
  const TileRun tiles = tiles_of(count, ranks);
  dem::World w(on_host(exec));
  collective_try(ranks, [&] {
    const dem::Model slab = build_model(config, "", exec);
    // A rank without tiles makes one for what all ranks know alike.
    const int first = std::min(tiles.first, count - 1), built = std::max(1, tiles.last - first);
    w = dem::make_world(config,
                        side_by_side(slab, TileRun{first, first + built, count}, exec.threads),
                        on_host(exec));
    w.given.change(SetUp{}).mean_radius =
        std::accumulate(slab.radius.begin(), slab.radius.end(), 0.0) /
        static_cast<double>(slab.size());
    if (ranks == nullptr) return;
    number_elements(w, first * slab.size());
    w.each_set([&](auto& set) { number_links(set.groups, set.numbers, tiles, built); });
    if (tiles.first == tiles.last) {
      drop_state(w);
      w.each_set([](auto& set) { set.numbers.resize(0); });
    }
  });
  if (ranks != nullptr) {
    w.next_dt = ranks->least(w.next_dt);
    w = share_parts(std::move(w), *ranks, config.domain, exec.space);
  } else if (exec.space != Space::host) {
    move_to(w, exec.space);
    derive(w);
  }
  evaluate_forces(w);  // sums in the order of the whole
  return w;
}

PlateTiles plate_tiles(std::int64_t triangles, int parts) {
  int side = 1;
  while (triangles / (4 * side * side) >= 10'000) side *= 2;
  PlateTiles tiles;
  tiles.triangles = static_cast<Index>(triangles / (side * side));
  int columns = static_cast<int>(std::sqrt(parts));
  while (parts % columns != 0) --columns;
  tiles.columns = columns * side;
  tiles.rows = parts / columns * side;
  return tiles;
}

fdem::World tiled_plate(const PlateTiles& tiles, Communicator* ranks, const Exec& exec) {
  const fdem::Config config = granite();
  fdem::World w(on_host(exec));
  std::vector<std::uint8_t> own;
  collective_try(ranks, [&] {
    const Plate plate(tiles);
    TileRun run = tiles_of(plate.count(), ranks);
    const bool none = run.first == run.last;
    // A rank without tiles makes one for what all ranks know alike.
    if (none) run = {0, 1, run.count};
    const std::vector<Index> triangles = plate.triangles_of(run);
    PlatePart part = part_of(plate, triangles);
    w = fdem::make_world(config, part.model, on_host(exec));
    const fdem::Case of_tile = *fdem::make_world(config, plate.tile().model(), on_host(exec)).given;
    fdem::Case& given = w.given.change(SetUp{});
    given.mean_edge = of_tile.mean_edge;
    given.skin = of_tile.skin;
    number_triangles(w, plate, triangles, part.vertex);
    if (ranks == nullptr) return;
    number_joints(w, triangles);
    const Index each = plate.tile().triangles();
    for (const Index t : triangles)
      own.push_back(t >= run.first * each && t < run.last * each ? 1 : 0);
    if (none) {
      drop_state(w);
      w.mesh.joint_number.resize(0);
      own.clear();
    }
  });
  if (ranks != nullptr) {
    w.next_dt = ranks->least(w.next_dt);
    w = share_parts(std::move(w), own, *ranks, config.domain, exec.space);
  } else if (exec.space != Space::host) {
    move_to(w, exec.space);
    derive(w);
  }
  find_couples(w);
  evaluate_forces(w);
  return w;
}

}  // namespace breccia
