// Memory of a run of tetrahedra: what set-up, output and the end of a run hold beside the world.

#include "exec/memory.hpp"

#include <gtest/gtest.h>

#include "io/checkpoint.hpp"
#include "physics/fdem3/scene.hpp"
#include "run/method/fdem3_method.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace fdem3_memory_test {

using fdem3::testing::Scene;

std::size_t alive_in(Space space) {
  forget_peak_of_arrays(space);
  return peak_array_bytes(space);
}

/// A box of 16,464 joined tetrahedra, few of them at its border.
Scene whole_box() {
  Scene scene;
  fdem3::MaterialConfig& m = scene.material(30e9, 0.2, 2500.0);
  m.joints = "intrinsic";
  m.joint.tension = m.joint.cohesion = 1e7;
  m.joint.energy_open = m.joint.energy_slide = 50.0;
  scene.body("box", fdem3::testing::box({}, {0.14, 0.14, 0.14}, 0.01));
  return scene;
}

/// The most that the work of a method takes in a space, over its arrays less 1.  [-]
struct Taken {
  double set_up, output;
};
Taken taken(Space space) {
  const Scene scene = whole_box();
  const std::size_t before = alive_in(space);
  const auto most = [&] { return static_cast<double>(peak_array_bytes(space) - before); };
  Exec exec;
  exec.space = space;
  const auto method = make_method(scene.config, scene.model, exec, nullptr);
  method->facts();  // as the summary has them before the first step
  const double by_set_up = most();
  const auto world = static_cast<double>(alive_in(space) - before);
  method->advance({1e300, 2});
  const ScratchFolder folder;
  CheckpointWriter writer(CheckpointWriter::Arrays::left);
  method->save(writer);
  writer.write(folder / "state.br");
  method->facts();
  method->tables();
  method->frame_output({});
  return {by_set_up / world - 1.0, most() / world - 1.0};
}

/// Whatever they read they copy to the host, and of what lies there no more than an array.
TEST(Fdem3Memory, of_set_up_and_output_is_a_small_part_of_the_worlds) {
  for (const Space space : {Space::host, Space::shadow}) {
    const Taken of = taken(space);
    EXPECT_LT(of.set_up, 0.25) << static_cast<int>(space);
    EXPECT_LT(of.output, 0.25) << static_cast<int>(space);
  }
}

}  // namespace fdem3_memory_test
}  // namespace breccia
