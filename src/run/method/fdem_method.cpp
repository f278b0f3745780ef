#include "run/method/fdem_method.hpp"

#include "exec/error.hpp"
#include "fdem/emission.hpp"
#include "fdem/fluid/fluid.hpp"
#include "fdem/observe.hpp"
#include "fdem/ranks.hpp"
#include "fdem/servos.hpp"
#include "fdem/setup/removal.hpp"
#include "fdem/setup/stages.hpp"
#include "fdem/stepping/step.hpp"
#include "run/method/bolts.hpp"
#include "run/method/emission_table.hpp"
#include "run/method/mesh_sim.hpp"

namespace breccia {
namespace {

struct FdemSim : MeshSim<fdem::World, fdem::Config> {
  /// Where a joint lay at the start.
  struct Line {
    Vec2 begin, end;  ///<  [m]
  };
  std::vector<Line> lines;  ///< of all joints; on rank 0

  FdemSim(const fdem::Model& model, const World& mesh) {
    std::vector<Index> edges;
    copy_to(edges, mesh.joints.edge_a);
    for (const Index edge : edges) {
      const auto& triangle = model.triangle[at(edge / 3)];
      const auto point = [&](Index k) { return model.point[at(triangle[at(k % 3)])]; };
      lines.push_back({point(edge % 3), point(edge % 3 + 1)});
    }
  }

  static FramePart frame(World& w, const World* mesh) { return fdem_frame(w, mesh); }

  void add_findings(const World& w, std::vector<Fact>& facts, const SpentOnCracks& spent) const {
    add_cracks(w, facts, spent);
    add_fluids(w, facts);
    add_bolt_findings(w, facts);
    add_emission(facts, events(w));
    add_fragments(fdem::fragments(w).mass, facts);
  }

  std::vector<Table> tables(const World& w) const {
    Table cracks{"cracks",
                 {"time", "x", "y", "length", "mode", "energy", "x0", "y0", "x1", "y1"},
                 {"s", "m", "m", "m", "-", "J/m", "m", "m", "m", "m"},
                 {}};
    for (const fdem::Crack& c : fdem::cracks(w)) {
      const Vec2 middle = 0.5 * (c.begin + c.end);
      const Line& line = lines[at(c.joint)];
      cracks.rows.push_back({c.time, middle.x, middle.y, norm(c.end - c.begin), c.mode, c.energy,
                             line.begin.x, line.begin.y, line.end.x, line.end.y});
    }
    Table pieces{"fragments",
                 {"fragment", "mass", "share", "area", "x", "y", "vx", "vy"},
                 {"-", "kg/m", "-", "m2", "m", "m", "m/s", "m/s"},
                 {}};
    const fdem::Fragments all = fdem::fragments(w);
    const double scaling = w.given->time.mass_scaling;
    double total = 0.0;
    for (const double m : all.mass) total += m;
    for (std::size_t i = 0; i < all.mass.size(); ++i) {
      const fdem::Piece& p = all.pieces[i];
      pieces.rows.push_back({static_cast<double>(i), all.mass[i] / scaling, all.mass[i] / total,
                             p.area, p.centre.x, p.centre.y, p.velocity.x, p.velocity.y});
    }
    std::vector<Table> tables{cracks, pieces, table_of(events(w))};
    add_bolt_table(w, tables);
    return tables;
  }
  std::vector<EmissionEvent> events(const World& w) const {
    std::vector<fdem::JointLine> at_start;
    for (const Line& line : lines) at_start.push_back({line.begin, line.end});
    return fdem::emission(w, at_start);
  }

  static std::vector<std::string> constants() {
    return {
        "triangles.id",   "triangles.group",     "triangles.material", "triangles.shape_inverse",
        "triangles.mass", "triangles.viscosity", "joints.edge_a",      "joints.edge_b",
        "joints.law",     "joints.length",       "joints.strength"};
  }
  template <class Visit>
  static void each_stored(World& w, const Visit& visit) {
    each_stored_array(w, visit, [&](const Visit& of) {
      with_number(w.exec.precision, [&](auto number) {
        using Number = decltype(number);
        of.fields("joint_force",
                  Loose<fdem::JointForceOf<Number>>{"force", w.joints.force.as<Number>()});
      });
    });
    each_stored_bolt(w, visit);
    each_stored_rigid(w, visit);
    each_stored_fluid(w, visit);
    each_stored_gas(w, visit);
  }
};

}  // namespace

std::unique_ptr<Method> make_method(const fdem::Config& config, const fdem::Model& model,
                                    const Exec& exec, Communicator* ranks) {
  return std::make_unique<SimMethod<FdemSim>>(config, model, exec, ranks);
}

}  // namespace breccia
