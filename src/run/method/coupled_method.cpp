#include "run/method/coupled_method.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/on_host.hpp"
#include "dem/setup/moduli.hpp"
#include "domain/together.hpp"
#include "exec/error.hpp"
#include "io/frame_pair.hpp"
#include "run/frames/coupled_frame.hpp"
#include "run/method/dem_method.hpp"
#include "run/method/fdem3_method.hpp"

namespace breccia {
namespace {

/// Each method is looked at, saved and loaded by itself, as if it were alone; steps are taken
/// together.
class CoupledMethod final : public Method {
 public:
  CoupledMethod(const coupled::Config& config, const coupled::Parts& parts,
                const coupled::Model& model, const Exec& exec, Communicator* ranks)
      : threads_(exec.threads),
        ranks_(ranks),
        stages_(config.stages.begin(), config.stages.end()),
        probes_(parts.probes),
        spheres_(dem_part(parts.spheres, model.spheres, exec, ranks)),
        tetrahedra_(fdem3_part(parts.tetrahedra, model.tetrahedra, exec, ranks)),
        w_(coupled::make_world(config, *spheres_.world, *tetrahedra_.world)) {
    for (const dem::StageConfig& stage : parts.spheres.stages)
      evaluates_anew_.push_back(dem::changes_moduli(stage));
  }

  Advanced advance(const StopAt& stop) override {
    if (ranks_ == nullptr) return take_step();
    Advanced taken;
    at_once(ranks_, [&] {
      each_part([](const std::string&, Method& method) { method.begin_steps(); });
      coupled::derive_if_shared_anew(w_);
      do {
        const Advanced one = take_step();
        taken.dt_min = taken.steps == 0 ? one.dt_min : std::min(taken.dt_min, one.dt_min);
        taken.dt_max = std::max(taken.dt_max, one.dt_max);
        taken.steps += 1;
      } while (steps() < stop.step && time() < stop.time);
      coupled::make_whole(w_);
      each_part([](const std::string&, Method& method) { method.end_steps(); });
    });
    return taken;
  }
  std::int64_t steps() const override { return spheres_.world->step; }
  double time() const override { return spheres_.world->time; }
  double time_step() const override {
    const dem::World& s = *spheres_.world;
    return s.step > 0 ? s.last_dt : s.next_dt;
  }
  std::int64_t searches() const override { return w_.searches; }
  std::vector<std::string> warnings() override {
    std::vector<std::string> all = spheres_.method->warnings();
    for (const auto& more : {tetrahedra_.method->warnings(), w_.given->warnings})
      all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  std::vector<StageEnd> stages() const override { return stages_; }
  StageProgress stage() const override { return spheres_.method->stage(); }
  void set_stage(const StageProgress& now) override {
    const bool begins = now.index != stage().index;
    each_part([&](const std::string&, Method& method) { method.set_stage(now); });
    if (!begins) return;
    if (evaluates_anew_[static_cast<std::size_t>(now.index)]) {
      const double alone = spheres_.method->energy().missing();
      coupled::press_spheres_again(w_);
      w_.ledger.came_in.add(spheres_.method->energy().missing() - alone);
    }
    if (!stages_[static_cast<std::size_t>(now.index)].remove.empty()) coupled::cut_off_removed(w_);
    coupled::shorten_common_step(w_);
  }

  EnergyBalance energy() override {
    const EnergyBalance a = spheres_.method->energy(), b = tetrahedra_.method->energy();
    const Energies between = coupled::held(w_);
    if (!leads(ranks_)) return {};
    EnergyBalance all;
    all.kinetic = a.kinetic + b.kinetic;
    all.elastic = a.elastic + b.elastic + between.elastic.value();
    all.fracture = a.fracture + b.fracture + between.fracture.value();
    all.plastic = a.plastic + b.plastic;
    all.friction = a.friction + b.friction + (between.friction + w_.ledger.friction).value();
    all.damping = a.damping + b.damping;
    all.contact = a.contact + b.contact + (between.contact + w_.ledger.contact).value();
    all.work = a.work + b.work + w_.ledger.came_in.value();
    all.start = a.start + b.start;
    double& largest = w_.ledger.largest;
    largest = std::max({largest, all.kinetic + all.elastic, std::fabs(all.work), all.total()});
    if (steps() != 0 && largest > rounding()) all.relate_to(largest);
    return all;
  }
  double rounding() const override {
    return spheres_.method->rounding() + tetrahedra_.method->rounding();
  }
  std::vector<double> probes() override {
    const std::vector<double> of_spheres = spheres_.method->probes(),
                              of_tetrahedra = tetrahedra_.method->probes();
    std::vector<double> values;
    for (const coupled::PlacedProbe& p : probes_)
      values.push_back((p.of_spheres ? of_spheres : of_tetrahedra)[p.place]);
    return values;
  }
  void note_breaks() override { spheres_.method->note_breaks(); }
  std::uint64_t state_hash() override {
    constexpr std::uint64_t odd = 0x9e3779b97f4a7c15ULL;
    return spheres_.method->state_hash() + odd * tetrahedra_.method->state_hash();
  }
  void verify() override {
    spheres_.method->verify();
    tetrahedra_.method->verify();
  }
  std::string fastest() override {
    return spheres_.method->fastest() + "; " + tetrahedra_.method->fastest();
  }

  Frame frame() override {
    const Frame spheres = frame_of_spheres().frame, solids = tetrahedra_.method->frame();
    return leads(ranks_) ? paired(spheres, solids) : Frame();
  }
  FrameOutput frame_output(const FrameWish& wish) override {
    FrameWish files = wish;
    files.picture.reset();
    const FramePart spheres = frame_of_spheres();
    const FrameOutput solids = tetrahedra_.method->frame_output(files);
    FrameOutput output;
    if (leads(ranks_)) output = breccia::frame_output(spheres, files, threads_);
    if (wish.files && leads(ranks_)) {
      output.files.more = {{frame_of_solids, solids.files.points},
                           {joints_of_solids, solids.files.lines},
                           {contacts_of_solids, solids.files.contacts}};
      if (!solids.files.bolts.empty()) output.files.more.emplace_back("bolts", solids.files.bolts);
    }
    if (!wish.picture) return output;
    FrameWish picture = wish;
    picture.files = false;
    const Frame both = frame();
    if (!leads(ranks_)) return {};
    FrameOutput drawn = breccia::frame_output(both, picture, threads_);
    drawn.files = std::move(output.files);
    return drawn;
  }

  std::vector<Fact> facts() override {
    std::vector<Fact> all;
    const auto add = [&all](const std::string& part, const std::vector<Fact>& facts) {
      for (const Fact& fact : facts) all.push_back({part + fact.path, fact.value});
    };
    add("spheres.", spheres_.method->facts());
    add("tetrahedra.", tetrahedra_.method->facts());
    const coupled::Counts n = coupled::count(w_);
    add("coupling.", {{"searches", static_cast<double>(w_.searches)},
                      {"near_faces", static_cast<double>(w_.faces.size())},
                      {"touching", n.touching},
                      {"bonds", n.bonds},
                      {"broken_bonds", n.broken}});
    if (ranks_ != nullptr)
      add("domain.coupling_", {{"touches_evaluated", static_cast<double>(w_.border.touches.size())},
                               {"bonds_evaluated", static_cast<double>(w_.border.bonds.size())}});
    return all;
  }
  std::vector<StateArray> arrays(const std::string& name, Wanted where) override {
    std::vector<StateArray> all;
    each_part([&](const std::string& part, Method& method) {
      if (!name.empty() && !name.starts_with(part)) return;
      for (StateArray& array :
           method.arrays(name.empty() ? name : name.substr(part.size()), where)) {
        array.name = part + array.name;
        all.push_back(std::move(array));
      }
    });
    return all;
  }
  std::vector<Table> tables() override {
    std::vector<Table> all;
    const auto add = [&all](const char* part, std::vector<Table> tables) {
      for (Table& table : tables) {
        table.name = part + table.name;
        all.push_back(std::move(table));
      }
    };
    add("spheres_", spheres_.method->tables());
    add("tetrahedra_", tetrahedra_.method->tables());
    return all;
  }

  void save(CheckpointWriter& writer) override {
    each_part([&](const std::string& part, Method& method) {
      CheckpointWriter own(writer.arrays());
      method.save(own);
      writer.adopt(part, std::move(own));
    });
    each_stored([&](const std::string& name, auto& value) { writer.value(name, value); },
                [&](const std::string& name, auto& state) { writer.fields(name, state); });
  }
  std::vector<std::string> constants() const override {
    std::vector<std::string> all;
    for (const std::string& name : spheres_.method->constants()) all.push_back("spheres." + name);
    for (const std::string& name : tetrahedra_.method->constants())
      all.push_back("tetrahedra." + name);
    all.emplace_back("coupling.bonds.tie");
    return all;
  }
  void load(const CheckpointReader* reader) override {
    each_part([&](const std::string& part, Method& method) {
      if (!leads(ranks_)) return method.load(nullptr);
      const CheckpointReader own = reader->below(part);
      method.load(&own);
    });
    tetrahedra_.world->meets_spheres = true;  // a rank's part is another one now
    on_first(ranks_, [&] {
      each_stored(
          [&](const std::string& name, auto& value) {
            value = reader->value<std::remove_reference_t<decltype(value)>>(name);
          },
          [&](const std::string& name, auto& state) { reader->fields(name, state); });
      refuse_misfits();
    });
    at_once(ranks_, [&] {
      if (ranks_ != nullptr)
        each_stored([&](const std::string&, auto& value) { take_from_first(*ranks_, value); },
                    [&](const std::string&, auto& state) { take_state_from_first(state); });
      coupled::derive(w_);
    });
  }

 private:
  template <class Visit>
  void each_part(const Visit& visit) {
    visit("spheres.", *spheres_.method);
    visit("tetrahedra.", *tetrahedra_.method);
  }
  template <class OfValue, class OfState>
  void each_stored(const OfValue& value, const OfState& state) {
    value("coupling.last", w_.last);
    value("coupling.ledger", w_.ledger);
    value("coupling.stable_step", w_.stable_step);
    value("coupling.searches", w_.searches);
    state("coupling.bonds", w_.bonds);
    state("coupling.touches", w_.touches);
    state("coupling.faces", w_.faces);
  }
  template <class State>
  void take_state_from_first(State& state) const {
    state.each_field([this](const char*, const char*, auto& array) {
      std::vector<std::remove_cvref_t<decltype(*array.data())>> items;
      Message message;
      if (leads(ranks_)) {
        copy_to(items, array);
        put_array(message, items);
      }
      message = ranks_->from_first(std::move(message));
      copy_to(array, Unpacking(message).array<typename decltype(items)::value_type>());
    });
  }
  Advanced take_step() {
    coupled::step(w_);
    spheres_.method->steer(coupled::touched_by_servos(w_));
    tetrahedra_.method->steer({});
    return {1, spheres_.world->last_dt, spheres_.world->last_dt};
  }
  /// With what presses on tetrahedra; on rank 0.
  FramePart frame_of_spheres() {
    FramePart part;
    if (ranks_ == nullptr)
      part = dem_frame(*spheres_.world);
    else
      part.frame = spheres_.method->frame();
    if (leads(ranks_)) add_presses(w_, part.frame.contacts);
    return part;
  }
  /// Places that a file leads to must be there.
  void refuse_misfits() const {
    const Index spheres = w_.given->spheres, solids = w_.given->tetrahedra,
                bodies = static_cast<Index>(tetrahedra_.world->given->groups.size());
    const Space space = spheres_.world->exec.space;
    const auto hold = [space](const Buffer<Index>& places, Index count, const char* section) {
      const OnHost there(places, space);
      for (const Index place : there->host())
        if (place < 0 || place >= count)
          throw CheckpointError(std::string("the checkpoint's section ") + section +
                                " leads to no item of the model");
    };
    hold(w_.touches.pairs.a, spheres, "coupling.touches");
    hold(w_.touches.pairs.b, bodies, "coupling.touches");
    hold(w_.faces.pairs.a, spheres, "coupling.faces");
    hold(w_.faces.pairs.b, 4 * solids, "coupling.faces");
    const OnHost ties(w_.bonds.tie, space);
    for (const coupled::BallBond& b : ties->host())
      if (b.sphere < 0 || b.sphere >= spheres || b.tetrahedron < 0 || b.tetrahedron >= solids ||
          b.body < 0 || b.body >= bodies || b.law < 0 || b.law >= w_.given->bonds.size())
        throw CheckpointError(
            "the checkpoint's section coupling.bonds leads to no item of the model");
  }

  int threads_;
  Communicator* ranks_;
  std::vector<StageEnd> stages_;
  std::vector<bool> evaluates_anew_;  ///< whether a stage does so with the forces of spheres
  std::vector<coupled::PlacedProbe> probes_;
  DemPart spheres_;
  Fdem3Part tetrahedra_;
  coupled::World w_;
};

}  // namespace

std::unique_ptr<Method> make_method(const coupled::Config& config, const coupled::Model& model,
                                    const Exec& exec, Communicator* ranks) {
  return std::make_unique<CoupledMethod>(config, coupled::parts_of(config), model, exec, ranks);
}

}  // namespace breccia
