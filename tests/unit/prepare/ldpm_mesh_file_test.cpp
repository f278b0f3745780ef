// Particles and tetrahedra of LDPM from the files of public preprocessors.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "prepare/build.hpp"
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

/// A body that was placed here, written as a preprocessor does and read, is the same model.
TEST(LdpmMeshFile, of_a_body_gives_the_model_of_the_body) {
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
  const dem::Model placed = build_model(config, "");

  const Container box{.shape = Container::Shape::box, .size = body.size};
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

}  // namespace ldpm_mesh_file_test
}  // namespace breccia::prepare
