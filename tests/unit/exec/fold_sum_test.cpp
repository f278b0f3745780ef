#include "exec/fold_sum.hpp"

#include <gtest/gtest.h>

#include "core/energy.hpp"

namespace breccia {
namespace fold_sum_test {

struct Kinetic {
  double of_each;
  BR_HD void add_to(Energies& sum, Index i) const { sum.kinetic.add(of_each * i); }
};
struct Potential {
  BR_HD Energies operator()(Index i) const {
    Energies one;
    one.potential.add(-0.1 * i);
    return one;
  }
};

TEST(FoldSum, is_the_sum_of_the_folds_of_all_kernels) {
  for (const Space space : {Space::host, Space::shadow})
    for (const int threads : {1, 3}) {
      Exec exec;
      exec.space = space;
      exec.threads = threads;
      constexpr Index count = 30000;
      FoldSum<Energies> all(exec);
      all.add(count, Kinetic{0.1});
      all.add(0, Kinetic{1e30});
      all.add(count / 3, Potential{});
      EXPECT_EQ(all.sum().kinetic.value(),
                fold(exec, count, Energies{}, Kinetic{0.1}, Sum{}).kinetic.value());
      all.add(count, Kinetic{0.3});  // goes on after it was asked
      const Energies one = fold(exec, count, Energies{}, Kinetic{0.1}, Sum{}),
                     two = fold(exec, count, Energies{}, Kinetic{0.3}, Sum{}),
                     low = fold(exec, count / 3, Energies{}, Potential{}, Sum{});
      EXPECT_EQ(all.sum().kinetic.value(), (one + two).kinetic.value());
      EXPECT_EQ(all.sum().potential.value(), low.potential.value());
      EXPECT_LT(low.potential.value(), 0.0);
    }
}

}  // namespace fold_sum_test
}  // namespace breccia
