#include "run/dem_method.hpp"

#include "core/precision.hpp"
#include "dem/energy.hpp"
#include "dem/observe.hpp"
#include "dem/ranks.hpp"
#include "exec/error.hpp"
#include "run/world_method.hpp"

namespace breccia {
namespace {

class DemMethod final : public WorldMethod<dem::World> {
 public:
  DemMethod(const dem::Config& config, const dem::Model& model, const Exec& exec,
            Communicator* ranks)
      : WorldMethod([&](const Exec& where) { return dem::make_world(config, model, where); },
                    in_precision(exec, config.precision), ranks, config),
        range_(model.interaction_range) {}

  std::unique_ptr<Method> snapshot() override {
    return world_.apart([this] { return std::unique_ptr<Method>(new DemMethod(*this)); });
  }

  std::vector<Fact> facts() override {
    return world_.of_whole([this](const dem::World& w) { return facts_of(w); });
  }

  void save(CheckpointWriter& writer) override {
    world_.with_whole([&](dem::World& w) { save(w, writer); });
  }
  void load(const CheckpointReader* reader) override {
    world_.renew([&](dem::World& w) { load(w, *reader); });
  }

 private:
  DemMethod(const DemMethod& other) = default;

  EnergyBalance balance_of(const Energies& all) override {
    return dem::balance(world_.ledger(), all, steps());
  }
  FramePart part_of_frame(const dem::World& part) const override { return dem_frame(part); }

  std::vector<Fact> facts_of(const dem::World& w) const {
    std::vector<Fact> facts;
    const auto add = [&](const std::string& path, double value) { facts.push_back({path, value}); };
    add("model.elements", w.elements.size());
    const std::size_t groups = group_count(w);
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

  static void save(dem::World& w, CheckpointWriter& writer) {
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

  static void load(dem::World& w, const CheckpointReader& reader) {
    const Index elements = w.elements.size(), links = w.links();
    w.step = reader.value<std::int64_t>("step");
    w.time = reader.value<double>("time");
    w.last_dt = reader.value<double>("last_dt");
    w.next_dt = reader.value<double>("next_dt");
    w.searches = reader.value<std::int64_t>("searches");
    w.ledger = reader.value<Ledger>("ledger");
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
  }

  static std::size_t group_count(const dem::World& w) {
    std::size_t groups = 0;
    Buffer<std::int16_t> group;
    copy_to(group, w.elements.group);
    for (const std::int16_t g : group.host()) groups = std::max(groups, std::size_t(g) + 1);
    return groups;
  }

  double range_;
};

}  // namespace

std::unique_ptr<Method> make_dem_method(const dem::Config& config, const dem::Model& model,
                                        const Exec& exec, Communicator* ranks) {
  return std::make_unique<DemMethod>(config, model, exec, ranks);
}

}  // namespace breccia
