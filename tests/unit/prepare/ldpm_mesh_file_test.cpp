// Particles and tetrahedra of LDPM from the files of public preprocessors.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "prepare/build.hpp"
#include "prepare/ldpm/body.hpp"
#include "prepare/ldpm/mesh_file.hpp"
#include "prepare/ldpm/particles.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia::prepare {
namespace ldpm_mesh_file_test {

constexpr const char* four =
    "// n x y z d\n0 0.0 0.0 0.0 0.0\n1 10 0 0 0\n2 0 10 0 0\r\n# a grain\n\n3 0 0 1e1 8.5\n";

LdpmMesh mesh_of(const std::string& particles, const std::string& tetrahedra) {
  const ScratchFolder folder;
  replace_file(folder / "geo-data-particles.dat", particles);
  replace_file(folder / "geo-data-tets.dat", tetrahedra);
  return read_ldpm_mesh(folder / "geo-data-tets.dat");
}

TEST(LdpmMeshFile, holds_particles_in_millimetres_and_tetrahedra) {
  const LdpmMesh mesh = mesh_of(four, "// \n  3 1 0 2\n");
  ASSERT_EQ(mesh.position.size(), 4U);
  EXPECT_EQ(mesh.position[3].z, 10e-3);
  EXPECT_EQ(mesh.diameter[0], 0.0);
  EXPECT_EQ(mesh.diameter[3], 8.5e-3);
  ASSERT_EQ(mesh.tetrahedra.size(), 1U);
  EXPECT_EQ(mesh.tetrahedra[0], (Tetrahedron{0, 1, 2, 3}));
}

TEST(LdpmMeshFile, leaves_flat_tetrahedra_out) {
  const std::string five = std::string(four) + "4 10 10 0 0\n";
  EXPECT_EQ(mesh_of(five, "0 1 2 3\n0 1 2 4\n1 2 3 4\n").tetrahedra.size(), 2U);
}

TEST(LdpmMeshFile, names_the_line_that_is_no_particle_or_tetrahedron) {
  const auto refused = [](const std::string& particles, const std::string& tetrahedra,
                          const std::string& part) {
    try {
      mesh_of(particles, tetrahedra);
      ADD_FAILURE() << part;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refused("0 0 0 0 0\n2 0 0 0 0\n", "", "geo-data-particles.dat, line 2 is not n x y z d");
  refused("0 0 0 0 -1\n", "", "line 1");
  refused("0 0 0 x 0\n", "", "line 1");
  refused(four, "0 1 2 4\n", "geo-data-tets.dat, line 1 is not four different particles of 0 to 3");
  refused(four, "0 1 2 2\n", "line 1");
  refused(four, "0 1 2\n", "line 1");
  refused(std::string(four) + "4 5 5 5 0\n", "0 1 2 3\n", "particle 4 is the corner of no");
  refused(four, "", "particle 0 is the corner of no");
  EXPECT_THROW(read_ldpm_mesh("particles.dat"), InputError);
  EXPECT_THROW(read_ldpm_mesh("/nowhere/geo-data-tets.dat"), IoError);
}

dem::Config one_box() {
  dem::Config config;
  dem::MaterialConfig concrete;
  concrete.name = "concrete";
  concrete.law = "ldpm";
  concrete.tensile_strength = 3e6;
  concrete.cohesion = 8e6;
  config.materials = {concrete};
  dem::BodyConfig body;
  body.name = "cube";
  body.material = "concrete";
  body.size = {0.03, 0.03, 0.04};
  config.bodies = {body};
  config.time.end = 1.0;
  return config;
}

/// Particles on the faces of a closed surface belong to the body.
TEST(LdpmMeshFile, the_inside_of_a_box_drawn_as_a_surface_is_the_box) {
  dem::Config config = one_box();
  const dem::Model box = build_model(config, "");

  std::string text = "solid box\n";
  constexpr int faces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  for (const auto& face : faces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int k : face)
      text += fmt::format("vertex {} {} {}\n", k % 2 == 0 ? -0.015 : 0.015,
                          k / 2 % 2 == 0 ? -0.015 : 0.015, k / 4 == 0 ? -0.02 : 0.02);
    text += "endloop\nendfacet\n";
  }
  const ScratchFolder folder;
  replace_file(folder / "box.stl", text + "endsolid box\n");
  config.bodies[0].shape = "stl";
  config.bodies[0].file = "box.stl";
  const dem::Model drawn = build_model(config, folder.path());
  ASSERT_EQ(drawn.size(), box.size());
  EXPECT_EQ(drawn.links.size(), box.links.size());
}

/// A body that was placed here, written as a preprocessor does and read, is the same model.
TEST(LdpmMeshFile, of_a_body_gives_the_model_of_the_body) {
  dem::Config config = one_box();
  const dem::Model placed = build_model(config, "");

  const Container box{.shape = Container::Shape::box, .size = config.bodies[0].size};
  const LdpmParticles p = place_particles(box, MixDesign{}, {1, 0});
  std::string particles, tetrahedra;
  for (std::size_t k = 0; k < p.position.size(); ++k)
    particles += fmt::format("{} {} {} {} {}\n", k, 1e3 * p.position[k].x + 15.0,
                             1e3 * p.position[k].y + 15.0, 1e3 * p.position[k].z + 20.0,
                             1e3 * p.diameter[k]);
  for (const Tetrahedron& t : tetrahedra_of(p.position, 6e-3))
    tetrahedra += fmt::format("{} {} {} {}\n", t[2], t[0], t[3], t[1]);
  const ScratchFolder folder;
  replace_file(folder / "geo-data-particles.dat", particles);
  replace_file(folder / "geo-data-tets.dat", tetrahedra);
  config.bodies[0].shape = "file";
  config.bodies[0].file = "geo-data-tets.dat";
  config.bodies[0].center = {-0.015, -0.015, -0.02};
  const dem::Model read = build_model(config, folder.path());

  ASSERT_EQ(read.size(), placed.size());
  ASSERT_EQ(read.facets.size(), placed.facets.size());
  for (std::size_t e = 0; e < read.mass.size(); ++e) {
    EXPECT_NEAR(norm(read.position[e] - placed.position[e]), 0.0, 1e-15);
    EXPECT_NEAR(read.mass[e] / placed.mass[e], 1.0, 1e-10);
    EXPECT_NEAR(read.inertia[e] / placed.inertia[e], 1.0, 1e-10);
  }
  for (std::size_t f = 0; f < read.facets.size(); ++f) {
    EXPECT_EQ(read.facets[f].a, placed.facets[f].a);
    EXPECT_NEAR(norm(read.facets[f].center - placed.facets[f].center), 0.0, 1e-14);
  }
}

std::string three(const Vec3& v, double unit = 1.0) {
  return fmt::format("{:.10g} {:.10g} {:.10g}", unit * v.x, unit * v.y, unit * v.z);
}

/// A body with its facets as preprocessors write them: ten digits, in mm.
struct FacetFiles {
  std::vector<Vec3> position;
  std::vector<Tetrahedron> tetrahedra;
  std::vector<LdpmFacet> facets;  ///< of the tetrahedra in order, twelve each
  std::string nodes, particles, tets, rows, corners, vtk;

  FacetFiles() {
    const Container box{.shape = Container::Shape::box, .size = {0.03, 0.03, 0.04}};
    const LdpmParticles p = place_particles(box, MixDesign{}, {1, 0});
    position = p.position;
    std::vector<double> diameter = p.diameter;
    for (double& d : diameter)
      if (d == 0.0) d = surface_diameter * 6e-3;
    tetrahedra = tetrahedra_of(position, 6e-3);
    for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
      const Tetrahedron& of = tetrahedra[t];
      tets += fmt::format("{} {} {} {}\n", of[1], of[0], of[3], of[2]);
      for (const LdpmFacet& f : facets_of(position, diameter, {of})) add(t, f);
    }
    for (std::size_t k = 0; k < position.size(); ++k) {
      nodes += three(position[k], 1e3) + "\n";
      particles += fmt::format("{} {} {}\n", k, three(position[k], 1e3), 1e3 * p.diameter[k]);
    }
    vtk = fmt::format(
        "# vtk DataFile Version 2.0\nmesh\nASCII\nDATASET UNSTRUCTURED_GRID\n"
        "POINTS {} double\n{}\nCELLS {} {}\n",
        position.size(), nodes, tetrahedra.size(), 5 * tetrahedra.size());
    for (const Tetrahedron& of : tetrahedra)
      vtk += fmt::format("4 {} {} {} {}\n", of[0], of[1], of[2], of[3]);
  }
  void add(std::size_t t, const LdpmFacet& f) {
    const std::size_t first = 3 * facets.size();
    const bool swap = facets.size() % 2 == 1;  // as windings ask for it
    for (const std::size_t k : {0, swap ? 2 : 1, swap ? 1 : 2})
      corners += three(f.corners[k], 1e3) + "\n";
    const Vec3 along = position[breccia::at(f.b)] - position[breccia::at(f.a)];
    double volume = 0.0;
    for (const Index e : {f.a, f.b})
      volume +=
          std::abs(six_volumes(position[breccia::at(e)], f.corners[0], f.corners[1], f.corners[2]));
    rows += fmt::format("{} {} {} {} {:.10g} {:.10g} {} {} 1 0 0 0 1 0 0\n", t, first, first + 1,
                        first + 2, 1e9 * volume / 6.0, 1e6 * f.area, three(f.center, 1e3),
                        three((1.0 / norm(along)) * along));
    facets.push_back(f);
  }
  LdpmMesh read(const std::string& end) const {
    const ScratchFolder folder;
    const auto write = [&](const std::string& name, const std::string& content) {
      if (!content.empty()) replace_file(folder / ("geo" + name), content);
    };
    write("-data-nodes.dat", nodes);
    write("-data-particles.dat", particles);
    write("-data-tets.dat", tets);
    write("-data-facets.dat", rows);
    write("-data-facetsVertices.dat", corners);
    write("-para-mesh.000.vtk", vtk);
    return read_ldpm_mesh(folder / ("geo" + end));
  }
};

void expect_equal(const LdpmMesh& read, const FacetFiles& written) {
  std::vector<LdpmFacet> facets = written.facets;
  std::stable_sort(facets.begin(), facets.end(), [](const LdpmFacet& p, const LdpmFacet& q) {
    return std::pair(p.a, p.b) < std::pair(q.a, q.b);
  });
  EXPECT_EQ(read.tetrahedra, written.tetrahedra);
  ASSERT_EQ(read.facets.size(), facets.size());
  for (std::size_t k = 0; k < facets.size(); ++k) {
    const LdpmFacet &f = read.facets[k], &g = facets[k];
    EXPECT_EQ((std::array{f.a, f.b, f.c, f.d}), (std::array{g.a, g.b, g.c, g.d}));
    EXPECT_NEAR(norm(f.center - g.center), 0.0, 1e-11);
    EXPECT_NEAR(f.area, g.area, 1e-13);
  }
  const auto cells = cells_of(written.position, facets),
             found = cells_of(read.position, read.facets);
  for (std::size_t e = 0; e < cells.size(); ++e)
    EXPECT_NEAR(found[e].volume / cells[e].volume, 1.0, 1e-8) << e;
}

TEST(LdpmMeshFile, takes_facets_as_their_files_have_them) {
  FacetFiles files;
  expect_equal(files.read("-data-facets.dat"), files);
  expect_equal(files.read("-data-facetsVertices.dat"), files);
  files.particles.clear();
  expect_equal(files.read("-data-facets.dat"), files);
  files.tets.clear();
  files.nodes.clear();
  expect_equal(files.read("-data-facets.dat"), files);
  expect_equal(files.read("-data-facetsVertices.dat"), files);
}

/// Their numbers, not those of their corners, are the model's.
TEST(LdpmMeshFile, keeps_area_and_centroid_of_a_facet) {
  FacetFiles files;
  files.facets[5].area *= 1.0005;
  files.facets[5].center.x += 1e-6;
  files.rows.clear();
  files.corners.clear();
  const std::vector<LdpmFacet> facets = std::exchange(files.facets, {});
  for (std::size_t k = 0; k < facets.size(); ++k) files.add(k / 12, facets[k]);
  expect_equal(files.read("-data-facets.dat"), files);
}

TEST(LdpmMeshFile, names_the_facet_that_does_not_belong_to_its_tetrahedron) {
  const auto refused = [](const FacetFiles& files, const std::string& end,
                          const std::string& part) {
    try {
      files.read(end);
      ADD_FAILURE() << part;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  const FacetFiles good;
  const std::string facets = "-data-facets.dat", corners = "-data-facetsVertices.dat";
  const auto with_row = [&](std::size_t column, const std::string& text) {
    FacetFiles files = good;
    std::size_t begin = 0;
    for (std::size_t k = 0; k < column; ++k) begin = files.rows.find(' ', begin) + 1;
    files.rows.replace(begin, files.rows.find_first_of(" \n", begin) - begin, text);
    return files;
  };
  refused(with_row(0, "-1"), facets, "geo-data-facets.dat, line 1 is not a facet: one of");
  refused(with_row(2, "1e9"), facets, "line 1 is not a facet");
  refused(with_row(0, "1"), facets, "tetrahedron 0 has 11 facets instead of 12");
  refused(with_row(9, "7"), facets, "along no edge of tetrahedron 0");
  refused(with_row(4, "1e3"), facets, "its volume of 1000 mm3 is not the");
  refused(with_row(5, "1e3"), facets, "its projected area of 1000 mm2 is not the");
  refused(with_row(18, "2"), facets, "line 2: flag of material 0 after 2");
  FacetFiles files = good;
  files.rows.erase(0, files.rows.find('\n') + 1);
  refused(files, facets, "tetrahedron 0 has 11 facets instead of 12");
  files = good;
  files.corners.erase(0, files.corners.find('\n') + 1);
  refused(files, corners, "corners of facets instead of 36 for each of");
  files.corners += "0 0 0\n";
  refused(files, corners, "lie on no edge of tetrahedron");
  files = good;
  files.tets.clear();
  files.vtk = files.vtk.substr(0, files.vtk.find("CELLS"));
  refused(files, facets, "a mesh of tetrahedra in legacy VTK (text) has no CELLS");
  files.vtk += "CELLS 1 5\n4 0 1 2 2\n";
  refused(files, facets, "has no cell 0 as four different particles");
  files.vtk.clear();
  EXPECT_THROW(files.read(facets), IoError);
}

}  // namespace ldpm_mesh_file_test
}  // namespace breccia::prepare
