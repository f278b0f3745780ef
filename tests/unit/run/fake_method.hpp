#pragma once
// A method without physics: a few oscillators whose runs can be spoiled, interrupted, slowed down.

#include <signal.h>

#include <array>
#include <bit>
#include <chrono>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "exec/error.hpp"
#include "run/method/method.hpp"

namespace breccia {

/// Faults to come in a run of the fake method.
struct Trouble {
  std::int64_t spoil_at = -1;       ///< verify() fails from this step on
  std::int64_t flip_at = -1;        ///< the first time that this step is done, a bit of it is wrong
  std::int64_t flip_force_at = -1;  ///< likewise, of what acts from the next step on
  std::int64_t flip_constant_at = -1;  ///< a number that no step changes is another from then on
  std::int64_t lose_at = -1;       ///< this step fails and knows no more than an element's place
  std::int64_t no_memory_at = -1;  ///< the arrays of this step are not all made
  std::int64_t signal_at = -1;     ///< the process gets `signal` during this step
  int signal = SIGTERM;
  double pause = 0.0;               ///< wall time a step takes  [s]
  std::vector<std::string> doubts;  ///< of set-up
};

class FakeMethod : public Method {
 public:
  FakeMethod() = default;
  explicit FakeMethod(const Trouble& trouble) : trouble_(trouble) {}

  static constexpr double dt = 0.01;  ///<  [s]

  Advanced advance(const StopAt&) override {
    if (trouble_.pause > 0.0)
      std::this_thread::sleep_for(std::chrono::duration<double>(trouble_.pause));
    // dt changes from step to step, so that a schedule that moved it would be seen.
    last_step_ = dt * (1.0 + 0.1 * position_[0]);
    for (std::size_t i = 0; i < position_.size(); ++i) {
      velocity_[i] -= last_step_ * static_cast<double>(i + 1) * position_[i];
      position_[i] += last_step_ * velocity_[i];
    }
    time_ += last_step_;
    ++steps_;
    force_ = -position_[0];
    if (steps_ == trouble_.flip_force_at) {
      force_ += 1e-12;
      trouble_.flip_force_at = -1;
    }
    if (steps_ == trouble_.flip_constant_at) mass_ = 1.0000001;
    if (steps_ == trouble_.flip_at) {
      position_[2] = std::bit_cast<double>(std::bit_cast<std::uint64_t>(position_[2]) ^ 1);
      trouble_.flip_at = -1;
    }
    if (steps_ == trouble_.lose_at) throw NumericsError("the element at place 3 is lost");
    if (steps_ == trouble_.no_memory_at) throw std::bad_alloc();
    if (steps_ == trouble_.signal_at) ::raise(trouble_.signal);
    return {1, last_step_, last_step_};
  }
  std::int64_t steps() const override { return steps_; }
  double time() const override { return time_; }
  double time_step() const override { return last_step_; }

  std::vector<std::string> warnings() override { return trouble_.doubts; }
  EnergyBalance energy() override {
    EnergyBalance energy;
    for (std::size_t i = 0; i < position_.size(); ++i) {
      energy.kinetic += 0.5 * velocity_[i] * velocity_[i];
      energy.elastic += 0.5 * static_cast<double>(i + 1) * position_[i] * position_[i];
    }
    return energy;
  }
  std::vector<double> probes() override { return {position_[0]}; }
  std::uint64_t state_hash() override {
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < position_.size(); ++i)
      hash = hash * 1099511628211ULL + std::bit_cast<std::uint64_t>(position_[i]) +
             std::bit_cast<std::uint64_t>(velocity_[i]);
    return hash;
  }
  void verify() override {
    if (trouble_.spoil_at >= 0 && steps_ >= trouble_.spoil_at)
      throw NumericsError("step " + std::to_string(steps_) + ": element 3 is not a number");
  }
  Frame frame() override {
    Frame frame;
    frame.step = steps_;
    frame.time = time_;
    FrameField damage{"damage", "-", 1, {}};
    for (std::size_t i = 0; i < position_.size(); ++i) {
      frame.position.push_back({static_cast<double>(i), position_[i], 0.0});
      frame.radius.push_back(0.5);
      damage.values.push_back(0.25F * static_cast<float>(i));
    }
    frame.point_fields.push_back(damage);
    return frame;
  }
  std::vector<Fact> facts() override {
    return {{"model.elements", 4.0},
            {"model.elements_by_group.bars", 4.0},
            {"searches", 2.0},
            {"fracture.broken_links", 0.0}};
  }
  void save(CheckpointWriter& writer) override {
    writer.value("fake.position", position_);
    writer.value("fake.velocity", velocity_);
    writer.value("fake.force", force_);
    writer.value("fake.mass", mass_);
    writer.value("fake.time", time_);
    writer.value("fake.last_step", last_step_);
    writer.value("fake.steps", steps_);
  }
  std::vector<std::string> constants() const override { return {"fake.mass"}; }
  void load(const CheckpointReader* reader) override {
    mass_ = reader->value<double>("fake.mass");
    position_ = reader->value<State>("fake.position");
    velocity_ = reader->value<State>("fake.velocity");
    time_ = reader->value<double>("fake.time");
    last_step_ = reader->value<double>("fake.last_step");
    steps_ = reader->value<std::int64_t>("fake.steps");
  }
  /// A bit of the memory flips while nobody works with it.
  void flip_at_rest() {
    velocity_[1] = std::bit_cast<double>(std::bit_cast<std::uint64_t>(velocity_[1]) ^ 1);
  }

 private:
  using State = std::array<double, 4>;
  Trouble trouble_;
  State position_{1.0, -0.5, 0.25, 0.125};
  State velocity_{};
  double force_ = 0.0, mass_ = 1.0;
  double time_ = 0.0, last_step_ = dt;
  std::int64_t steps_ = 0;
};

}  // namespace breccia
