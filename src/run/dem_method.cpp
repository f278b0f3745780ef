#include "run/dem_method.hpp"

#include "core/precision.hpp"
#include "dem/energy.hpp"
#include "dem/observe.hpp"
#include "dem/ranks.hpp"
#include "exec/error.hpp"
#include "run/looks.hpp"

namespace breccia {
namespace {

class DemMethod final : public Method {
 public:
  DemMethod(const dem::Config& config, const dem::Model& model, const Exec& exec,
            Communicator* ranks)
      : world_([&](const Exec& where) { return dem::make_world(config, model, where); },
               in_precision(exec, config.precision), ranks, config.domain),
        probes_(config.probes),
        range_(model.interaction_range) {}

  Advanced advance(const StopAt& stop) override { return world_.advance_to(stop); }
  std::int64_t steps() const override { return world_.part().step; }
  double time() const override { return world_.part().time; }
  double time_step() const override {
    const dem::World& w = world_.part();
    return w.step > 0 ? w.last_dt : w.next_dt;
  }

  EnergyBalance energy() override {
    if (world_.alone()) return dem::balance(world_.whole());
    const dem::Held all = held_by_all(world_, answer());
    return dem::balance(world_.ledger(), all, steps());
  }
  std::vector<double> probes() override {
    if (!world_.alone()) return read_by_all(world_, probes_, answer());
    std::vector<double> values;
    for (const ProbeConfig& probe : probes_) values.push_back(dem::probe(world_.whole(), probe));
    return values;
  }
  std::uint64_t state_hash() override { return dem::state_hash(world_.whole()); }
  void verify() override {
    if (world_.alone()) return dem::verify(world_.whole());
    verify_all(world_, answer());
  }
  Frame frame() override { return dem_frame(world_.whole()).frame; }
  FrameOutput frame_output(const FrameWish& wish) override {
    return seen_by_all(world_, wish, part_of_frame);
  }
  std::unique_ptr<Method> snapshot() override {
    return world_.apart([this] { return std::unique_ptr<Method>(new DemMethod(*this)); });
  }

  std::vector<Fact> facts() override {
    const dem::World& w = world_.whole();
    std::vector<Fact> facts;
    const auto add = [&](const std::string& path, double value) { facts.push_back({path, value}); };
    add("model.elements", w.elements.size());
    const std::size_t groups = group_count();
    for (std::size_t g = 0; g < groups; ++g)
      add("model.elements_by_group." + w.sets[g].name, w.sets[g].members.size());
    add("model.links", w.links());
    add("model.links_by_kind.concrete", w.concrete.size());
    add("model.links_by_kind.steel", w.steel.size());
    add("model.links_by_kind.interface", w.interface.size());
    add("model.interaction_range", range_);
    add("searches", static_cast<double>(w.searches));
    add("contacts.candidates", w.contacts.size());
    world_.add_facts(add);
    const dem::Counts n = dem::count(w);
    add("contacts.touching", n.touching);
    add("fracture.broken_links", n.broken_concrete + n.broken_steel + n.broken_interface);
    add("fracture.broken_by_kind.concrete", n.broken_concrete);
    add("fracture.broken_by_kind.steel", n.broken_steel);
    add("fracture.broken_by_kind.interface", n.broken_interface);
    add("fracture.fragments", n.fragments);
    add("fracture.largest_fragment_fraction", n.largest_fragment);
    return facts;
  }

  void save(CheckpointWriter& writer) override {
    dem::World& w = world_.whole();
    writer.value("step", w.step);
    writer.value("time", w.time);
    writer.value("last_dt", w.last_dt);
    writer.value("next_dt", w.next_dt);
    writer.value("searches", w.searches);
    writer.value("ledger", w.ledger);
    writer.fields("elements", w.elements);
    writer.fields("concrete", w.concrete);
    writer.fields("steel", w.steel);
    writer.fields("interface", w.interface);
    writer.fields("contacts", w.contacts);
    writer.fields("wall_contacts", w.wall_contacts);
    writer.fields("travel", w.travel);
    for (std::size_t k = 0; k < w.walls.size(); ++k)
      writer.value("walls." + std::to_string(k), w.walls[k]);
  }

  void load(const CheckpointReader& reader) override {
    dem::World& w = world_.whole();
    const Index elements = w.elements.size(), links = w.links();
    w.step = reader.value<std::int64_t>("step");
    w.time = reader.value<double>("time");
    w.last_dt = reader.value<double>("last_dt");
    w.next_dt = reader.value<double>("next_dt");
    w.searches = reader.value<std::int64_t>("searches");
    w.ledger = reader.value<dem::Ledger>("ledger");
    reader.fields("elements", w.elements);
    reader.fields("concrete", w.concrete);
    reader.fields("steel", w.steel);
    reader.fields("interface", w.interface);
    reader.fields("contacts", w.contacts);
    reader.fields("wall_contacts", w.wall_contacts);
    reader.fields("travel", w.travel);
    for (std::size_t k = 0; k < w.walls.size(); ++k)
      w.walls[k] = reader.value<dem::Wall>("walls." + std::to_string(k));
    if (w.elements.size() != elements ||
        w.concrete.size() + w.steel.size() + w.interface.size() != links)
      throw CheckpointError("the checkpoint holds another model than the case builds");
    dem::derive(w);
    world_.share_again();
  }

  int follow() override { return world_.follow(answer()); }
  void dismiss(int exit_code) override { world_.dismiss(exit_code); }

 private:
  DemMethod(const DemMethod& other)
      : Method(), world_(other.world_), probes_(other.probes_), range_(other.range_) {
    world_.forget_timers();
  }
  static FramePart part_of_frame(const dem::World& part) { return dem_frame(part); }
  /// Answers for a rank's part.
  SharedWorld<dem::World>::Answer answer() const {
    return answers<dem::World>(probes_, part_of_frame);
  }
  std::size_t group_count() {
    std::size_t groups = 0;
    Buffer<std::int16_t> group;
    copy_to(group, world_.whole().elements.group);
    for (const std::int16_t g : group.host()) groups = std::max(groups, std::size_t(g) + 1);
    return groups;
  }

  SharedWorld<dem::World> world_;
  std::vector<ProbeConfig> probes_;
  double range_;
};

}  // namespace

std::unique_ptr<Method> make_dem_method(const dem::Config& config, const dem::Model& model,
                                        const Exec& exec, Communicator* ranks) {
  return std::make_unique<DemMethod>(config, model, exec, ranks);
}

}  // namespace breccia
