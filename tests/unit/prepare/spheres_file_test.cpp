#include "prepare/packing/spheres_file.hpp"

#include <gtest/gtest.h>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia::prepare {
namespace spheres_file_test {

Spheres spheres_of(const std::string& text) {
  const ScratchFolder folder;
  replace_file(folder / "spheres.txt", text);
  return read_spheres(folder / "spheres.txt");
}

TEST(SpheresText, a_dump_of_lammps_or_liggghts_gives_its_last_snapshot) {
  const std::string head =
      "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n"
      "0 1\n0 1\n0 1\n";
  const Spheres s = spheres_of(head + "ITEM: ATOMS id type x y z radius\n1 1 9 9 9 9\n" + head +
                               "ITEM: ATOMS id type x y z vx diameter \n7 1 1 2 3 0.5 0.2\n");
  ASSERT_EQ(s.radius.size(), 1U);
  EXPECT_EQ(s.position[0].y, 2.0);
  EXPECT_EQ(s.radius[0], 0.1);
  EXPECT_THROW(spheres_of(head + "ITEM: ATOMS id x y z\n1 1 1 1\n"), InputError);
  EXPECT_THROW(spheres_of(head + "ITEM: ATOMS x y z radius\n1 1 1 -1\n"), InputError);
}

TEST(SpheresText, a_data_file_of_lammps_gives_its_atoms) {
  const std::string head = "made by hand\n\n2 atoms\n1 atom types\n\n0 1 xlo xhi\n\n";
  const std::string atoms = "1 1 0.2 2500 1 2 3 0 0 0\n\n2 1 0.4 2500 4 5 6 # last\n";
  const Spheres s =
      spheres_of(head + "Atoms # sphere\n\n" + atoms + "\nVelocities\n\n1 9 9 9 9 9 9\n");
  ASSERT_EQ(s.radius.size(), 2U);
  EXPECT_EQ(s.position[0].y, 2.0);
  EXPECT_EQ(s.radius[1], 0.2);
  EXPECT_EQ(spheres_of(head + "Atoms\n\n" + atoms).radius.size(), 2U);
  EXPECT_THROW(spheres_of(head + "Atoms # atomic\n\n1 1 0 0 0\n"), InputError);
  EXPECT_THROW(spheres_of(head + "Atoms\n\n1 1 0 0 0\n"), InputError);
  EXPECT_THROW(spheres_of(head + "Atoms\n\n1 1 -0.2 2500 1 2 3\n"), InputError);
}

TEST(SpheresText, a_list_of_yade_has_blanks_between_its_numbers) {
  const Spheres s = spheres_of("#format x_y_z_r\n0.1\t0.2\t0.3\t0.01\n0.4 0.5 0.6 0.02\n");
  ASSERT_EQ(s.radius.size(), 2U);
  EXPECT_EQ(s.position[1].x, 0.4);
  EXPECT_EQ(s.radius[1], 0.02);
  EXPECT_THROW(spheres_of("0.1 0.2 0.3 0.01\n0.1 0.2 0.3\n"), InputError);
}

TEST(SpheresText, commas_are_read_as_before) {
  EXPECT_EQ(spheres_of("x,y,z,radius\n0,0,0,0.5\n").radius.size(), 1U);
}

}  // namespace spheres_file_test
}  // namespace breccia::prepare
