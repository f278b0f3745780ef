#pragma once
// A state with every kind of array, for the tests of checkpoints.

#include <cstdio>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "io/checkpoint.hpp"

namespace breccia::checkpoint_test {

struct State {
  Buffer<double> mass;
  Buffer<Vec3> position;
  Buffer<std::uint8_t> fixed;
  Buffer<std::int64_t> id;
  Vec3Planes shear;
  template <class Visit>
  void each_field(Visit&& field) {
    field("mass", "kg", mass);
    field("position", "m", position);
    field("fixed", "-", fixed);
    field("id", "-", id);
    field("shear", "N", shear);
  }
};

inline State example(Index count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  State s;
  resize_fields(s, count);
  for (Index i = 0; i < count; ++i) {
    s.mass.data()[i] = uniform(random);
    s.position.data()[i] = {uniform(random), uniform(random), uniform(random)};
    s.fixed.data()[i] = static_cast<std::uint8_t>(random() & 63U);
    s.id.data()[i] = i;
    s.shear.view().store(i, {uniform(random), uniform(random), uniform(random)});
  }
  return s;
}

inline void write_example(const std::string& path, Index count = 100, unsigned seed = 1) {
  CheckpointWriter writer;
  State s = example(count, seed);
  writer.value("step", std::int64_t{42});
  writer.value("time", 0.5);
  writer.text("case", "seed = 1\n");
  writer.fields("elements", s);
  State nothing;
  writer.fields("nothing", nothing);
  writer.write(path);
}

inline std::vector<char> content_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
inline void write_content(const std::string& path, const std::vector<char>& bytes) {
  std::remove(path.c_str());  // a file that is cut to nothing and closed again waits for the disk
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace breccia::checkpoint_test
