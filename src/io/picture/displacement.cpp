// Displacements of a frame: from the first one of its run, and drawn larger than they are.

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "exec/error.hpp"
#include "io/picture/field_colors.hpp"

namespace breccia {
namespace {

const char* const other_bodies =
    "displacements need the bodies of the first frame, and this frame has others";

/// Places at the start by id, for spheres.
std::vector<Vec3> starts_of_spheres(const Frame& frame, const Frame& first) {
  const FrameField* now = field_of(frame, Carrier::points, "id");
  const FrameField* then = field_of(first, Carrier::points, "id");
  if (now == nullptr || then == nullptr) {
    if (frame.position.size() != first.position.size()) throw InputError(other_bodies);
    return first.position;
  }
  std::unordered_map<std::int64_t, std::size_t> place;
  for (std::size_t i = 0; i < then->values.size(); ++i)
    place[static_cast<std::int64_t>(then->values[i])] = i;
  std::vector<Vec3> starts;
  for (const float id : now->values) {
    const auto found = place.find(static_cast<std::int64_t>(id));
    if (found == place.end()) throw InputError(other_bodies);
    starts.push_back(first.position.at(found->second));
  }
  return starts;
}

/// The elements of bodies: tetrahedra, or triangles in the plane.
struct Elements {
  const std::vector<std::int32_t>& corners;
  std::size_t each;                                  ///< corners
  std::map<float, std::vector<std::size_t>> bodies;  ///< the elements of each, in their order

  explicit Elements(const Frame& frame)
      : corners(frame.tetrahedra.empty() ? frame.triangles : frame.tetrahedra),
        each(frame.tetrahedra.empty() ? 3 : 4) {
    const FrameField* group = field_of(
        frame, frame.tetrahedra.empty() ? Carrier::triangles : Carrier::tetrahedra, "group");
    for (std::size_t e = 0; e < corners.size() / each; ++e)
      bodies[group != nullptr && e < group->values.size() ? group->values[e] : 0.0F].push_back(e);
  }
  std::size_t corner(std::size_t element, std::size_t k) const {
    return static_cast<std::size_t>(corners[each * element + k]);
  }
};

/// Corners of elements by squares or cubes of space, to find the nearest one.
class Corners {
 public:
  Corners(const Frame& frame, const std::vector<bool>& is_corner)
      : frame_(frame), layers_(frame.tetrahedra.empty() ? 0 : 1) {
    double low = 1e300, high = -1e300;
    std::size_t count = 0;
    for (std::size_t i = 0; i < is_corner.size(); ++i) {
      if (!is_corner[i]) continue;
      const Vec3& p = frame.position[i];
      low = std::min({low, p.x, p.y, layers_ > 0 ? p.z : p.y});
      high = std::max({high, p.x, p.y, layers_ > 0 ? p.z : p.y});
      ++count;
    }
    const double a_side = layers_ > 0 ? std::cbrt(1.0 + static_cast<double>(count))
                                      : std::sqrt(1.0 + static_cast<double>(count));
    size_ = std::max(1e-300, 2.0 * (high - low) / a_side);
    for (std::size_t i = 0; i < is_corner.size(); ++i)
      if (is_corner[i]) cells_[key(frame.position[i], 0, 0, 0)].push_back(i);
  }
  /// -1: none is near.
  std::ptrdiff_t nearest(const Vec3& place) const {
    std::ptrdiff_t best = -1;
    double least = 1e300;
    for (int dz = -layers_; dz <= layers_; ++dz)
      for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy) {
          const auto cell = cells_.find(key(place, dx, dy, dz));
          if (cell == cells_.end()) continue;
          for (const std::size_t i : cell->second) {
            const Vec3 way = frame_.position[i] - place;
            if (const double square = dot(way, way); square < least) {
              least = square;
              best = static_cast<std::ptrdiff_t>(i);
            }
          }
        }
    return best;
  }

 private:
  std::int64_t key(const Vec3& p, int dx, int dy, int dz) const {
    const auto cell = [this](double x) { return static_cast<std::int64_t>(std::floor(x / size_)); };
    const std::int64_t in_plane = (cell(p.x) + dx) * 0x100000000LL + (cell(p.y) + dy);
    return layers_ > 0 ? in_plane + (cell(p.z) + dz) * 0x10000LL : in_plane;
  }
  const Frame& frame_;
  int layers_;  ///< of cells to look into above and below
  double size_ = 1.0;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
};

/// Of corners by their elements; of points of cracks the mean of the two corners on either side.
std::vector<Vec3> displacements_of_bodies(const Frame& frame, const Frame& first) {
  const Elements now(frame), then(first);
  std::vector<Vec3> way(frame.position.size());
  std::vector<bool> is_corner(frame.position.size(), false);
  if (now.each != then.each) throw InputError(other_bodies);
  for (const auto& [group, elements] : now.bodies) {
    const auto found = then.bodies.find(group);
    if (found == then.bodies.end() || found->second.size() != elements.size())
      throw InputError(other_bodies);
    for (std::size_t e = 0; e < elements.size(); ++e)
      for (std::size_t k = 0; k < now.each; ++k) {
        const std::size_t point = now.corner(elements[e], k);
        way[point] = frame.position[point] - first.position[then.corner(found->second[e], k)];
        is_corner[point] = true;
      }
  }
  const Corners corners(frame, is_corner);
  for (std::size_t i = 0; i < way.size(); ++i) {
    if (is_corner[i]) continue;
    const Vec3& here = frame.position[i];
    const std::ptrdiff_t near = corners.nearest(here);
    if (near < 0) continue;
    const auto one = static_cast<std::size_t>(near);
    const std::ptrdiff_t across = corners.nearest(2.0 * here - frame.position[one]);
    way[i] = across < 0 ? way[one] : 0.5 * (way[one] + way[static_cast<std::size_t>(across)]);
  }
  return way;
}

}  // namespace

void add_displacement(Frame& frame, const Frame& first) {
  if (field_of(frame, Carrier::points, "displacement") != nullptr) return;
  std::vector<Vec3> way;
  if (frame.triangles.empty() && frame.tetrahedra.empty()) {
    way = starts_of_spheres(frame, first);
    for (std::size_t i = 0; i < way.size(); ++i) way[i] = frame.position[i] - way[i];
  } else {
    way = displacements_of_bodies(frame, first);
  }
  FrameField field{"displacement", "m", 3, {}};
  for (const Vec3& w : way)
    for (const double c : {w.x, w.y, w.z}) field.values.push_back(static_cast<float>(c));
  frame.point_fields.push_back(std::move(field));
}

bool needs_displacement(const RenderOptions& options) {
  return options.scale != 1.0 || options.arrows == "displacement" ||
         options.field.starts_with("displacement");
}

Frame displaced(const Frame& frame, double scale) {
  const FrameField* field = field_of(frame, Carrier::points, "displacement");
  if (field == nullptr || field->values.size() != 3 * frame.position.size())
    throw InputError(
        "displacements cannot be drawn larger: this frame has no field displacement; "
        "output.more = [\"displacement\"] adds it");
  Frame moved = frame;
  // Joints that have opened but little gape in the picture: faces within are then to be seen.
  if (scale != 1.0)
    std::erase_if(moved.tetrahedron_fields,
                  [](const FrameField& of) { return of.name == "exposed"; });
  for (std::size_t i = 0; i < frame.position.size(); ++i) {
    const float* const way = &field->values[3 * i];
    moved.position[i] = frame.position[i] + (scale - 1.0) * Vec3{way[0], way[1], way[2]};
  }
  return moved;
}

}  // namespace breccia
