#include "run/fdem_method.hpp"

#include <algorithm>
#include <cmath>

#include "exec/error.hpp"
#include "fdem/energy.hpp"
#include "fdem/observe.hpp"
#include "fdem/ranks.hpp"
#include "run/world_method.hpp"

namespace breccia {
namespace {

/// An array of another length than its neighbours'.
template <class T>
struct Loose {
  const char* name;
  Buffer<T>& array;
  template <class Visit>
  void each_field(Visit&& field) {
    field(name, "SI", array);
  }
};
/// What triangles and joints carry besides one item each.
template <class Visit>
void each_loose(fdem::World& w, Visit&& visit) {
  visit("external", Loose<fdem::Corners>{"force", w.triangles.external});
  with_number(w.exec.precision, [&](auto number) {
    using Number = decltype(number);
    visit("joint_force", Loose<fdem::JointForceOf<Number>>{"force", w.joints.force.as<Number>()});
  });
  visit("changed", Loose<std::uint8_t>{"flags", w.opened.changed});
  visit("opened", Loose<std::uint8_t>{"vertex", w.opened.vertex});
  visit("joint_preset", Loose<Vec2>{"opening", w.joints.preset});
}

class FdemMethod final : public WorldMethod<fdem::World> {
 public:
  FdemMethod(const fdem::Config& config, const fdem::Model& model, const Exec& exec,
             Communicator* ranks)
      : WorldMethod([&](const Exec& where) { return made(config, model, where); },
                    in_precision(exec, config.precision), ranks, config) {
    std::vector<Index> edges;
    copy_to(edges, world_.mesh().joints.edge_a);
    for (const Index edge : edges) {
      const auto& corners = model.triangle[at(edge / 3)];
      const auto point = [&](Index k) { return model.point[at(corners[at(k % 3)])]; };
      lines_.push_back({point(edge % 3), point(edge % 3 + 1)});
    }
  }

  std::string step_rule() override {
    return world_.of_whole([](const fdem::World& w) { return std::string(fdem::ruling_term(w)); });
  }
  std::unique_ptr<Method> snapshot() override {
    return world_.apart([this] { return std::unique_ptr<Method>(new FdemMethod(*this)); });
  }
  std::vector<Fact> facts() override {
    return world_.of_whole([this](const fdem::World& w) { return facts_of(w); });
  }
  std::vector<Table> tables() override {
    return world_.of_whole([this](const fdem::World& w) { return tables_of(w); });
  }

  void save(CheckpointWriter& writer) override {
    world_.with_whole([&](fdem::World& w) { save(w, writer); });
  }
  void load(const CheckpointReader* reader) override {
    world_.renew([&](fdem::World& w) { load(w, *reader); });
  }

 private:
  FdemMethod(const FdemMethod& other) = default;

  /// Where a joint lay at the start.
  struct Line {
    Vec2 begin, end;  ///<  [m]
  };

  EnergyBalance balance_of(const Energies& all) override {
    return fdem::energies(world_.ledger(), all).balance;
  }
  FramePart part_of_frame(const fdem::World& part) const override {
    const bool first = !part.domain.alone() && part.domain.ranks->rank() == 0;
    return fdem_frame(part, first ? &world_.mesh() : nullptr);
  }

  std::vector<Fact> facts_of(const fdem::World& w) const {
    std::vector<Fact> facts;
    const auto add = [&](const std::string& path, double value) { facts.push_back({path, value}); };
    add("model.triangles", w.triangles.size());
    for (std::size_t g = 0; g < w.groups.size(); ++g)
      add("model.triangles_by_group." + w.groups[g],
          static_cast<double>(w.sets[g].nodes.size() / 3));
    add("model.joints", w.joints.size());
    add("model.nodes", 3 * w.triangles.size());
    add("searches", static_cast<double>(w.searches));
    add("contacts.candidates", w.couples.size());
    world_.add_facts(add);
    const std::vector<fdem::Crack> cracks = fdem::cracks(w);
    const auto sliding = std::count_if(cracks.begin(), cracks.end(),
                                       [](const fdem::Crack& c) { return c.mode > 0.5; });
    add("fracture.broken_joints", static_cast<double>(cracks.size()));
    add("fracture.first_break", cracks.empty() ? -1.0 : cracks.front().time);
    add("fracture.broken_by_mode.opening",
        static_cast<double>(cracks.size()) - static_cast<double>(sliding));
    add("fracture.broken_by_mode.sliding", static_cast<double>(sliding));
    const fdem::EnergySplit split = fdem::energy_split(w);
    add("fracture.energy_by_mode.opening", split.fracture_open);
    add("fracture.energy_by_mode.sliding", split.fracture_slide);
    const fdem::Fragments pieces = fdem::fragments(w);
    double total = 0.0;
    for (const double m : pieces.mass) total += m;
    add("fracture.fragments", static_cast<double>(pieces.mass.size()));
    add("fracture.largest_fragment_fraction", pieces.mass.front() / total);
    return facts;
  }

  std::vector<Table> tables_of(const fdem::World& w) const {
    Table cracks{"cracks",
                 {"time", "x", "y", "length", "mode", "energy", "x0", "y0", "x1", "y1"},
                 {"s", "m", "m", "m", "-", "J/m", "m", "m", "m", "m"},
                 {}};
    for (const fdem::Crack& c : fdem::cracks(w)) {
      const Vec2 middle = 0.5 * (c.begin + c.end);
      const Line& line = lines_[at(c.joint)];
      cracks.rows.push_back({c.time, middle.x, middle.y, norm(c.end - c.begin), c.mode, c.energy,
                             line.begin.x, line.begin.y, line.end.x, line.end.y});
    }
    Table pieces{"fragments", {"fragment", "mass", "share"}, {"-", "kg/m", "-"}, {}};
    const fdem::Fragments all = fdem::fragments(w);
    double total = 0.0;
    for (const double m : all.mass) total += m;
    for (std::size_t i = 0; i < all.mass.size(); ++i)
      pieces.rows.push_back({static_cast<double>(i), all.mass[i], all.mass[i] / total});
    return {cracks, pieces};
  }

  static void save(fdem::World& w, CheckpointWriter& writer) {
    writer.value("step", w.step);
    writer.value("time", w.time);
    writer.value("last_dt", w.last_dt);
    writer.value("next_dt", w.next_dt);
    writer.value("searches", w.searches);
    writer.value("ledger", w.ledger);
    writer.fields("triangles", w.triangles);
    writer.fields("joints", w.joints);
    each_loose(w, [&](const char* name, auto array) { writer.fields(name, array); });
    writer.fields("couples", w.couples);
    writer.fields("reach", w.reach);
    writer.value("reach.drift", w.reach.drift);
  }

  static void load(fdem::World& w, const CheckpointReader& reader) {
    const Index triangles = w.triangles.size(), joints = w.joints.size();
    w.step = reader.value<std::int64_t>("step");
    w.time = reader.value<double>("time");
    w.last_dt = reader.value<double>("last_dt");
    w.next_dt = reader.value<double>("next_dt");
    w.searches = reader.value<std::int64_t>("searches");
    w.ledger = reader.value<Ledger>("ledger");
    reader.fields("triangles", w.triangles);
    reader.fields("joints", w.joints);
    each_loose(w, [&](const char* name, auto array) { reader.fields(name, array); });
    reader.fields("couples", w.couples);
    reader.fields("reach", w.reach);
    w.reach.drift = reader.value<fdem::Drift>("reach.drift");
    if (w.triangles.size() != triangles || w.joints.size() != joints)
      throw CheckpointError("the checkpoint holds another model than the case builds");
    fdem::derive(w);
  }

  static fdem::World made(const fdem::Config& config, const fdem::Model& model, const Exec& exec) {
    fdem::World w = fdem::make_world(config, model, exec);
    fdem::energies(w);
    for (const ProbeConfig& p : config.probes) fdem::probe(w, p);  // refuses what cannot be read
    return w;
  }

  std::vector<Line> lines_;  ///< of all joints; on rank 0
};

}  // namespace

std::unique_ptr<Method> make_fdem_method(const fdem::Config& config, const fdem::Model& model,
                                         const Exec& exec, Communicator* ranks) {
  return std::make_unique<FdemMethod>(config, model, exec, ranks);
}

}  // namespace breccia
