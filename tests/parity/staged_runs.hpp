#pragma once
// Runs of cases with stages on threads, a device's schedule, ranks, and resumed.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "domain/simulated_ranks.hpp"
#include "run/method/dem_method.hpp"
#include "run/method/fdem3_method.hpp"
#include "run/method/fdem_method.hpp"
#include "run/stage_control.hpp"

namespace breccia::testing {

inline void run_to(Method& method, const CaseConfig& config, Communicator* ranks) {
  StageControl stages(method, config.probes, "", ranks);
  while (!stages.finished()) {
    method.advance(stages.limited({1.0, method.steps() + 37}));
    stages.look();
  }
}

template <class Scene>
std::uint64_t end_of(const Scene& s, Exec exec = {}, Communicator* ranks = nullptr) {
  const auto method = make_method(s.config, s.model, exec, ranks);
  run_to(*method, s.config, ranks);
  return method->state_hash();
}

template <class Scene>
void expect_alike(const Scene& s) {
  const std::uint64_t host = end_of(s);
  Exec threads, shadow;
  threads.threads = 3;
  shadow.space = Space::shadow;
  EXPECT_EQ(end_of(s, threads), host);
  EXPECT_EQ(end_of(s, shadow), host);
  for (const Space space : {Space::host, Space::shadow})
    simulate_ranks(3, 5, [&](Communicator& ranks) {
      Exec own;
      own.space = space;
      const std::uint64_t hash = end_of(s, own, &ranks);
      if (ranks.rank() == 0) {
        EXPECT_EQ(hash, host) << "3 ranks" << (space == Space::shadow ? " by launches" : "");
      }
    });
}

/// Saved at three times; continued alone from each, and on ranks from the second.
template <class Scene>
void expect_resumed(const Scene& s) {
  const std::uint64_t whole = end_of(s);
  const std::string path =
      std::filesystem::temp_directory_path() / ("staged_" + std::to_string(::getpid()) + ".br");
  double end = 0.0;
  for (const auto& stage : s.config.stages) end += stage.until;
  const auto saved = make_method(s.config, s.model, {}, nullptr);
  StageControl stages(*saved, s.config.probes, "", nullptr);
  for (const double share : {0.2, 0.45, 0.9}) {
    while (saved->time() < share * end) {
      saved->advance(stages.limited({share * end, 1'000'000}));
      stages.look();
    }
    CheckpointWriter writer;
    saved->save(writer);
    writer.write(path);
    const CheckpointReader reader(path);
    const auto after = make_method(s.config, s.model, {}, nullptr);
    after->load(&reader);
    run_to(*after, s.config, nullptr);
    EXPECT_EQ(after->state_hash(), whole) << share;
    if (share != 0.45) continue;
    simulate_ranks(2, 5, [&](Communicator& ranks) {
      const auto on_ranks = make_method(s.config, s.model, {}, &ranks);
      on_ranks->load(ranks.rank() == 0 ? &reader : nullptr);
      run_to(*on_ranks, s.config, &ranks);
      const std::uint64_t hash = on_ranks->state_hash();
      if (ranks.rank() != 0) return;
      EXPECT_EQ(hash, whole) << share << " on two ranks";
    });
  }
  std::filesystem::remove(path);
}

}  // namespace breccia::testing
