// breccia mesh info FILE, breccia convert IN OUT: what a mesh or packing is, and other formats.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>

#include "app/commands.hpp"
#include "app/geometry.hpp"
#include "exec/error.hpp"
#include "io/harmless.hpp"
#include "io/round_numbers.hpp"
#include "io/vtu/paraview.hpp"
#include "io/vtu/vtu_reader.hpp"
#include "io/whole_file.hpp"
#include "prepare/meshing/mesh_check.hpp"
#include "prepare/tetrahedra/tet_check.hpp"

namespace breccia::app {
namespace {

template <class... Values>
void print_line(const char* head, fmt::format_string<Values...> form, Values&&... values) {
  fmt::print("  {:<11} {}\n", head, harmless(fmt::format(form, std::forward<Values>(values)...)));
}

std::string place_text(const Vec2& p) {
  return fmt::format("({:.4g}, {:.4g}) m", p.x, p.y);
}

/// The smallest of a mesh, and the triangle or tetrahedron that has it.
struct Least {
  double value = 1e300;
  Index item = -1;
  void take(double other, Index t) {
    if (other < value) *this = {other, t};
  }
};

void describe_mesh(const prepare::Mesh& mesh) {
  Vec2 low = mesh.point.front(), high = low;
  for (const Vec2& p : mesh.point) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  Least height, angle, quality;
  double area = 0.0, mean_quality = 0.0;
  std::size_t flat = 0;
  for (std::size_t i = 0; i < mesh.triangle.size(); ++i) {
    const auto t = static_cast<Index>(i);
    const prepare::Triangle& corners = mesh.triangle[i];
    std::array<double, 3> side{};  // opposite to corner k  [m]
    for (std::size_t k = 0; k < 3; ++k)
      side[k] = norm(prepare::at(mesh.point, corners[(k + 1) % 3]) -
                     prepare::at(mesh.point, corners[(k + 2) % 3]));
    const double twice = 2.0 * prepare::signed_area(mesh.point, corners);
    area += 0.5 * twice;
    height.take(twice / *std::max_element(side.begin(), side.end()), t);
    double sharpest = std::numbers::pi;
    for (std::size_t k = 0; k < 3; ++k)
      sharpest = std::min(
          sharpest, std::asin(std::min(1.0, twice / (side[(k + 1) % 3] * side[(k + 2) % 3]))));
    angle.take(sharpest, t);
    // Twice the inscribed circle's radius over the circumscribed one's.
    const double sum = side[0] + side[1] + side[2];
    const double q = 4.0 * twice * twice / (side[0] * side[1] * side[2] * sum);
    quality.take(q, t);
    mean_quality += q / static_cast<double>(mesh.triangle.size());
    flat += q < 0.5;
  }
  const std::vector<prepare::MeshEdge> edges = prepare::edges_of(mesh.triangle);
  double shortest = 1e300, longest = 0.0, mean = 0.0;
  std::size_t rim = 0;
  for (const prepare::MeshEdge& edge : edges) {
    const double length =
        norm(prepare::at(mesh.point, edge.ends[1]) - prepare::at(mesh.point, edge.ends[0]));
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
    mean += length / static_cast<double>(edges.size());
    rim += edge.triangles[1] < 0;
  }
  const auto centre = [&](Index t) {
    return place_text(prepare::centroid(mesh.point, mesh.triangle[static_cast<std::size_t>(t)]));
  };
  const auto count = [](std::size_t n) { return count_text(static_cast<double>(n)); };
  print_line("triangles", "{}, vertices {}", count(mesh.triangle.size()), count(mesh.point.size()));
  print_line("edges", "{}, {} of them on the rim", count(edges.size()), count(rim));
  print_line("extent", "{} x {}, from {}", length_text(high.x - low.x), length_text(high.y - low.y),
             place_text(low));
  print_line("area", "{:.6g} m2", area);
  print_line("edge length", "{} to {}, mean {}", length_text(shortest), length_text(longest),
             length_text(mean));
  print_line("least angle", "{:.1f} deg, at {}", angle.value * 180.0 / std::numbers::pi,
             centre(angle.item));
  print_line("quality", "mean {:.3f}, least {:.3f} at {}", mean_quality, quality.value,
             centre(quality.item));
  print_line("", "{} below 0.5; equilateral triangles have 1", count(flat));
  constexpr double wave = 5000.0;  // of granite  [m/s]
  print_line("step", "ruled by the height {} at {}:", length_text(height.value),
             centre(height.item));
  print_line("", "a wave of {:.0f} m/s crosses it in {}", wave, time_text(height.value / wave));
  for (const prepare::Part& part : mesh.parts) {
    double of_part = 0.0;
    for (const Index t : part.triangles)
      of_part += prepare::signed_area(mesh.point, mesh.triangle[static_cast<std::size_t>(t)]);
    print_line("part", "{}: {} triangles, {:.4g} m2", part.name, count(part.triangles.size()),
               of_part);
  }
  for (const prepare::EdgeSet& set : mesh.edge_sets) {
    double length = 0.0;
    for (const prepare::Edge& edge : set.edges)
      length += norm(prepare::at(mesh.point, edge[1]) - prepare::at(mesh.point, edge[0]));
    print_line("line", "{}: {} edges, {}", set.name, count(set.edges.size()), length_text(length));
  }
}

/// Lengths of a mesh's edges, each once.  [m]
std::vector<double> edge_lengths(const prepare::TetMesh& mesh) {
  std::vector<std::array<Index, 2>> ends;
  ends.reserve(6 * mesh.tetrahedron.size());
  for (const prepare::Tetrahedron& t : mesh.tetrahedron)
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < a; ++b)
        ends.push_back({std::min(t[a], t[b]), std::max(t[a], t[b])});
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<double> lengths;
  lengths.reserve(ends.size());
  for (const auto& [a, b] : ends)
    lengths.push_back(norm(prepare::at(mesh.point, a) - prepare::at(mesh.point, b)));
  return lengths;
}

double area_of(const prepare::TetMesh& mesh, const prepare::Face& f) {
  const Vec3 a = prepare::at(mesh.point, f[0]);
  return 0.5 * norm(cross(prepare::at(mesh.point, f[1]) - a, prepare::at(mesh.point, f[2]) - a));
}

/// Volume and shape of one tetrahedron.
struct Shape {
  double volume;   ///<  [m3]
  double height;   ///< the least one  [m]
  double quality;  ///< three times the inscribed sphere's radius over the circumscribed one's  [-]
};
Shape shape_of(const prepare::TetMesh& mesh, const prepare::Tetrahedron& t) {
  double surface = 0.0, largest = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double area = area_of(mesh, prepare::face_of(t, k));
    surface += area;
    largest = std::max(largest, area);
  }
  const auto edge = [&](std::size_t a, std::size_t b) {
    return norm(prepare::at(mesh.point, t[a]) - prepare::at(mesh.point, t[b]));
  };
  // Products of opposite edges are the sides of a triangle of area 6 V R (Crelle 1821).
  const double a = edge(0, 1) * edge(2, 3), b = edge(0, 2) * edge(1, 3),
               c = edge(0, 3) * edge(1, 2), half = 0.5 * (a + b + c);
  const double of_products = std::sqrt(std::max(0.0, half * (half - a) * (half - b) * (half - c)));
  const double volume = prepare::signed_volume(mesh.point, t);
  const double circumscribed = of_products / (6.0 * volume), inscribed = 3.0 * volume / surface;
  return {volume, 3.0 * volume / largest, 3.0 * inscribed / circumscribed};
}

void describe_solid(const prepare::TetMesh& mesh) {
  Vec3 low = mesh.point.front(), high = low;
  for (const Vec3& p : mesh.point) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  Least height, quality;
  double volume = 0.0, mean_quality = 0.0, surface = 0.0;
  std::size_t poor = 0, outer = 0;
  const double size = static_cast<double>(mesh.tetrahedron.size());
  for (std::size_t t = 0; t < mesh.tetrahedron.size(); ++t) {
    const Shape shape = shape_of(mesh, mesh.tetrahedron[t]);
    volume += shape.volume;
    height.take(shape.height, static_cast<Index>(t));
    quality.take(shape.quality, static_cast<Index>(t));
    mean_quality += shape.quality / size;
    poor += shape.quality < 0.3;
  }
  const std::vector<prepare::MeshFace> faces = prepare::faces_of(mesh.tetrahedron);
  for (const prepare::MeshFace& face : faces)
    if (face.tetrahedra[1] < 0) {
      ++outer;
      surface += area_of(mesh, face.corners);
    }
  const std::vector<double> edges = edge_lengths(mesh);
  double mean = 0.0;
  for (const double length : edges) mean += length / static_cast<double>(edges.size());
  const auto at = [](const Vec3& p) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g}) m", p.x, p.y, p.z);
  };
  const auto centre = [&](Index t) {
    return at(prepare::centroid(mesh.point, mesh.tetrahedron[static_cast<std::size_t>(t)]));
  };
  const auto count = [](std::size_t n) { return count_text(static_cast<double>(n)); };
  print_line("tetrahedra", "{}, vertices {}", count(mesh.tetrahedron.size()),
             count(mesh.point.size()));
  print_line("faces", "{}, {} of them on the surface", count(faces.size()), count(outer));
  print_line("extent", "{} x {} x {}", length_text(high.x - low.x), length_text(high.y - low.y),
             length_text(high.z - low.z));
  print_line("", "from {}", at(low));
  print_line("volume", "{:.6g} m3, surface {:.6g} m2", volume, surface);
  print_line("edge length", "{} to {}, mean {}",
             length_text(*std::min_element(edges.begin(), edges.end())),
             length_text(*std::max_element(edges.begin(), edges.end())), length_text(mean));
  print_line("quality", "mean {:.3f}, least {:.3f} at {}", mean_quality, quality.value,
             centre(quality.item));
  print_line("", "{} below 0.3; regular tetrahedra have 1", count(poor));
  constexpr double wave = 5000.0;  // of granite  [m/s]
  print_line("step", "ruled by the height {}", length_text(height.value));
  print_line("", "at {}:", centre(height.item));
  print_line("", "a wave of {:.0f} m/s crosses it in {}", wave, time_text(height.value / wave));
  for (const prepare::Volume& part : mesh.volumes) {
    double of_part = 0.0;
    for (const Index t : part.tetrahedra)
      of_part += prepare::signed_volume(mesh.point, mesh.tetrahedron[static_cast<std::size_t>(t)]);
    print_line("part", "{}: {} tetrahedra, {:.4g} m3", part.name, count(part.tetrahedra.size()),
               of_part);
  }
  for (const prepare::FaceSet& set : mesh.face_sets) {
    double area = 0.0;
    for (const prepare::Face& face : set.faces) area += area_of(mesh, face);
    print_line("surface", "{}: {} faces, {:.4g} m2", set.name, count(set.faces.size()), area);
  }
}

void describe_spheres(const Geometry& g) {
  constexpr double far = 1e300;
  Vec3 low{far, far, far}, high{-far, -far, -far};
  double volume = 0.0, mean = 0.0, least = far, most = 0.0;
  for (std::size_t i = 0; i < g.center.size(); ++i) {
    const Vec3& p = g.center[i];
    const double r = g.radius[i];
    low = {std::min(low.x, p.x - r), std::min(low.y, p.y - r), std::min(low.z, p.z - r)};
    high = {std::max(high.x, p.x + r), std::max(high.y, p.y + r), std::max(high.z, p.z + r)};
    volume += 4.0 / 3.0 * std::numbers::pi * r * r * r;
    mean += r / static_cast<double>(g.center.size());
    least = std::min(least, r);
    most = std::max(most, r);
  }
  const Vec3 size = high - low;
  print_line("spheres", "{}", count_text(static_cast<double>(g.center.size())));
  print_line("extent", "{} x {} x {}, from ({:.4g}, {:.4g}, {:.4g}) m", length_text(size.x),
             length_text(size.y), length_text(size.z), low.x, low.y, low.z);
  print_line("radius", "{} to {}, mean {}", length_text(least), length_text(most),
             length_text(mean));
  print_line("volume", "{:.6g} m3 of spheres, {:.3f} of the box around them", volume,
             volume / (size.x * size.y * size.z));
  for (std::size_t b = 0; b < g.groups.size(); ++b) {
    const auto count = std::count(g.group.begin(), g.group.end(), static_cast<std::int32_t>(b));
    print_line("body", "{}: {} spheres", g.groups[b], count_text(static_cast<double>(count)));
  }
}

void describe(const std::string& path, int frame) {
  const Geometry g = read_geometry(path, frame);
  if (!g.is_mesh() && !g.is_solid() && g.center.empty())
    throw InputError(path + ": holds no mesh and no spheres");
  fmt::print("{}\n", harmless(path));
  if (g.is_solid())
    describe_solid(g.solid);
  else if (g.is_mesh())
    describe_mesh(g.mesh);
  else
    describe_spheres(g);
}

/// Every frame of a result folder, as files of another format in a folder of their own.
std::size_t convert_frames(const std::string& from, const std::string& to, FrameFormat format) {
  if (!std::filesystem::is_directory(from) || !holds_frames(from))
    throw InputError(from + ": holds no frames; --frames converts those of a result folder");
  if (holds_frames(to)) throw InputError(to + ": holds frames already; nothing was written");
  const std::size_t count = frame_times(from).size();
  ParaviewSeries series(to, format);
  for (std::size_t i = 0; i < count; ++i) series.write(read_frame(from, static_cast<int>(i)));
  series.finish();
  return count;
}

}  // namespace

void add_mesh(CLI::App& program) {
  CLI::App* const mesh = program.add_subcommand("mesh", "look at meshes and packings");
  mesh->require_subcommand(1);
  CLI::App* const info =
      mesh->add_subcommand("info", "size, edges, angles, quality, parts, what rules the step");
  const auto path = std::make_shared<std::string>();
  const auto frame = std::make_shared<int>(-1);
  info->add_option("FILE", *path,
                   "a mesh (.msh, .inp), spheres (.csv, .txt, a dump or data of LAMMPS), a "
                   "prepared model (.br) or a result folder")
      ->required();
  info->add_option("--frame", *frame, "of a result folder; default: the last")->type_name("N");
  info->callback([path, frame] { describe(*path, *frame); });
}

void add_convert(CLI::App& program) {
  struct Words {
    std::string from, to, frames;
    int frame = -1;
  };
  const auto words = std::make_shared<Words>();
  CLI::App* const convert = program.add_subcommand(
      "convert", "write a mesh, a packing or the frames of a run in another format");
  convert
      ->add_option("IN", words->from,
                   "a mesh (.msh, .inp), spheres (.csv, .txt, a dump or data of LAMMPS), a "
                   "prepared model (.br) or a result folder")
      ->required();
  convert
      ->add_option("OUT", words->to,
                   "of a mesh .msh (Gmsh 2.2), .inp (Abaqus), .vtu or .hdf (VTKHDF); of spheres "
                   ".csv, .vtu or .hdf; with --frames a folder")
      ->required();
  CLI::Option* const frame =
      convert->add_option("--frame", words->frame, "of a result folder; default: the last")
          ->type_name("N");
  convert
      ->add_option("--frames", words->frames,
                   "all frames of a result folder, as ParaView files: vtu or vtkhdf")
      ->check(CLI::IsMember({"vtu", "vtkhdf"}))
      ->excludes(frame);
  convert->callback([words] {
    if (!words->frames.empty()) {
      const std::size_t count = convert_frames(words->from, words->to, frame_format(words->frames));
      fmt::print("{}  {} frames\n", harmless(words->to), count);
      return;
    }
    const Geometry g = read_geometry(words->from, words->frame);
    replace_file(words->to, written_geometry(g, words->to));
    const std::size_t count = g.is_solid()  ? g.solid.tetrahedron.size()
                              : g.is_mesh() ? g.mesh.triangle.size()
                                            : g.center.size();
    fmt::print("{}  {} {}\n", harmless(words->to), count_text(static_cast<double>(count)),
               g.is_solid()  ? "tetrahedra"
               : g.is_mesh() ? "triangles"
                             : "spheres");
  });
}

}  // namespace breccia::app
