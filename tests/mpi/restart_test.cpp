// A run is saved at any step on some ranks and threads and goes on from there on others: random
// pairs, the end of each equal to that of the uninterrupted run.

#include <gtest/gtest.h>

#include "core/state_hash.hpp"
#include "mpi/on_ranks.hpp"
#include "run/method/audited_method.hpp"

namespace breccia {
namespace restart_test {

using namespace mpi_testing;

/// How many processors a part of a run gets.
struct Team {
  int ranks, threads;
};

template <class AScene>
void expect_equal_ends(const AScene& scene, int pairs, int end, std::uint64_t seed) {
  const Folder folder("restart");
  const std::string state = folder.file("state.br");
  const Outcome whole = alone(scene, end);
  EXPECT_GT(whole.cracks, 20U);
  const auto draw = [&seed](int least, int most) {
    seed += 0x9e3779b97f4a7c15ULL;
    return least + static_cast<int>(mixed(seed) % static_cast<std::uint64_t>(most - least + 1));
  };
  for (int pair = 0; pair < pairs; ++pair) {
    const Team before{draw(1, 12), draw(1, 3)}, after{draw(1, 12), draw(1, 3)};
    const int middle = draw(1, end - 1);
    on_all_ranks(before.ranks, before.threads, scene, [&](Method& method, bool first) {
      while (method.steps() < middle) method.advance({1e300, middle});
      save(method, first, state);
      return true;
    });
    const auto hash = on_all_ranks(after.ranks, after.threads, scene, [&](Method& method, bool) {
      const CheckpointReader saved(state);
      method.load(&saved);
      EXPECT_EQ(method.steps(), middle);
      while (method.steps() < end) method.advance({1e300, end});
      return method.state_hash();
    });
    EXPECT_EQ(hash, whole.hash) << "pair " << pair << ": saved at step " << middle << " on "
                                << before.ranks << " ranks of " << before.threads
                                << " threads, continued on " << after.ranks << " of "
                                << after.threads;
  }
}

TEST(RestartOnRanks, steps_that_are_done_twice_change_no_bit) {
  const auto scene = impact("intrinsic");
  const Outcome whole = alone(scene, 200);
  simulate_ranks(5, 77, [&](Communicator& ranks) {
    const auto method = audited(method_of(scene, Exec{}, &ranks), AuditConfig{9}, 1, &ranks);
    while (method->steps() < 200) method->advance({1e300, 200});
    const std::uint64_t hash = method->state_hash();
    double repeated = 0.0;
    for (const Fact& fact : method->facts())
      if (fact.path == "audit.repeated_steps") repeated = fact.value;
    if (ranks.rank() != 0) return;
    EXPECT_EQ(hash, whole.hash);
    EXPECT_GT(repeated, 12.0);
  });
}
TEST(RestartOnRanks, spheres_end_alike_for_forty_pairs) {
  expect_equal_ends(slab_piece(), 40, 120, 1);
}
TEST(RestartOnRanks, triangles_that_crack_end_alike_for_forty_pairs) {
  expect_equal_ends(impact("intrinsic"), 40, 160, 2);
}
TEST(RestartOnRanks, triangles_that_move_as_one_end_alike_for_twenty_pairs) {
  expect_equal_ends(impact("extrinsic"), 20, 160, 3);
}

}  // namespace restart_test
}  // namespace breccia
