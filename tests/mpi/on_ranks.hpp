#pragma once
// A scene alone and on simulated ranks; a run saved on some and continued on others.

#include <filesystem>
#include <fstream>

#include "domain/simulated_ranks.hpp"
#include "mpi/scenes.hpp"

namespace breccia::mpi_testing {

template <class AScene>
Outcome alone(const AScene& scene, int steps) {
  auto w = scene.world();
  for (int i = 0; i < steps; ++i) step(w);
  return outcome_of(w);
}

/// The outcome, and how rank 0 fared.
struct Shared {
  Outcome outcome;
  DomainCounts counts;
};
template <class AScene>
Shared on_ranks(int count, const AScene& scene, int steps, const DomainConfig& config = {},
                int threads = 1, Space space = Space::host) {
  Shared shared;
  const auto world = scene.world(threads);  // built once: a copy takes each rank far less time
  simulate_ranks(count, static_cast<std::uint64_t>(count), [&](Communicator& ranks) {
    auto whole = world;
    auto part = share_out(whole, ranks, config, space);
    for (int i = 0; i < steps; ++i) step(part);
    collect(part, whole);
    if (ranks.rank() == 0) shared = {outcome_of(whole), part.domain.counts};
  });
  return shared;
}

/// A method on simulated ranks, each of which calls work(method, whether it is rank 0); returns the
/// result of rank 0.
template <class AScene, class Work>
auto on_all_ranks(int count, int threads, const AScene& scene, const Work& work,
                  Space space = Space::host) {
  decltype(work(std::declval<Method&>(), true)) result{};
  simulate_ranks(count, 77, [&](Communicator& ranks) {
    Exec exec;
    exec.threads = threads;
    exec.space = space;
    const auto method = method_of(scene, exec, count > 1 ? &ranks : nullptr);
    auto own = work(*method, ranks.rank() == 0);
    if (ranks.rank() == 0) result = std::move(own);
  });
  return result;
}

inline void save(Method& method, bool first, const std::string& path) {
  CheckpointWriter writer;
  method.save(writer);
  if (first) writer.write(path);
}

/// A folder that goes when the test ends.
class Folder {
 public:
  explicit Folder(const char* name)
      : path_(std::filesystem::temp_directory_path() /
              (std::string("breccia_") + name + "_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string file(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// State that a run leaves which is saved on the way, or continued from there.
struct Journal {
  std::string checkpoint, frame;
  std::uint64_t hash = 0;
  double friction = 0.0, error = 0.0;
  bool operator==(const Journal&) const = default;
};
template <class AScene>
Journal journal(int count, const AScene& scene, int saved_at, int end, const std::string& path,
                const std::string& from) {
  return on_all_ranks(count, 1, scene, [&](Method& method, bool first) {
    Journal j;
    if (!from.empty()) {
      const CheckpointReader state(from);
      method.load(&state);
    }
    while (method.steps() < saved_at) {
      method.advance({1e300, method.steps() + 1});
      if (method.steps() % 7 == 0) method.energy();  // looking changes nothing
    }
    save(method, first, path);
    if (first) {
      std::ifstream file(path, std::ios::binary);
      j.checkpoint.assign(std::istreambuf_iterator<char>(file), {});
    }
    while (method.steps() < end) method.advance({1e300, end});
    j.hash = method.state_hash();
    j.friction = method.energy().friction;
    j.error = method.energy().error_relative;
    for (const FrameField& field : method.frame().line_fields)
      j.frame.append(reinterpret_cast<const char*>(field.values.data()),
                     field.values.size() * sizeof(float));
    return j;
  });
}

}  // namespace breccia::mpi_testing
