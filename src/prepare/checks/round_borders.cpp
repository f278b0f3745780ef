#include "prepare/checks/round_borders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "exec/error.hpp"
#include "fdem_shared/shape.hpp"
#include "math/constants.hpp"
#include "prepare/checks/in_situ.hpp"
#include "prepare/checks/outlines.hpp"
#include "prepare/checks/takes_place.hpp"
#include "prepare/meshing/body_mesh.hpp"
#include "prepare/meshing/mesh_file.hpp"
#include "prepare/shapes/surface.hpp"
#include "prepare/tetrahedra/tet_body.hpp"
#include "prepare/tetrahedra/tet_file.hpp"

namespace breccia::prepare {
namespace {

/// A piece of the border of a body.
struct Piece {
  Vec3 at;      ///< its middle  [m]
  Vec3 normal;  ///< out of the body, of length 1
  double size;  ///< area; in 2D length  [m2; in 2D m]
};

constexpr int of_circle = 64;  ///< pieces

void add_circle(double radius, bool outwards, const Vec2& center, std::vector<Piece>& border) {
  for (int i = 0; i < of_circle; ++i) {
    const double angle = 2.0 * pi * (i + 0.5) / of_circle;
    const Vec3 out{std::cos(angle), std::sin(angle), 0.0};
    border.push_back({Vec3{center.x, center.y, 0.0} + radius * out, outwards ? out : -out,
                      2.0 * pi * radius / of_circle});
  }
}
void add_edge(const Vec2& from, const Vec2& to, std::vector<Piece>& border) {
  const Vec2 along = to - from;
  const double length = norm(along);
  if (!(length > 0.0)) return;
  constexpr int parts = 4;
  for (int k = 0; k < parts; ++k) {
    const Vec2 x = from + ((k + 0.5) / parts) * along;
    border.push_back({{x.x, x.y, 0.0}, {along.y / length, -along.x / length, 0.0}, length / parts});
  }
}

/// Of bodies that are no upright rectangles; empty: only gmsh tells.
std::vector<Piece> border_of(const fdem::BodyConfig& b, const std::string& folder) {
  std::vector<Piece> border;
  if (b.shape == "disc" || b.shape == "ring") add_circle(b.radius, true, b.center, border);
  if (b.shape == "ring") add_circle(b.inner_radius, false, b.center, border);
  if (b.shape == "outline") {
    const std::vector<Vec2> corners = read_outline(folder + "/" + b.file);
    for (std::size_t k = 0; k < corners.size(); ++k)
      add_edge(b.center + corners[k], b.center + corners[(k + 1) % corners.size()], border);
  }
  if (b.shape != "mesh") return border;
  const Mesh mesh = read_mesh(folder + "/" + b.file, b.seams == "open");
  std::map<Edge, int> sides;  // triangles beside each edge
  const auto sorted_edge = [](const Triangle& t, std::size_t k) {
    const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
    return Edge{low, high};
  };
  for (const Triangle& t : mesh.triangle)
    for (std::size_t k = 0; k < 3; ++k) ++sides[sorted_edge(t, k)];
  for (const Index number : triangles_of(b, mesh)) {
    const Triangle& t = mesh.triangle[static_cast<std::size_t>(number)];
    for (std::size_t k = 0; k < 3; ++k)
      if (sides[sorted_edge(t, k)] == 1)
        add_edge(b.center + at(mesh.point, t[k]), b.center + at(mesh.point, t[(k + 1) % 3]),
                 border);
  }
  return border;
}

void add_face(const Vec3& a, const Vec3& b, const Vec3& c, std::vector<Piece>& border) {
  const Vec3 twice = cross(b - a, c - a);
  const double size = norm(twice);
  if (size > 0.0) border.push_back({(1.0 / 3.0) * (a + b + c), (1.0 / size) * twice, 0.5 * size});
}

/// Of a cylinder along its own z, about its centre.
void add_cylinder(double radius, double height, std::vector<Piece>& border) {
  constexpr int along = 8, rings = 4;
  for (int i = 0; i < of_circle; ++i) {
    const double angle = 2.0 * pi * (i + 0.5) / of_circle;
    const Vec3 out{std::cos(angle), std::sin(angle), 0.0};
    for (int k = 0; k < along; ++k)
      border.push_back({radius * out + Vec3{0.0, 0.0, height * ((k + 0.5) / along - 0.5)}, out,
                        2.0 * pi * radius * height / (of_circle * along)});
    for (int k = 0; k < rings; ++k)
      for (const double side : {-1.0, 1.0})
        border.push_back({(k + 0.5) / rings * radius * out + Vec3{0.0, 0.0, 0.5 * side * height},
                          {0.0, 0.0, side},
                          2.0 * pi * radius * radius * (k + 0.5) / (rings * rings * of_circle)});
  }
}
void add_sphere(double radius, std::vector<Piece>& border) {
  constexpr int bands = 16;
  for (int k = 0; k < bands; ++k)
    for (int i = 0; i < of_circle; ++i) {
      const double z = 2.0 * (k + 0.5) / bands - 1.0, angle = 2.0 * pi * (i + 0.5) / of_circle;
      const double level = std::sqrt(1.0 - z * z);
      const Vec3 out{level * std::cos(angle), level * std::sin(angle), z};
      border.push_back({radius * out, out, 4.0 * pi * radius * radius / (bands * of_circle)});
    }
}
void add_box(const Vec3& size, std::vector<Piece>& border) {
  constexpr int parts = 8;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0})
      for (int i = 0; i < parts; ++i)
        for (int k = 0; k < parts; ++k) {
          const int u = (axis + 1) % 3, v = (axis + 2) % 3;
          Piece piece{{}, {}, 0.0};
          using fdem_shared::part_of;
          part_of(piece.normal, axis) = side;
          part_of(piece.at, axis) = 0.5 * side * part_of(size, axis);
          part_of(piece.at, u) = ((i + 0.5) / parts - 0.5) * part_of(size, u);
          part_of(piece.at, v) = ((k + 0.5) / parts - 0.5) * part_of(size, v);
          piece.size = part_of(size, u) * part_of(size, v) / (parts * parts);
          border.push_back(piece);
        }
}

/// Of bodies that are no upright boxes.
std::vector<Piece> border_of(const fdem3::BodyConfig& b, const std::string& folder) {
  std::vector<Piece> border;
  if (b.shape == "box" && b.is_turned()) add_box(b.size, border);
  if (b.shape == "cylinder") add_cylinder(b.radius, b.height, border);
  if (b.shape == "sphere") add_sphere(b.radius, border);
  if (b.shape == "stl")
    for (const Surface::Triangle& t : read_triangles(folder + "/" + b.file, 1.0))
      add_face(t[0], t[1], t[2], border);
  Frame3 frame;
  if (b.is_turned()) frame = frame_of(b);
  if (b.shape == "cylinder" && b.axis == "x")
    frame = {frame.out({0.0, 1.0, 0.0}), frame.out({0.0, 0.0, 1.0}), frame.out({1.0, 0.0, 0.0})};
  if (b.shape == "cylinder" && b.axis == "y")
    frame = {frame.out({0.0, 0.0, 1.0}), frame.out({1.0, 0.0, 0.0}), frame.out({0.0, 1.0, 0.0})};
  for (Piece& piece : border) {
    piece.at = b.center + frame.out(piece.at);
    piece.normal = frame.out(piece.normal);
  }
  if (b.shape != "mesh") return border;
  const TetMesh mesh = read_tet_mesh(folder + "/" + b.file);
  std::map<Face, int> sides;  // tetrahedra beside each face
  const auto sorted_face = [](const Tetrahedron& t, const std::array<std::size_t, 3>& corners) {
    Face face{t[corners[0]], t[corners[1]], t[corners[2]]};
    std::sort(face.begin(), face.end());
    return face;
  };
  for (const Tetrahedron& t : mesh.tetrahedron)
    for (const auto& corners : face_corners) ++sides[sorted_face(t, corners)];
  for (const Index number : tetrahedra_of(b, mesh)) {
    const Tetrahedron& t = mesh.tetrahedron[static_cast<std::size_t>(number)];
    for (const auto& corners : face_corners)
      if (sides[sorted_face(t, corners)] == 1)
        add_face(b.center + at(mesh.point, t[corners[0]]), b.center + at(mesh.point, t[corners[1]]),
                 b.center + at(mesh.point, t[corners[2]]), border);
  }
  return border;
}

/// Traction on a piece of the border.  [Pa]
Vec3 traction(const fdem::InSituConfig& in_situ, const Piece& piece) {
  const Vec2 t = in_situ.at({piece.at.x, piece.at.y}) * Vec2{piece.normal.x, piece.normal.y};
  return {t.x, t.y, 0.0};
}
Vec3 traction(const fdem3::InSituConfig& in_situ, const Piece& piece) {
  return in_situ.at(piece.at) * piece.normal;
}

template <class Config>
class RoundBorders {
 public:
  RoundBorders(const Config& config, const std::string& folder)
      : config_(config), folder_(folder), outlines_(outlines_of(config, &folder)) {}

  std::vector<std::string> doubts() {
    if (!config_.in_situ.any()) return {};
    for (std::size_t i = 0; i < outlines_.size(); ++i) {
      std::vector<Piece> border;
      try {
        border = border_of(config_.bodies[i], folder_);
      } catch (const Error&) {  // its reader tells
      }
      if (!border.empty()) look_at(i, border);
    }
    return std::move(found_);
  }

 private:
  struct Found {
    double all = 0.0, free = 0.0;  ///< sizes of the border
    Vec3 worst{};                  ///< the largest traction that nothing bears  [Pa]
    bool absorbs = false;
    std::string load;  ///< a pressure of another size
    double pressure = 0.0, wanted = 0.0;
  };

  void look_at(std::size_t body, const std::vector<Piece>& border) {
    double largest = 0.0, size = 0.0;
    const Vec3 from = border.front().at;
    for (const Piece& piece : border) {
      largest = std::max(largest, norm(traction(config_.in_situ, piece)));
      size = std::max(size, norm(piece.at - from));
    }
    if (!(largest > 0.0)) return;
    Found found;
    for (const Piece& piece : border)
      if (!meets_another(body, piece.at, 1e-6 * size))
        look_at(outlines_[body].name, piece, largest, 1e-3 * size, found);
    tell(outlines_[body].name, found);
  }

  bool meets_another(std::size_t body, const Vec3& x, double slack) const {
    const double at[] = {x.x, x.y, x.z};
    for (std::size_t i = 0; i < outlines_.size(); ++i) {
      const Outline& o = outlines_[i];
      if (i == body || o.in_another) continue;
      if (!o.bounds) return true;  // perhaps
      bool within = true;
      for (std::size_t k = 0; k < 3; ++k)
        within = within && at[k] >= o.bounds->low[k] - slack && at[k] <= o.bounds->high[k] + slack;
      if (within) return true;
    }
    return false;
  }

  void look_at(const std::string& body, const Piece& piece, double largest, double slack,
               Found& found) const {
    found.all += piece.size;
    Vec3 left = traction(config_.in_situ, piece);
    const double stress = norm(left);
    if (stress <= 1e-3 * largest) return;
    for (const auto& s : config_.supports)
      if (reaches(s.region, body, outlines_, piece.at, slack))
        for (int axis = 0; axis < 3; ++axis)
          if (s.is_free() || s.servo.is_on() ||
              std::count(s.fix.begin(), s.fix.end(), std::string(1, "xyz"[axis])) > 0)
            fdem_shared::part_of(left, axis) = 0.0;
    if (norm(left) <= 0.05 * stress) return;
    bool loaded = false;
    double pressure = 0.0;
    std::string name;
    for (const auto& load : config_.loads) {
      if (!load.dug_by.empty() || !reaches(load.region, body, outlines_, piece.at, slack)) continue;
      if (load.kind == "absorbing") {
        found.absorbs = true;
        continue;
      }
      if (load.kind != "pressure") return;
      loaded = true;
      pressure += first_pressure(load);
      name = load.name;
    }
    if (!loaded) {
      found.free += piece.size;
      if (norm(left) > norm(found.worst)) found.worst = left;
      return;
    }
    const double wanted = -dot(left, piece.normal);
    const bool bears = norm(left + pressure * piece.normal) <= 0.05 * stress;
    if (bears || std::abs(wanted) < std::abs(found.wanted)) return;
    found.load = name;
    found.pressure = pressure;
    found.wanted = wanted;
  }

  void tell(const std::string& body, const Found& found) {
    if (50.0 * found.free > found.all) {
      std::size_t axis = 0;
      for (std::size_t k = 1; k < 3; ++k)
        if (std::abs(fdem_shared::part_of(found.worst, static_cast<int>(k))) >
            std::abs(fdem_shared::part_of(found.worst, static_cast<int>(axis))))
          axis = k;
      found_.push_back(fmt::format(
          "{}: nothing bears the stress at the start, up to {}, on {} of {}: it moves from the "
          "first step on{}; a support there holds it, or loads that press as it does",
          key_across(config_.in_situ, axis), stress_text(norm(found.worst)),
          found.free > 0.999 * found.all
              ? "the border"
              : fmt::format("{:.0f} % of the border", 100.0 * found.free / found.all),
          body, found.absorbs ? " (an absorbing load takes waves up and bears no stress)" : ""));
    }
    if (!found.load.empty())
      found_.push_back(fmt::format(
          "load.{}.pressure: it presses the border of {} with {} at the start, and the stress in "
          "situ there is {} across it: the border moves from the first step on, unless the "
          "pressure "
          "is {}",
          found.load, body, stress_text(found.pressure), stress_text(-found.wanted),
          stress_text(found.wanted)));
  }

  const Config& config_;
  const std::string& folder_;
  std::vector<Outline> outlines_;
  std::vector<std::string> found_;
};

}  // namespace

std::vector<std::string> doubtful_round_borders(const fdem::Config& config,
                                                const std::string& folder) {
  return RoundBorders<fdem::Config>(config, folder).doubts();
}
std::vector<std::string> doubtful_round_borders(const fdem3::Config& config,
                                                const std::string& folder) {
  return RoundBorders<fdem3::Config>(config, folder).doubts();
}

}  // namespace breccia::prepare
