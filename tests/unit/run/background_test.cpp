// Output by another thread: order, errors, and states that stay as they were.

#include "run/machine/background.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>
#include <vector>

#include "physics/fdem/scene.hpp"
#include "run/method/fdem_method.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace background_test {

using fdem::testing::Scene;

TEST(Background, DoesPiecesInOrderWhileTheGiverGoesOn) {
  std::vector<int> done;
  const auto giver = std::this_thread::get_id();
  bool elsewhere = true;
  Background background;
  for (int k = 0; k < 5; ++k)
    background.add([&, k] {
      std::this_thread::sleep_for(std::chrono::milliseconds(5 - k));
      elsewhere = elsewhere && std::this_thread::get_id() != giver;
      done.push_back(k);
    });
  background.finish();
  EXPECT_EQ(done, (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_TRUE(elsewhere);
}

TEST(Background, TellsOfAnErrorBeforeTheNextPieceBegins) {
  Background background;
  background.add([] { throw std::runtime_error("the disk is full"); });
  bool begun = false;
  EXPECT_THROW(background.add([&] { begun = true; }), std::runtime_error);
  EXPECT_FALSE(begun);
  background.finish();  // told once
}

TEST(Background, IsWaitedForWhereItEnds) {
  bool done = false;
  {
    Background background;
    background.add([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      done = true;
    });
  }
  EXPECT_TRUE(done);
}

/// A disc that flies.
std::unique_ptr<Method> flying(Space space) {
  Scene scene;
  scene.material(30e9, 0.2, 2500.0);
  scene.body("disc", prepare::ringed_disc({0.0, 0.0}, 0.02, 4e-3), 0, {2.0, -60.0});
  Exec exec;
  exec.space = space;
  return make_method(scene.config, scene.model, exec, nullptr);
}
std::string saved(Method& method) {
  const ScratchFolder folder;
  const std::string path = folder / "snapshot.br";
  CheckpointWriter writer;
  method.save(writer);
  writer.write(path);
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  return bytes;
}

TEST(Snapshot, StaysAsItWasWhileTheRunGoesOn) {
  const auto method = flying(Space::shadow);
  while (method->steps() < 10) method->advance({1e300, 10});
  const std::uint64_t hash = method->state_hash();
  const std::string bytes = saved(*method);
  const auto then = method->snapshot();
  ASSERT_NE(then, nullptr);
  while (method->steps() < 20) method->advance({1e300, 20});
  EXPECT_NE(method->state_hash(), hash);
  EXPECT_EQ(then->steps(), 10);
  EXPECT_EQ(then->state_hash(), hash);
  EXPECT_EQ(saved(*then), bytes);
  EXPECT_EQ(then->frame().position.size(), method->frame().position.size());
  EXPECT_NE(then->frame().position[0].y, method->frame().position[0].y);
}

TEST(Snapshot, IsNotMadeOnTheHost) {
  EXPECT_EQ(flying(Space::host)->snapshot(), nullptr);
}

TEST(Snapshot, IsNotMadeAtTheEndOfARun) {
  const auto method = flying(Space::shadow);
  EXPECT_NE(snapshot_of(*method, Then::steps), nullptr);
  EXPECT_EQ(snapshot_of(*method, Then::end), nullptr);
}

}  // namespace background_test
}  // namespace breccia
