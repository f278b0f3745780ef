#include "io/picture/solid.hpp"

#include <cmath>

namespace breccia {
namespace {

constexpr double on_plane = 0.05;  // pixels: a corner so near lies on the plane of a cut

/// Twice the area on the picture: negative for corners that run counter-clockwise.
double turn(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c) {
  return (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
}

/// The direction at right angles to a triangle: right, up, towards the viewer; of unit length.
Vec3 normal_of(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c) {
  const Vec3 normal = cross(Vec3{b.u - a.u, a.v - b.v, b.depth - a.depth},
                            Vec3{c.u - a.u, a.v - c.v, c.depth - a.depth});
  const double size = norm(normal);
  return size > 0.0 ? (1.0 / size) * normal : Vec3{0, 0, 1};
}

/// Light on a face: bright enough that colours are those of the legend.
float light_on(const Vec3& normal) {
  const double facing = std::max(0.0, dot(normal, lamp_direction()));
  return static_cast<float>(0.68 + 0.05 * normal.y + 0.33 * facing);
}
float light_on_cut(const Vec3& normal) {
  return static_cast<float>(0.84 + 0.16 * std::max(0.0, dot(normal, lamp_direction())));
}

ScreenPoint between(const ScreenPoint& a, const ScreenPoint& b, double beyond_a, double beyond_b) {
  const double share = beyond_a / (beyond_a - beyond_b);
  return {a.u + share * (b.u - a.u), a.v + share * (b.v - a.v),
          a.depth + share * (b.depth - a.depth)};
}

double beyond_of(const ScreenPoint& p, const ScreenClip& clip) {
  return clip.beyond(p.u, p.v, p.depth);
}

std::array<ScreenPoint, 4> corners_of(const Frame& frame, const Scene& scene, std::size_t t) {
  std::array<ScreenPoint, 4> corners;
  for (std::size_t k = 0; k < 4; ++k)
    corners[k] = scene.point(static_cast<std::size_t>(frame.tetrahedra[4 * t + k]));
  return corners;
}

/// The faces of one tetrahedron that look at the viewer. One that lies in the plane of a cut is a
/// section, exposed or not.
void add_faces(const std::array<ScreenPoint, 4>& p, std::int32_t tetrahedron, unsigned exposed,
               const std::optional<ScreenClip>& clip, std::vector<SolidPiece>& pieces) {
  const Vec3 a{p[1].u - p[0].u, p[1].v - p[0].v, p[1].depth - p[0].depth},
      b{p[2].u - p[0].u, p[2].v - p[0].v, p[2].depth - p[0].depth},
      c{p[3].u - p[0].u, p[3].v - p[0].v, p[3].depth - p[0].depth};
  const double inverted = dot(cross(a, b), c) > 0.0 ? -1.0 : 1.0;  // v points downwards
  for (unsigned face = 0; face < 4; ++face) {
    const auto corner = [&](int k) {
      return p[static_cast<std::size_t>(tetrahedron_faces[face][k])];
    };
    const SolidPiece piece{{corner(0), corner(1), corner(2), corner(2)}, 3, tetrahedron, false};
    if (!(inverted * turn(corner(0), corner(1), corner(2)) < 0.0)) continue;
    bool in_plane = clip.has_value(), dropped = clip.has_value();
    for (int k = 0; clip && k < 3; ++k) {
      const double beyond = beyond_of(corner(k), *clip);
      in_plane = in_plane && std::fabs(beyond) < on_plane;
      dropped = dropped && beyond >= on_plane;
    }
    if (dropped || (!in_plane && (exposed >> face & 1U) == 0)) continue;
    if (in_plane && beyond_of(p[face], *clip) > 0.0) continue;
    pieces.push_back(piece);
    pieces.back().section = in_plane;
  }
}

/// A straight mark on the surface.
struct Mark {
  ScreenPoint a, b;
  std::int32_t item;
  int thickness;
};

/// Of each joint that shows its edges, and where it meets the plane of a cut.
std::vector<Mark> marks_of_joints(const Canvas& canvas, const Frame& frame,
                                  const Coloring& coloring, Scene& scene) {
  const double usual = std::max(3.0, canvas.width / 480.0);
  std::vector<Mark> marks;
  for (std::size_t joint = 0; joint < coloring.lines.size(); ++joint) {
    if (!coloring.hidden_lines.empty() && coloring.hidden_lines[joint]) continue;
    const double factor = coloring.line_widths.empty() ? 1.0 : coloring.line_widths[joint];
    const int thickness = std::max(1, static_cast<int>(factor * usual + 0.25));
    const auto item = static_cast<std::int32_t>(scene.looks.size());
    scene.looks.push_back({coloring.lines[joint], {}});
    std::array<ScreenPoint, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = scene.point(static_cast<std::size_t>(frame.triangles[3 * joint + k]));
    std::vector<ScreenPoint> cut;
    for (std::size_t k = 0; k < 3; ++k) {
      const ScreenPoint &a = p[k], &b = p[(k + 1) % 3];
      marks.push_back({a, b, item, thickness});
      if (!scene.clip) continue;
      const double of_a = beyond_of(a, *scene.clip), of_b = beyond_of(b, *scene.clip);
      if ((of_a > 0.0) != (of_b > 0.0)) cut.push_back(between(a, b, of_a, of_b));
    }
    if (cut.size() == 2) marks.push_back({cut[0], cut[1], item, thickness});
  }
  return marks;
}

std::vector<Mark> marks_of_edges(const Canvas& canvas, const std::vector<SolidPiece>& pieces,
                                 Scene& scene) {
  const int thickness = std::max(1, canvas.width / 2000);
  const auto item = static_cast<std::int32_t>(scene.looks.size());
  scene.looks.push_back({Color{0.35F, 0.36F, 0.38F}, {}});
  std::vector<Mark> marks;
  for (const SolidPiece& piece : pieces)
    for (std::size_t k = 0; k < piece.corners; ++k)
      marks.push_back({piece.corner[k], piece.corner[(k + 1) % piece.corners], item, thickness});
  return marks;
}

void draw_marks(Canvas& canvas, const std::vector<Mark>& marks, const Scene& scene, int threads) {
  Bands bands(canvas, threads);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const Mark& mark = marks[i];
    bands.add(i, std::min(mark.a.v, mark.b.v), std::max(mark.a.v, mark.b.v), mark.thickness + 1.0);
  }
  bands.draw([&](std::size_t i, Rows rows) {
    const Mark& mark = marks[i];
    draw_mark(canvas, rows, mark.a, mark.b, mark.thickness, mark.item, scene.clip);
  });
}

}  // namespace

SolidPiece section_of(const std::array<ScreenPoint, 4>& corners, const ScreenClip& clip) {
  std::array<std::size_t, 4> kept{}, lost{};
  std::array<double, 4> beyond{};
  std::size_t kept_count = 0, lost_count = 0;
  bool reaches_below = false;
  for (std::size_t k = 0; k < 4; ++k) {
    beyond[k] = beyond_of(corners[k], clip);
    reaches_below = reaches_below || beyond[k] <= -on_plane;
    if (beyond[k] < on_plane)
      kept[kept_count++] = k;
    else
      lost[lost_count++] = k;
  }
  SolidPiece piece{{}, 0, 0, true};
  if (!reaches_below) return piece;
  const auto add = [&](std::size_t from, std::size_t to) {
    piece.corner[piece.corners++] = between(corners[from], corners[to], beyond[from], beyond[to]);
  };
  if (lost_count == 2) {  // around the quadrangle
    add(kept[0], lost[0]);
    add(kept[0], lost[1]);
    add(kept[1], lost[1]);
    add(kept[1], lost[0]);
  } else if (lost_count == 1 || lost_count == 3) {
    for (std::size_t k = 0; k < kept_count; ++k)
      for (std::size_t l = 0; l < lost_count; ++l) add(kept[k], lost[l]);
  }
  return piece;
}

std::vector<SolidPiece> pieces_of(const Frame& frame, const Scene& scene) {
  const std::size_t count = frame.tetrahedra.size() / 4;
  const FrameField* exposed = field_of(frame, Carrier::tetrahedra, "exposed");
  if (exposed != nullptr && exposed->values.size() != count) exposed = nullptr;
  const bool cut_seen = scene.clip && scene.clip->nd > 1e-9;
  std::vector<SolidPiece> pieces;
  for (std::size_t t = 0; t < count; ++t) {
    const std::array<ScreenPoint, 4> corners = corners_of(frame, scene, t);
    double size = 0.0;
    for (const ScreenPoint& p : corners)
      size += std::fabs(p.u) + std::fabs(p.v) + std::fabs(p.depth);
    if (!(size < 1e20)) continue;  // far off, or nowhere
    const auto number = static_cast<std::int32_t>(t);
    const unsigned faces =
        exposed == nullptr ? 15U : static_cast<unsigned>(exposed->values[t]) & 15U;
    add_faces(corners, number, faces, scene.clip, pieces);
    if (!cut_seen) continue;
    SolidPiece section = section_of(corners, *scene.clip);
    section.tetrahedron = number;
    if (section.corners > 0) pieces.push_back(section);
  }
  return pieces;
}

void draw_solids(Canvas& canvas, const Frame& frame, const Coloring& coloring, SolidMarks marks,
                 Scene& scene, int threads) {
  const std::vector<SolidPiece> pieces = pieces_of(frame, scene);
  const std::size_t first = scene.looks.size();
  scene.looks.resize(first + pieces.size());
  for_chunks(threads, pieces.size(), [&](std::size_t i) {
    const SolidPiece& piece = pieces[i];
    Vec3 normal = normal_of(piece.corner[0], piece.corner[1], piece.corner[2]);
    if (normal.z < 0.0) normal = -normal;  // it faces the viewer
    scene.looks[first + i].color =
        shaded(coloring.tetrahedra[static_cast<std::size_t>(piece.tetrahedron)],
               piece.section ? light_on_cut(normal) : light_on(normal));
  });
  Bands bands(canvas, threads);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    double top = 1e300, bottom = -1e300;
    for (std::size_t k = 0; k < pieces[i].corners; ++k) {
      top = std::min(top, pieces[i].corner[k].v);
      bottom = std::max(bottom, pieces[i].corner[k].v);
    }
    bands.add(i, top, bottom, 1.0);
  }
  bands.draw([&](std::size_t i, Rows rows) {
    const SolidPiece& piece = pieces[i];
    const auto item = static_cast<std::int32_t>(first + i);
    const std::optional<ScreenClip> clip = piece.section ? std::nullopt : scene.clip;
    for (std::size_t k = 2; k < piece.corners; ++k)
      draw_triangle(canvas, rows, piece.corner[0], piece.corner[k - 1], piece.corner[k], item,
                    clip);
  });
  scene.solids_seen.assign(frame.tetrahedra.size() / 4, false);
  for (const std::int32_t item : canvas.item)
    if (item != Canvas::none && item >= static_cast<std::int32_t>(first))  // others are spheres
      scene.solids_seen[static_cast<std::size_t>(
          pieces[static_cast<std::size_t>(item) - first].tetrahedron)] = true;
  if (marks.edges) draw_marks(canvas, marks_of_edges(canvas, pieces, scene), scene, threads);
  if (marks.joints)
    draw_marks(canvas, marks_of_joints(canvas, frame, coloring, scene), scene, threads);
}

void draw_joint_faces(Canvas& canvas, const Frame& frame, const Coloring& coloring, Scene& scene,
                      int threads) {
  Frame joints;  // as a frame of triangles alone
  std::vector<Color> colors;
  for (std::size_t joint = 0; joint < coloring.lines.size(); ++joint) {
    if (!coloring.hidden_lines.empty() && coloring.hidden_lines[joint]) continue;
    for (std::size_t k = 0; k < 3; ++k) joints.triangles.push_back(frame.triangles[3 * joint + k]);
    colors.push_back(coloring.lines[joint]);
  }
  draw_triangles(canvas, joints, colors, scene, threads);
}

}  // namespace breccia
