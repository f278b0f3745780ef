#pragma once
// A method over a world: what is the same for all of them.

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/probe.hpp"
#include "core/unsound.hpp"
#include "exec/error.hpp"
#include "run/frame_parts.hpp"
#include "run/method.hpp"
#include "run/shared_world.hpp"

namespace breccia {

template <class World>
std::uint64_t hash_of(const World& w) {
  return state_hash(w);
}

/// @tparam World  with held, balance, probe, read_own, find_unsound and state_hash beside it
template <class World>
class WorldMethod : public Method {
 public:
  template <class Make>
  WorldMethod(const Make& make, const Exec& exec, Communicator* ranks, const CaseConfig& config)
      : world_(make, exec, ranks, config.domain), probes_(config.probes) {}

  Advanced advance(const StopAt& stop) override { return world_.advance_to(stop); }
  std::int64_t steps() const override { return world_.part().step; }
  double time() const override { return world_.part().time; }
  double time_step() const override {
    const World& w = world_.part();
    return w.step > 0 ? w.last_dt : w.next_dt;
  }

  EnergyBalance energy() override {
    World& w = world_.part();
    Energies all = held(w);
    if (!alone()) {
      Message message;
      put_value(message, all);
      put_value(message, std::exchange(w.ledger, {}));  // rank 0 keeps what has been booked
      all = {};
      for (const Message& told : world_.told(std::move(message))) {
        Unpacking from(told);
        all = all + from.value<Energies>();
        world_.ledger().add(from.value<Ledger>());
      }
    }
    return leads(world_.ranks()) ? balance_of(all) : EnergyBalance{};
  }
  std::vector<double> probes() override {
    World& w = world_.part();
    std::vector<double> values;
    if (alone()) {
      for (const ProbeConfig& p : probes_) values.push_back(probe(w, p));
      return values;
    }
    Message message;
    for (const ProbeConfig& p : probes_) put_value(message, read_own(w, p));
    std::vector<Readings> all(probes_.size());
    for (const Message& told : world_.told(std::move(message))) {
      Unpacking from(told);
      for (Readings& readings : all) readings = readings + from.value<Readings>();
    }
    for (std::size_t i = 0; i < all.size(); ++i)
      values.push_back(all[i].reduced(probes_[i].reduce));
    return values;
  }
  std::uint64_t state_hash() override {
    return world_.of_whole([](World& w) { return hash_of(w); });
  }
  void verify() override {
    Unsound first = find_unsound(world_.part());
    if (!alone()) {
      Message message;
      put_value(message, first.id);
      put_array(message, std::vector<char>(first.text.begin(), first.text.end()));
      for (const Message& told : world_.told(std::move(message))) {
        Unpacking from(told);
        const auto id = from.value<GlobalId>();
        const std::vector<char> text = from.array<char>();
        if (id < first.id) first = {id, {text.begin(), text.end()}};
      }
    }
    on_first(world_.ranks(), [&] {
      if (first.id != Unsound::none) throw NumericsError(first.text);
    });
  }
  Frame frame() override {
    return world_.of_whole([this](World& w) { return part_of_frame(w).frame; });
  }
  FrameOutput frame_output(const FrameWish& wish) override {
    const World& w = world_.part();
    const int threads = w.exec.threads;
    if (alone()) return breccia::frame_output(part_of_frame(w).frame, wish, threads);
    FrameOutput output;
    at_once(world_.ranks(), [&] {
      output = FrameOfParts(part_of_frame(w), wish, *world_.ranks(), threads).output();
    });
    return output;
  }

 protected:
  /// A copy whose steps are not booked.
  WorldMethod(const WorldMethod& other) : Method(), world_(other.world_), probes_(other.probes_) {
    world_.forget_timers();
  }

  /// Where the energy of the whole is. Rank 0 only.
  virtual EnergyBalance balance_of(const Energies& all) = 0;
  /// A frame of the whole, or what a part has of it.
  virtual FramePart part_of_frame(const World& part) const = 0;

  SharedWorld<World> world_;

 private:
  bool alone() const { return world_.ranks() == nullptr; }

  std::vector<ProbeConfig> probes_;
};

}  // namespace breccia
