#pragma once
// Scenes of boxes for tests of the search, and the answer by comparing every box with every other.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/broad_phase.hpp"

namespace breccia::scenes {

/// A stream of numbers that is the same on every machine (SplitMix64).
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(bits() >> 11) / 9007199254740992.0;
  }
  Index below(Index count) { return static_cast<Index>(bits() % static_cast<unsigned>(count)); }
  Vec3 inside(double half) {
    return {uniform(-half, half), uniform(-half, half), uniform(-half, half)};
  }

 private:
  std::uint64_t state_;
};

/// Boxes with their global ids.
struct Scene {
  std::vector<Box> boxes;
  std::vector<GlobalId> ids;

  void add(const Vec3& centre, const Vec3& half) {
    boxes.push_back({centre - half, centre + half});
    ids.push_back(static_cast<GlobalId>(ids.size()));
  }
  void add(const Vec3& centre, double half) { add(centre, {half, half, half}); }
};

/// Gives the elements ids with gaps, in no order.
inline void shuffle_ids(Scene& scene, RandomStream& random) {
  for (std::size_t i = 0; i < scene.ids.size(); ++i)
    scene.ids[i] = static_cast<GlobalId>(7 * i + 3);
  for (std::size_t i = scene.ids.size(); i > 1; --i)
    std::swap(scene.ids[i - 1],
              scene.ids[static_cast<std::size_t>(random.below(static_cast<Index>(i)))]);
}

/// A pair as the search must give it.
struct Expected {
  PairKey key;
  Index a, b;
  bool operator==(const Expected&) const = default;
};

inline bool share_a_point(const Box& a, const Box& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

inline std::vector<Expected> all_against_all(const Scene& scene) {
  std::vector<Expected> pairs;
  for (std::size_t i = 0; i < scene.boxes.size(); ++i)
    for (std::size_t j = i + 1; j < scene.boxes.size(); ++j)
      if (share_a_point(scene.boxes[i], scene.boxes[j])) {
        const bool in_order = scene.ids[i] < scene.ids[j];
        pairs.push_back({pair_key(scene.ids[i], scene.ids[j]), static_cast<Index>(in_order ? i : j),
                         static_cast<Index>(in_order ? j : i)});
      }
  std::sort(pairs.begin(), pairs.end(),
            [](const Expected& a, const Expected& b) { return a.key < b.key; });
  return pairs;
}

template <class T>
Buffer<T> buffer_of(const std::vector<T>& items, Space space = Space::host) {
  Buffer<T> buffer(space);
  copy_to(buffer, items);
  return buffer;
}

inline std::vector<Expected> listed(const Pairs& pairs) {
  const Pairs host = host_copy(pairs);
  std::vector<Expected> list;
  for (Index i = 0; i < host.size(); ++i)
    list.push_back({host.key.data()[i], host.a.data()[i], host.b.data()[i]});
  return list;
}

/// Pairs that the search finds; `tested` gets its cost.
inline std::vector<Expected> search(const Scene& scene, const Exec& exec = {},
                                    std::int64_t* tested = nullptr) {
  BroadPhase broad_phase(exec.space);
  Pairs pairs(exec.space);
  broad_phase.search(exec, buffer_of(scene.boxes, exec.space), buffer_of(scene.ids, exec.space),
                     pairs);
  if (tested != nullptr) *tested = broad_phase.tested(exec);
  return listed(pairs);
}

}  // namespace breccia::scenes
